// SPDX-License-Identifier: Apache-2.0
// Based on: G. N. Hounsfield, "Computed medical imaging", 1980, and textbook ranges of Hounsfield
// units (lung -950 to -500, fat -150 to -50, muscle 30 to 70, blood with contrast agent 150 to 500,
// cancellous bone from 200, cortical bone 700 to 2000); Kenneth Moreland, "Diverging Color Maps for
// Scientific Visualization", 2009 (coolwarm).
#include "deltasplat/optics/presets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/default_floats.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/optics/surface.h"
#include "optics/color_maps.h"
#include "optics/color_space.h"
#include "optics/label_function.h"

namespace deltasplat {
namespace {

using Values = Preset::Values;
using Colors = std::vector<TransferFunction::ColorPoint>;
using Opacities = std::vector<TransferFunction::OpacityPoint>;

const std::vector<Preset> kPresets = {
    {"grey", Values::kRange, "black to white"},
    {"ct-bone", Values::kHounsfield, "skeleton, contrast agent"},
    {"ct-soft-tissue", Values::kHounsfield, "skin, fat, muscle and bone"},
    {"ct-lung", Values::kHounsfield, "lungs and their vessels, without the body"},
    {"ct-angio", Values::kHounsfield, "vessels with contrast agent, and bone"},
    {"mr", Values::kRange, "soft tissue"},
    {"mr-angio", Values::kRange, "vessels, brighter than all else"},
    {"pet", Values::kRange, "activity: black, purple, red, yellow, white"},
    {"fire", Values::kRange, "flames, brighter than white where hot (scene-linear)"},
    {"smoke", Values::kRange, "white fog, the more the denser"},
    {"labels", Values::kLabels, "a colour for each whole number to 65535, 0 is clear"},
    {"viridis", Values::kRange, "even steps of lightness: purple, green, yellow"},
    {"inferno", Values::kRange, "even steps: black, red, yellow"},
    {"magma", Values::kRange, "even steps: black, magenta, pale yellow"},
    {"plasma", Values::kRange, "even steps: blue, magenta, yellow"},
    {"cividis", Values::kRange, "even steps, the same to the colour-blind"},
    {"turbo", Values::kRange, "rainbow with smooth lightness"},
    {"coolwarm", Values::kRange, "blue to red through grey"},
};

struct Recipe {
    const char* name;
    Colors colors;  // sRGB
    Opacities opacities;
};

// Points of straight lines.
Opacities straight(std::initializer_list<glm::dvec2> points) {
    Opacities opacities;
    for (const glm::dvec2& point : points) opacities.push_back({point.x, point.y, 0.5, 0});
    return opacities;
}

const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> all = {
        {"grey", {{0, {0, 0, 0}}, {1, {1, 1, 1}}}, straight({{0, 0}, {1, kRampOpacity}})},
        {"ct-bone",
         {{150, {0.55, 0.25, 0.15}},
          {250, {0.75, 0.5, 0.35}},
          {500, {0.93, 0.84, 0.68}},
          {1000, {1, 0.98, 0.92}}},
         straight({{150, 0}, {300, 0.12}, {600, 0.45}, {1200, 0.75}, {3000, 0.9}})},
        {"ct-soft-tissue",
         {{-300, {0.85, 0.62, 0.5}},
          {-100, {0.92, 0.76, 0.55}},
          {-20, {0.8, 0.5, 0.38}},
          {50, {0.7, 0.28, 0.22}},
          {120, {0.78, 0.36, 0.28}},
          {250, {0.93, 0.82, 0.66}},
          {1000, {1, 0.98, 0.93}}},
         straight({{-400, 0},
                   {-200, 0.02},
                   {-60, 0.02},
                   {20, 0.1},
                   {80, 0.14},
                   {200, 0.3},
                   {500, 0.6},
                   {3000, 0.85}})},
        {"ct-lung",
         {{-1000, {0.25, 0.4, 0.6}},
          {-850, {0.45, 0.62, 0.8}},
          {-650, {0.75, 0.78, 0.8}},
          {-500, {0.9, 0.62, 0.55}},
          {-200, {0.85, 0.3, 0.25}}},
         straight({{-980, 0}, {-900, 0.012}, {-700, 0.02}, {-550, 0.1}, {-400, 0.05}, {-250, 0}})},
        {"ct-angio",
         {{100, {0.45, 0.03, 0.03}},
          {220, {0.8, 0.12, 0.08}},
          {400, {0.95, 0.5, 0.3}},
          {600, {0.97, 0.86, 0.7}},
          {1200, {1, 0.98, 0.94}}},
         straight({{110, 0}, {180, 0.08}, {300, 0.35}, {600, 0.6}, {3000, 0.85}})},
        {"mr",
         {{0, {0.1, 0.08, 0.1}},
          {0.3, {0.55, 0.4, 0.36}},
          {0.6, {0.85, 0.74, 0.66}},
          {1, {1, 0.98, 0.95}}},
         straight({{0.08, 0}, {0.25, 0.03}, {0.6, 0.1}, {1, 0.3}})},
        {"mr-angio",
         {{0.25, {0.35, 0.02, 0.02}},
          {0.5, {0.85, 0.2, 0.1}},
          {0.75, {0.98, 0.65, 0.4}},
          {1, {1, 0.95, 0.88}}},
         straight({{0.28, 0}, {0.4, 0.04}, {0.6, 0.3}, {1, 0.7}})},
        {"pet",
         {{0, {0, 0, 0}},
          {0.2, {0.25, 0, 0.45}},
          {0.4, {0.7, 0.05, 0.25}},
          {0.6, {0.95, 0.4, 0.05}},
          {0.8, {1, 0.8, 0.2}},
          {1, {1, 1, 1}}},
         straight({{0.05, 0}, {0.4, 0.03}, {0.7, 0.12}, {1, 0.4}})},
        {"smoke", {{0, {1, 1, 1}}}, straight({{0, 0}, {1, kRampOpacity}})},
        {"coolwarm",
         {{0, {0.230, 0.299, 0.754}}, {1, {0.706, 0.016, 0.150}}},
         straight({{0, 0}, {1, kRampOpacity}})},
    };
    return all;
}

TransferFunction fire() {
    TransferFunction function;
    function.linearColors = true;
    function.colors = {{0, {0, 0, 0}},
                       {0.25, {0.25, 0.01, 0}},
                       {0.5, {1, 0.18, 0.01}},
                       {0.75, {1.6, 0.75, 0.12}},
                       {1, {2, 1.5, 0.8}}};
    function.opacities = straight({{0.05, 0}, {0.5, 0.05}, {1, 0.15}});
    return function;
}

// Hues that are a golden section of the circle apart never come back, and neighbours differ much.
glm::dvec3 labelColor(int label) {
    const double turns = label * (std::numbers::phi - 1);
    const double saturation[] = {0.65, 0.85, 0.5};
    const double value[] = {0.95, 0.8};
    return rgbFromHsv({turns - std::floor(turns), saturation[label % 3], value[label / 3 % 2]});
}

TransferFunction labels() {
    std::vector<LabelLook> looks;
    for (int label = 1; label <= kLargestPresetLabel; ++label)
        looks.push_back({label, labelColor(label), 0.4});
    return labelFunction(looks);
}

TransferFunction functionOf(const std::string& name) {
    if (name == "fire") return fire();
    if (name == "labels") return labels();
    TransferFunction function;
    for (const Recipe& recipe : recipes()) {
        if (recipe.name != name) continue;
        function.colors = recipe.colors;
        function.opacities = recipe.opacities;
        if (name == "coolwarm") function.colorSpace = ColorSpace::kDiverging;
        return function;
    }
    function.colors = colorMap(name);
    function.opacities = straight({{0, 0}, {1, kRampOpacity}});
    return function;
}

}  // namespace

const std::vector<Preset>& presets() {
    return kPresets;
}

const Preset* findPreset(const std::string& name) {
    const auto found = std::find_if(kPresets.begin(), kPresets.end(),
                                    [&](const Preset& preset) { return preset.name == name; });
    return found == kPresets.end() ? nullptr : &*found;
}

TransferFunction presetFunction(const std::string& name) {
    const Preset* preset = findPreset(name);
    if (!preset) {
        std::string known;
        for (const Preset& one : kPresets) known += (known.empty() ? "" : ", ") + one.name;
        throw Error(ErrorCode::kUsage, "preset", name, "one of " + known);
    }
    TransferFunction function = functionOf(name);
    function.name = name;
    function.normalized = preset->values == Values::kRange;
    return function;
}

void fitPreset(const Preset& preset, const Volume& volume, Optics& optics) {
    if (preset.values != Values::kRange || optics.range) return;
    const DefaultFloats floats;
    glm::dvec2 range = rampRange(volume);
    // A range has some width: so little that no other value lies in it.
    constexpr double kLeast = 1e-300;
    if (range.x == range.y)
        range.x = std::min(std::nextafter(range.y, -HUGE_VAL), range.y - kLeast);
    optics.range = range;
}

const Preset* defaultPreset(const Volume& volume) {
    if (holdsLabels(volume)) return findPreset(kLabelPreset);
    return isHounsfield(volume) ? findPreset(kScanPreset) : nullptr;
}

Optics defaultOptics(const Volume& volume) {
    const Preset* const preset = defaultPreset(volume);
    Optics optics;
    optics.transferFunction = preset ? presetFunction(preset->name) : defaultRamp(volume);
    if (preset && preset->values == Preset::Values::kLabels && volume.labels)
        optics.transferFunction = withColors(optics.transferFunction, *volume.labels);
    if (isLevelSet(volume)) optics.surface = Surface{};
    const bool isScan = preset && preset->values == Preset::Values::kHounsfield;
    if (isScan || optics.surface || volume.fromLevelSet) optics.shading = Shading{};
    return optics;
}

}  // namespace deltasplat
