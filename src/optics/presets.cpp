// SPDX-License-Identifier: Apache-2.0
// Based on: G. N. Hounsfield, "Computed medical imaging", 1980, and textbook ranges of Hounsfield
// units (lung -950 to -500, fat -150 to -50, muscle 30 to 70, blood with contrast agent 150 to 500,
// cancellous bone from 200, cortical bone 700 to 2000); Kenneth Moreland, "Diverging Color Maps for
// Scientific Visualization", 2009 (coolwarm).
// Data: viridis, inferno, magma and plasma by Nathaniel J. Smith and Stefan van der Walt, 2015
// (CC0); cividis by Jamie R. Nunez, Christopher R. Anderton and Ryan S. Renslow, "Optimizing
// colormaps with consideration for color vision deficiency", 2018 (CC0); turbo by Anton Mikhailov,
// Google, 2019 (Apache-2.0): every fifth of their 256 colours, which lie within 0.016 of straight
// lines between.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/optics/presets.h"
#include "deltasplat/optics/surface.h"
#include "deltasplat/optics/transfer_function.h"
#include "optics/color_space.h"
#include "optics/label_function.h"

namespace deltasplat {
namespace {

/// Returns the sRGB colours of viridis, inferno, magma, plasma, cividis or turbo; else none.
std::vector<TransferFunction::ColorPoint> colorMap(const std::string& name);

namespace {

struct ColorMap {
    std::string_view name;
    std::string_view colors;  // sRGB, RRGGBB, separated by spaces
};

constexpr ColorMap kMaps[] = {
    {"viridis",
     "440154 46085c 471063 481769 481d6f 482475 472a7a 46307e 453781 433d84 414287 3f4889 "
     "3d4e8a 3a538b 38598c 355e8d 33638d 31688e 2e6d8e 2c718e 2a768e 297b8e 27808e 25848e "
     "23898e 218e8d 20928c 1f978b 1e9c89 1fa188 21a585 24aa83 28ae80 2eb37c 35b779 3dbc74 "
     "46c06f 50c46a 5ac864 65cb5e 70cf57 7cd250 89d548 95d840 a2da37 b0dd2f bddf26 cae11f "
     "d8e219 e5e419 f1e51d fde725"},
    {"inferno",
     "000004 02020c 050417 0a0722 10092d 160b39 1e0c45 260c51 2f0a5b 380962 400a67 490b6a "
     "510e6c 59106e 61136e 69166e 71196e 781c6d 801f6c 88226a 902568 982766 a02a63 a82e5f "
     "b0315b b73557 bf3952 c63d4d cc4248 d34743 d94d3d df5337 e45a31 e9612b ed6925 f1711f "
     "f47918 f78212 f98b0b fa9407 fb9d07 fca60c fcb014 fbba1f fac42a f8cd37 f6d746 f4e156 "
     "f2ea69 f2f27d f5f992 fcffa4"},
    {"magma",
     "000004 02020b 050416 090720 0e0b2b 140e36 1a1042 21114e 29115a 311165 390f6e 420f75 "
     "4a1079 52137c 5a167e 621980 6a1c81 721f81 792282 812581 892881 912b81 992d80 a1307e "
     "aa337d b2357b ba3878 c23b75 ca3e72 d2426f d9466b e04c67 e75263 ec5860 f1605d f4695c "
     "f7725c f97b5d fb8560 fc8e64 fd9869 fea16e feaa74 feb47b febd82 fec68a fecf92 fed89a "
     "fde2a3 fdebac fcf4b6 fcfdbf"},
    {"plasma",
     "0d0887 1b068d 260591 2f0596 38049a 41049d 4903a0 5102a3 5901a5 6100a7 6900a8 7100a8 "
     "7801a8 8004a8 8707a6 8e0ca4 9511a1 9c179e a21d9a a82296 ae2892 b42e8d ba3388 bf3984 "
     "c43e7f c9447a cd4a76 d24f71 d6556d da5b69 de6164 e26660 e66c5c e97257 ed7953 f07f4f "
     "f3854b f58c46 f79342 f99a3e fba139 fca835 fdaf31 feb72d febe2a fdc627 fcce25 fbd724 "
     "f8df25 f6e826 f3f027 f0f921"},
    {"cividis",
     "00224e 002656 002a5f 002d68 003070 083370 163770 203a6f 273e6e 2e416d 34456c 3a486c "
     "3f4c6c 444f6c 49536c 4e566c 535a6d 575d6d 5c616e 60646f 656870 696b71 6d6f72 727274 "
     "767676 7a7a78 7e7d78 838179 888578 8d8878 928c78 969077 9b9476 a09875 a59c74 aaa073 "
     "afa471 b5a86f baac6d bfb06b c4b468 c9b965 cfbd62 d4c15f dac65b dfca57 e5cf52 ead34c "
     "f0d846 f6dd3f fce236 fee838"},
    {"turbo",
     "30123b 36215f 3b2f80 3f3e9c 424bb5 4559cb 4666dd 4773eb 4680f6 458cfd 4099ff 38a5fb "
     "2fb2f4 27bee9 1fc9dd 1ad4d0 18ddc2 1ae4b6 22ebaa 2ff19b 3ff68a 52fa7a 65fd69 79fe59 "
     "8bff4b 9cfe40 a9fb39 b7f735 c3f134 d0ea34 dbe236 e5d938 eecf3a f5c53a faba39 fdae35 "
     "fea130 fe932a fc8423 f9751d f46617 ef5811 e84b0c e14109 d83706 ce2d04 c32503 b71d02 "
     "a91601 9b0f01 8b0902 7a0403"},
};

int hexDigit(char c) {
    return c <= '9' ? c - '0' : c - 'a' + 10;
}

}  // namespace

std::vector<TransferFunction::ColorPoint> colorMap(const std::string& name) {
    std::vector<TransferFunction::ColorPoint> points;
    for (const ColorMap& map : kMaps) {
        if (map.name != name) continue;
        const std::size_t count = (map.colors.size() + 1) / 7;
        for (std::size_t i = 0; i < count; ++i) {
            const auto channel = [&](std::size_t n) {
                const std::size_t at = 7 * i + 2 * n;
                return (16 * hexDigit(map.colors[at]) + hexDigit(map.colors[at + 1])) / 255.0;
            };
            points.push_back({double(i) / double(count - 1), {channel(0), channel(1), channel(2)}});
        }
    }
    return points;
}

}  // namespace

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

// Hues a golden section apart never repeat, and neighbours differ much.
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
    // A range needs some width, too small to contain other values.
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
    if (preset && preset->values == Preset::Values::kLabels && volume.labels())
        optics.transferFunction = withColors(optics.transferFunction, *volume.labels());
    if (isLevelSet(volume)) optics.surface = Surface{};
    const bool isScan = preset && preset->values == Preset::Values::kHounsfield;
    if (isScan || optics.surface || volume.fromLevelSet()) optics.shading = Shading{};
    return optics;
}

}  // namespace deltasplat
