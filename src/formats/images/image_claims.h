// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace deltasplat {

// Headers are checked before a decoder believes them, because libraries allocate a whole image,
// tile or block of lines as soon as they open a file.

/// Returns the most bytes that one packed byte can unpack to.
/// @param packing  OpenImageIO's name; "none": plain pixels; unknown names count as strong packings
double mostRatio(const std::string& packing);

/// Whether packed bytes can hold the claimed unpacked bytes; `ratio` as from mostRatio.
bool isEnough(double packedBytes, double ratio, double unpackedBytes);

/// Checks the claims that a decoder believes on opening an image; other files are left to it.
/// @return whether the decoder may use several threads, each with its own memory
/// @throw Error(kInput) "<file>: got 8 bytes; expected enough for 640x480 pixels", or as
///        requireClaimedMemory
bool requireClaims(const std::filesystem::path& file);

/// The frame header of a JPEG or JPEG-LS picture.
struct JpegFrame {
    int marker = 0;  ///< second byte of the marker: the kind of compression
    int bits = 0;    ///< bits per number
    int rows = 0;
    int columns = 0;
    int components = 0;
};

/// Returns the first frame header; nothing if the codes or the end of the picture come first. Skips
/// bytes that are no marker, as decoders do.
/// @param next  returns the next byte; -1 after the last one
std::optional<JpegFrame> findJpegFrame(const std::function<int()>& next);

}  // namespace deltasplat
