// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_page_parts.h"

#include "bench/picture_data.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {
namespace {

// The sRGB colour #0d0e10, as the style sheet has it.
constexpr glm::vec4 kDark{0.0040F, 0.0044F, 0.0052F, 1};

}  // namespace

std::string shownPicture(Image picture, const Background& background) {
    if (background) compositeOver(picture, *background);
    compositeOver(picture, kDark);
    return pngDataUri(picture);
}

std::string pictureFigure(const std::string& uri, const std::string& alternative,
                          const std::string& caption) {
    return "<figure><img src=\"" + uri + "\" alt=\"" + alternative + "\">\n<figcaption>" + caption +
           "</figcaption></figure>\n";
}

std::string tableRow(const std::string& tag, const std::vector<std::string>& cells) {
    std::string row = "<tr>";
    const std::string open = "<" + tag + ">";
    const std::string close = "</" + tag + ">";
    for (const std::string& cell : cells) row.append(open).append(cell).append(close);
    return row + "</tr>\n";
}

}  // namespace deltasplat
