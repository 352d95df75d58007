// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace deltasplat {

// What headers claim is asked about before a decoder believes it: libraries take the memory for
// what they will unpack at once (an image, a tile, the lines of a block) when they open a file.

/// Returns the most bytes that one byte of a file can unpack to.
/// @param packing  as OpenImageIO names it, "none" for pixels as they are; others are taken for one
///                 that packs well
double mostRatio(const std::string& packing);

/// Whether bytes can hold what is said to be packed in them.
/// @param ratio  the most bytes that one of them can unpack to
bool isEnough(double packedBytes, double ratio, double unpackedBytes);

/// Checks what an image's header claims as far as its decoder would believe it on opening the file.
/// What is no such image at all is for the decoder to refuse.
/// @return whether the decoder may do several things at once, each in memory of its own
/// @throw Error(kInput) "<file>: got 8 bytes; expected enough for 640x480 pixels", or as
///        requireClaimedMemory
bool requireClaims(const std::filesystem::path& file);

/// What the frame header of a JPEG or JPEG-LS picture says.
struct JpegFrame {
    int marker = 0;  ///< its second byte: how the picture is packed
    int bits = 0;    ///< of a number
    int rows = 0;
    int columns = 0;
    int components = 0;
};

/// Returns the first frame header; nothing if the picture's codes begin, or it ends, before one.
/// Passes over what is no marker, as decoders do.
/// @param next  returns the next byte; -1 behind the last one
std::optional<JpegFrame> findJpegFrame(const std::function<int()>& next);

}  // namespace deltasplat
