// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "drawing/drawing.h"
#include "text/utf8_text.h"

namespace deltasplat {
namespace {

// Hundredths of a pixel are enough, and keep the file small.
std::string coordinate(double value) {
    return numberText(std::round(value * 100) / 100 + 0.0);
}

std::string colorText(const Rgb& color) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text = "#";
    for (const int channel : {color.r, color.g, color.b}) {
        text += kDigits[channel >> 4];
        text += kDigits[channel & 15];
    }
    return text;
}

// Steps are mostly level and upright, which SVG says with one number.
std::string pathText(const std::vector<glm::dvec2>& points) {
    std::string path;
    std::string lastX;
    std::string lastY;
    for (const glm::dvec2& point : points) {
        const std::string x = coordinate(point.x);
        const std::string y = coordinate(point.y);
        if (path.empty()) {
            path.append("M").append(x).append(" ").append(y);
        } else if (y == lastY) {
            path.append("H").append(x);
        } else if (x == lastX) {
            path.append("V").append(y);
        } else {
            path.append("L").append(x).append(" ").append(y);
        }
        lastX = x;
        lastY = y;
    }
    return path;
}

std::string itemText(const Area& area) {
    const std::string opacity =
        area.opacity < 1 ? " fill-opacity=\"" + numberText(area.opacity) + "\"" : "";
    return "<path fill=\"" + colorText(area.color) + "\"" + opacity + " d=\"" +
           pathText(area.points) + "Z\"/>";
}

std::string itemText(const Line& line) {
    return "<path fill=\"none\" stroke=\"" + colorText(line.color) + "\" stroke-width=\"" +
           coordinate(line.width) + "\" stroke-linecap=\"round\" stroke-linejoin=\"round\" d=\"" +
           pathText(line.points) + "\"/>";
}

std::string itemText(const Label& label) {
    const std::string x = coordinate(label.at.x);
    const std::string y = coordinate(label.at.y);
    std::string text = "<text x=\"" + x + "\" y=\"" + y + "\" font-size=\"" +
                       coordinate(label.size) + "\" fill=\"" + colorText(label.color) + "\"";
    if (label.anchor == Label::Anchor::kMiddle) text += " text-anchor=\"middle\"";
    if (label.anchor == Label::Anchor::kEnd) text += " text-anchor=\"end\"";
    if (label.bold) text += " font-weight=\"bold\"";
    if (label.upwards) text += " transform=\"rotate(-90 " + x + " " + y + ")\"";
    return text + ">" + markupText(label.text) + "</text>";
}

}  // namespace

std::string svgText(const Drawing& drawing) {
    const std::string width = coordinate(drawing.size.x);
    const std::string height = coordinate(drawing.size.y);
    std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width +
                       "\" height=\"" + height + "\" viewBox=\"0 0 " + width + " " + height +
                       "\" font-family=\"Helvetica, Arial, sans-serif\">\n" + "<rect width=\"" +
                       width + "\" height=\"" + height + "\" fill=\"#ffffff\"/>\n";
    for (const auto& item : drawing.items) {
        text += std::visit([](const auto& shape) { return itemText(shape); }, item) + "\n";
    }
    return text + "</svg>\n";
}

}  // namespace deltasplat
