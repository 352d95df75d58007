// SPDX-License-Identifier: Apache-2.0
#include "annotate/text_lines.h"

#include "drawing/stroke_font.h"

namespace deltasplat {

Annotation drawTextLines(const std::vector<std::string>& lines, const AnnotationStyle& style,
                         double width, bool& cut) {
    constexpr double kLineHeight = 1.5;
    Ink ink(style.font, style.colors);
    cut = false;
    double base = style.margin + 0.8 * style.font;
    for (const std::string& line : lines) {
        const bool first = &line == &lines.front();
        if (!first && base > style.picture.y - style.margin) {
            cut = true;
            break;
        }
        const std::string shown = fittedText(line, width / style.font);
        cut = cut || shown != line;
        ink.text({style.margin, base}, shown);
        base += kLineHeight * style.font;
    }
    return makeAnnotation("--annotate", ink);
}

}  // namespace deltasplat
