// SPDX-License-Identifier: Apache-2.0
#include "flag_names.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace deltasplat {
namespace {

struct FlagName {
    std::string_view field;  // as the library has it between backquotes
    std::string_view flag;
};

// A field of a nested struct stands without it, unless another one has the same name.
constexpr FlagName kFlagNames[] = {
    {"aovs", "--aov"},
    {"apertureMm", "--aperture"},
    {"azimuthDegrees", "--azimuth"},
    {"background", "--background"},
    {"between", "--between"},
    {"bigEndian=false", "--endian little"},
    {"bigEndian=true", "--endian big"},
    {"bits", "--bits"},
    {"channels", "--aov"},
    {"clipPlanes", "--clip"},
    {"colorBy", "--color-by"},
    {"colorGrids", "--color-grid"},
    {"colorSpace", "--colorspace"},
    {"compression", "--compression"},
    {"confineInputs", "--confine"},
    {"count", "--env-lights"},
    {"cropIndex", "--crop"},
    {"cropWorld", "--crop"},
    {"densityScale", "--density-scale"},
    {"depthOpacity", "--depth-opacity"},
    {"depthShade", "--depth-shade"},
    {"detectorWorld", "--detector"},
    {"dims", "--dims"},
    {"direction", "--direction"},
    {"display", "--display"},
    {"displayView", "--display-view"},
    {"distanceWorld", "--distance"},
    {"dropBackground", "--background"},
    {"drr.muWater", "--mu-water"},
    {"drr.photons", "--photons"},
    {"elevationDegrees", "--elevation"},
    {"emissionLights", "--emission-lights"},
    {"exposureStops", "--exposure"},
    {"extinctionScale", "--extinction"},
    {"eyeWorld", "--eye"},
    {"floatExr", "--float"},
    {"focalMm", "--focal"},
    {"fovDegrees", "--fov"},
    {"frameOffset", "--frame-offset"},
    {"frameWidthWorld", "--frame-width"},
    {"gradientOpacity", "--gradient-opacity"},
    {"gridName", "--grid"},
    {"ground", "--ground"},
    {"groundAlbedo", "--sky"},
    {"image.size", "--size"},
    {"labels.hidden", "--hide-labels"},
    {"labels.opacities", "--label-opacity"},
    {"labels.shown", "--show-labels"},
    {"look", "--look"},
    {"mask", "--mask"},
    {"maxError", "--max-error"},
    {"memoryLimit", "--max-memory"},
    {"mode", "--mode"},
    {"mostJoined", "--join"},
    {"name", "NAME"},
    {"nanValue", "--nan"},
    {"nearWorld", "--near"},
    {"noise", "--noise"},
    {"origin", "--origin"},
    {"overscanPixels", "--overscan"},
    {"paletteNumbers=true", "--palette index"},
    {"parts", "--emission-grid"},
    {"picture", "--aov transmittance"},
    {"pixelAspect", "--pixel-aspect"},
    {"projection", "--projection"},
    {"range", "--range"},
    {"region", "--region"},
    {"resolution", "--resolution"},
    {"rgb", "--env"},
    {"rollDegrees", "--roll"},
    {"samples", "--samples"},
    {"scattering", "--lighting scatter"},
    {"scattering.albedo", "--albedo"},
    {"scattering.ambient", "--ambient"},
    {"scattering.anisotropy", "--anisotropy"},
    {"scattering.backShare", "--anisotropy"},
    {"scattering.lights", "--light"},
    {"scattering.octaves", "--scatter-octaves"},
    {"series", "--series"},
    {"shading", "--shade"},
    {"shading.ambient", "--ambient"},
    {"shading.diffuse", "--diffuse"},
    {"shading.lights", "--light"},
    {"shading.noise", "--shade"},
    {"shading.shininess", "--shininess"},
    {"shading.specular", "--specular"},
    {"share", "--slab-range"},
    {"sigma", "--sigma"},
    {"sizePixels", "--size"},
    {"skipBytes", "--skip-bytes"},
    {"slices", "--slices"},
    {"slicesPerSample", "--deep-slices"},
    {"sourceToDetectorWorld", "--sdd"},
    {"sourceToIsocenterWorld", "--sid"},
    {"spacing", "--spacing"},
    {"strength", "--sky"},
    {"surface", "--surface"},
    {"surface.color", "--surface-color"},
    {"surface.isovalue", "--isovalue"},
    {"targetWorld", "--target"},
    {"tolerance.relative", "--tolerance"},
    {"tolerance.value", "--tolerance-value"},
    {"towardsSun", "--sky"},
    {"transferFunction", "--tf"},
    {"turbidity", "--turbidity"},
    {"type", "--type"},
    {"unitDistance", "--unit-distance"},
    {"up", "--up"},
    {"view", "--view"},
    {"volume", "--volume"},
    {"worldFromCamera", "--camera-matrix"},
    {"workingSpace", "--working-space"},
    {"worldFromEnvironment", "--env"},
};

}  // namespace

std::string withFlagNames(const std::string& text) {
    std::string said;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::size_t open = std::min(rest.find('`'), rest.size());
        said += rest.substr(0, open);
        rest.remove_prefix(open);
        const std::size_t close = rest.find('`', 1);
        const std::string_view field =
            close < rest.size() ? rest.substr(1, close - 1) : std::string_view();
        const auto known = std::find_if(std::begin(kFlagNames), std::end(kFlagNames),
                                        [&](const FlagName& name) { return name.field == field; });
        if (known != std::end(kFlagNames)) {
            said += known->flag;
            rest.remove_prefix(close + 1);
        } else if (!rest.empty()) {
            // What follows may be one, and its end the beginning of another.
            said += '`';
            rest.remove_prefix(1);
        }
    }
    return said;
}

}  // namespace deltasplat
