// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace deltasplat {

/// Returns the code points of UTF-8 text. What is no UTF-8, and what controls a terminal, is "?".
std::u32string codePoints(std::string_view text);

/// Returns code points, each a valid one, as UTF-8.
std::string utf8(std::u32string_view points);

/// Returns text as it stands between the tags of XML and HTML: codePoints, with `&`, `<` and `>`
/// spelt out.
std::string markupText(std::string_view text);

}  // namespace deltasplat
