// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// Returns bytes as base64 (RFC 4648, with padding, in one line).
std::string base64Text(std::string_view bytes);

/// Returns a picture as a `data:` URI that holds an 8-bit PNG.
/// @throw Error(kOutput) if it cannot be encoded
std::string pngDataUri(const Image& image);

}  // namespace deltasplat
