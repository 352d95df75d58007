// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace deltasplat {

/// What pictures on a page stand on: the sRGB colour #0d0e10, as kPageStyle has it.
inline constexpr glm::vec4 kPageDark{0.0040F, 0.0044F, 0.0052F, 1};

/// Returns a page up to where its body begins; kPageEnd ends it.
/// @param title  HTML
/// @param style  added to kPageStyle
std::string pageBegin(const std::string& title, const std::string& style);
inline constexpr const char* kPageEnd = "</body>\n</html>\n";

/// Returns text as it stands in an attribute between double quotes.
std::string attributeText(const std::string& text);

/// Returns a picture with a caption below.
/// @param caption  HTML
std::string pictureFigure(const std::string& uri, const std::string& alternative,
                          const std::string& caption);

/// Returns a row of cells, each HTML.
/// @param tag  "th" or "td"
std::string tableRow(const std::string& tag, const std::vector<std::string>& cells);

}  // namespace deltasplat
