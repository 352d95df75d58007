// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "formats/dense/dense_source.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// What the header of a NumPy array file says, checked.
struct NpyHeader {
    RawLayout layout;          ///< of one volume, behind skipBytes; halves are uint16
    bool half = false;         ///< the values are halves
    std::int64_t volumes = 1;  ///< the product of all axes but the three that count fastest
    std::string shape;         ///< for messages: "(5, 64, 64, 36)"
};

/// Reads the header of a .npy file.
/// @throw Error(kInput) if it is none, or says what cannot be meant or is not supported
NpyHeader readNpyHeader(const std::filesystem::path& file);

/// Opens a .npy file.
/// @param options  spacing, origin and which volume are taken from it
/// @throw as readVolume
DenseSource openNpy(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace deltasplat
