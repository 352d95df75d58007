// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ingest/dense/dense_source.h"

namespace deltasplat {

/// Opens a .npy file.
/// @param options  spacing, origin and which volume are taken from it
/// @throw as readVolume
DenseSource openNpy(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace deltasplat
