// SPDX-License-Identifier: Apache-2.0
#include "render/list_presets.h"

#include <algorithm>

#include "base/text.h"
#include "deltasplat/optics/presets.h"
#include "drawing/shapes.h"
#include "optics/color_curve.h"

namespace deltasplat {
namespace {

std::string valuesText(Preset::Values values) {
    switch (values) {
        case Preset::Values::kHounsfield:
            return "Hounsfield units";
        case Preset::Values::kLabels:
            return "labels";
        case Preset::Values::kRange:
            break;
    }
    return "a range";
}

// Lengths in pixels.
constexpr double kMargin = 12;
constexpr double kBarLeft = 130;
constexpr double kBarWidth = 360;
constexpr double kBarHeight = 14;
constexpr double kCurveHeight = 16;
constexpr double kRowHeight = 44;
constexpr int kSteps = 180;

void drawPreset(const Preset& preset, double top, Drawing& drawing) {
    const TransferFunction function = presetFunction(preset.name);
    const glm::dvec2 part = shownPart(preset, function);
    const ColorCurve colors(function);
    const double bottom = top + kBarHeight + kCurveHeight;
    Area under{{{kBarLeft, bottom}}, {120, 120, 120}, 1};
    for (int i = 0; i < kSteps; ++i) {
        const double left = kBarLeft + kBarWidth * i / kSteps;
        const double right = kBarLeft + kBarWidth * (i + 1) / kSteps;
        const double x = part.x + (part.y - part.x) * (i + 0.5) / kSteps;
        drawing.items.emplace_back(
            rectangle({left, top}, {right, top + kBarHeight}, shownColor(colors.at(x))));
        const double height = kCurveHeight * opacityHeight(function.opacityAt(x));
        under.points.push_back({left, bottom - height});
        under.points.push_back({right, bottom - height});
    }
    under.points.push_back({kBarLeft + kBarWidth, bottom});
    drawing.items.emplace_back(std::move(under));
    const auto label = [&](glm::dvec2 at, const std::string& text, double size, bool bold,
                           Label::Anchor anchor) {
        Label item;
        item.at = at;
        item.text = text;
        item.size = size;
        item.bold = bold;
        item.anchor = anchor;
        drawing.items.emplace_back(item);
    };
    label({kMargin, top + 12}, preset.name, 12, true, Label::Anchor::kStart);
    label({kMargin, top + 26}, valuesText(preset.values), 9, false, Label::Anchor::kStart);
    label({kBarLeft, bottom + 9}, numberText(part.x), 8, false, Label::Anchor::kStart);
    label({kBarLeft + kBarWidth, bottom + 9}, numberText(part.y), 8, false, Label::Anchor::kEnd);
}

}  // namespace

glm::dvec2 shownPart(const Preset& preset, const TransferFunction& function) {
    switch (preset.values) {
        case Preset::Values::kHounsfield:
            return {function.opacities.front().x, std::min(function.opacities.back().x, 1500.0)};
        case Preset::Values::kLabels:
            return {0, 32};
        case Preset::Values::kRange:
            break;
    }
    return {0, 1};
}

std::string presetList() {
    std::string text;
    const auto padded = [](std::string word, std::size_t width) {
        word.resize(std::max(word.size() + 1, width), ' ');
        return word;
    };
    for (const Preset& preset : presets()) {
        text +=
            padded(preset.name, 16) + padded(valuesText(preset.values), 18) + preset.summary + "\n";
    }
    return text;
}

Drawing presetSwatches() {
    Drawing drawing;
    drawing.size = {kBarLeft + kBarWidth + kMargin,
                    2 * kMargin + kRowHeight * double(presets().size())};
    double top = kMargin;
    for (const Preset& preset : presets()) {
        drawPreset(preset, top, drawing);
        top += kRowHeight;
    }
    return drawing;
}

}  // namespace deltasplat
