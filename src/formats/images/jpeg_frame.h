// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

namespace deltasplat {

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
