// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace deltasplat {

/// Whether a file is a grey Netpbm image, plain (P2) or binary (P5). OpenImageIO 2.4 stretches such
/// samples over the type's range, and rounds half of those of 16 bits down by one.
bool isPgm(const std::filesystem::path& file);

/// Reads the samples of one as they are stored, whatever its largest is; files with several images
/// have but the first. To numbers of one byte if the file says that none is above 255, else of two.
/// @param to  as many as the image has pixels
/// @throw Error(kInput) unless it has `pixels` whole samples, none above what it says
void readPgm(const std::filesystem::path& file, std::size_t pixels, std::span<std::byte> to);

}  // namespace deltasplat
