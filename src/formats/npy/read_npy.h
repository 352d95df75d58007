// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "formats/dense/dense_layout.h"
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

/// As DenseFormat has them.
void settleNpy(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string npyHeader(const DenseLayout& layout, const std::string& dataFile);

}  // namespace deltasplat
