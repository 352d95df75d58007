// SPDX-License-Identifier: Apache-2.0
#include "optics/check_optics.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

void requireThat(bool holds, const std::string& option, const std::string& got,
                 const std::string& expected) {
    if (!holds) throw Error(ErrorCode::kUsage, option, got, expected);
}

template <typename Point>
void checkPlaces(const char* points, const std::vector<Point>& all) {
    requireThat(!all.empty(), points, "none", "at least one");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double x = all[i].x;
        requireThat(std::isfinite(x), points, "x = " + numberText(x), "a finite number");
        requireThat(i == 0 || all[i - 1].x <= x, points,
                    "x = " + numberText(x) + " behind " + numberText(i == 0 ? x : all[i - 1].x),
                    "x not decreasing");
    }
}

void checkLight(const std::string& option, double number) {
    requireThat(number >= 0 && number <= kMostLight, option, numberText(number),
                "a number within 0..1e6");
}

void checkPointLight(const std::string& option, const Light& light) {
    for (int i = 0; i < 3; ++i) {
        requireThat(std::abs((*light.positionWorld)[i]) <= kFarthestLight, option + " position",
                    numberText(*light.positionWorld), "numbers from -1e30 to 1e30");
    }
    requireThat(light.radiusWorld >= 0 && light.radiusWorld <= kFarthestLight, option + " radius",
                numberText(light.radiusWorld), "a number within 0..1e30");
}

void checkLights(const std::string& option, const std::vector<Light>& lights) {
    for (const Light& light : lights) {
        checkLight(option + " strength", light.strength);
        for (int i = 0; i < 3; ++i) {
            checkLight(option + " colour", light.color[i]);
            requireThat(std::isfinite(light.direction[i]), option + " direction",
                        numberText(light.direction), "finite numbers");
        }
        if (light.positionWorld) checkPointLight(option, light);
        const glm::dvec3 way = glm::abs(light.direction);
        const bool hasWay = light.frame != LightFrame::kHead && !light.positionWorld;
        requireThat(!hasWay || std::max({way.x, way.y, way.z}) > 0, option + " direction",
                    numberText(light.direction), "not all 0");
    }
}

void checkShading(const Shading& shading) {
    checkLight("`shading.ambient`", shading.ambient);
    checkLight("`shading.diffuse`", shading.diffuse);
    checkLight("`shading.specular`", shading.specular);
    checkLight("`shading.shininess`", shading.shininess);
    if (shading.noise) {
        requireThat(std::isfinite(*shading.noise) && *shading.noise > 0, "`shading.noise`",
                    numberText(*shading.noise), "a number > 0");
    }
    checkLights("`shading.lights`", shading.lights);
    for (const Light& light : shading.lights) {
        requireThat(!light.positionWorld, "`shading.lights`", "a point light",
                    "lights from far away, as without `scattering`");
    }
}

bool isShare(double number) {
    return number >= 0 && number <= 1;
}

void checkSurface(const Optics& optics) {
    requireThat(optics.colorBy == ColorBy::kValue, "`surface`",
                "`colorBy` " + colorByName(optics.colorBy) + " besides", "`colorBy` value");
    requireThat(optics.gradientOpacity.empty(), "`surface`", "`gradientOpacity` besides",
                "one of the two");
    requireThat(std::isfinite(optics.surface->isovalue), "`surface.isovalue`",
                numberText(optics.surface->isovalue), "a finite number");
    for (int i = 0; i < 3; ++i) checkLight("`surface.color`", optics.surface->color[i]);
}

// Options that cannot be combined with scattering, other parts or colour grids.
void requireFog(const Optics& optics, const std::string& option) {
    const char* besides = optics.shading                    ? "`shading` besides"
                          : optics.surface                  ? "`surface` besides"
                          : !optics.gradientOpacity.empty() ? "`gradientOpacity` besides"
                                                            : nullptr;
    requireThat(!besides, option, besides ? besides : "", "one of the two");
    requireThat(optics.colorBy == ColorBy::kValue, option,
                "`colorBy` " + colorByName(optics.colorBy) + " besides", "`colorBy` value");
}

void checkScattering(const Optics& optics) {
    requireFog(optics, "`scattering`");
    const Scattering& scattering = *optics.scattering;
    for (int i = 0; i < 3; ++i) {
        requireThat(isShare(scattering.albedo[i]), "`scattering.albedo`",
                    numberText(scattering.albedo), "numbers within 0..1");
        checkLight("`scattering.ambient`", scattering.ambient[i]);
    }
    for (const double g : {scattering.anisotropy, scattering.backAnisotropy}) {
        requireThat(std::abs(g) <= kMostAnisotropy, "`scattering.anisotropy`", numberText(g),
                    "a number within -0.99..0.99");
    }
    requireThat(isShare(scattering.backShare), "`scattering.backShare`",
                numberText(scattering.backShare), "a number within 0..1");
    requireThat(scattering.octaves >= 0 && scattering.octaves <= kMostOctaves,
                "`scattering.octaves`", std::to_string(scattering.octaves),
                "a whole number within 0.." + std::to_string(kMostOctaves));
    checkLights("`scattering.lights`", scattering.lights);
    for (const Light& light : scattering.lights) {
        requireThat(light.frame == LightFrame::kWorld, "`scattering.lights`",
                    "one that moves with the camera", "lights of the world");
    }
}

void checkTransferFunction(const TransferFunction& function) {
    constexpr const char* kColors = "transfer function's colours";
    checkPlaces(kColors, function.colors);
    for (const TransferFunction::ColorPoint& point : function.colors) {
        for (int i = 0; i < 3; ++i) {
            const double part = point.rgb[i];
            requireThat(std::isfinite(part) && part >= 0, kColors, numberText(part),
                        "a finite number >= 0");
        }
    }
    constexpr const char* kOpacities = "transfer function's opacities";
    checkPlaces(kOpacities, function.opacities);
    for (const TransferFunction::OpacityPoint& point : function.opacities) {
        for (const double number : {point.opacity, point.midpoint, point.sharpness})
            requireThat(isShare(number), kOpacities, numberText(number), "a number within 0..1");
    }
}

void checkRange(const std::string& option, const glm::dvec2& range) {
    requireThat(std::isfinite(range.x) && std::isfinite(range.y) && range.x < range.y, option,
                numberText(range), "LO,HI with LO < HI");
}

void checkPart(const MediumPart& part, bool isLit) {
    constexpr const char* kOption = "`parts`";
    requireThat(part.volume != nullptr, kOption, "one without a volume", "volumes");
    const bool absorbs = part.kind == MediumPart::Kind::kAbsorption;
    if (!absorbs) checkLight("`parts` strength", part.strength);
    requireThat(std::isfinite(part.strength) && part.strength >= 0, "`parts` strength",
                numberText(part.strength), "a number >= 0");
    requireThat(!absorbs || !isLit, kOption, "one that swallows light, with `scattering` besides",
                "one of the two");
    for (const double number : {part.kelvinScale, part.kelvinOffset}) {
        requireThat(std::isfinite(number), "`parts` kelvin", numberText(number), "a finite number");
    }
    if (part.range) checkRange("`parts` range", *part.range);
    if (part.kind != MediumPart::Kind::kBlackbody) checkTransferFunction(part.transferFunction);
}

void checkMedium(const Optics& optics) {
    const std::size_t most =
        optics.colorGrids ? std::size_t(kMostPartsWithColors) : std::size_t(kMostParts);
    requireThat(
        optics.parts.size() <= most, "`parts`", std::to_string(optics.parts.size()),
        "at most " + std::to_string(most) + (optics.colorGrids ? " with `colorGrids`" : ""));
    if (!optics.parts.empty()) requireFog(optics, "`parts`");
    for (const MediumPart& part : optics.parts) checkPart(part, optics.scattering.has_value());
    if (!optics.colorGrids) return;
    requireFog(optics, "`colorGrids`");
    for (const auto& grid : *optics.colorGrids) {
        requireThat(grid != nullptr, "`colorGrids`", "one without a volume", "three volumes");
        requireThat(grid->empty() || grid->valueMin() >= 0, "`colorGrids`",
                    "a colour of " + numberText(grid->valueMin()), "colours >= 0");
    }
}

void checkGradientOpacity(const std::vector<glm::dvec2>& points) {
    if (points.empty()) return;
    constexpr const char* kOption = "`gradientOpacity`";
    checkPlaces(kOption, points);
    for (const glm::dvec2& point : points) {
        requireThat(point.x >= 0, kOption, "x = " + numberText(point.x), "a number >= 0");
        requireThat(isShare(point.y), kOption, numberText(point.y), "a number within 0..1");
    }
}

}  // namespace

void checkOptics(const Optics& optics) {
    if (!optics.surface) checkTransferFunction(optics.transferFunction);
    if (optics.unitDistance) {
        const double unit = *optics.unitDistance;
        requireThat(std::isfinite(unit) && unit > 0, "`unitDistance`", numberText(unit),
                    "a number > 0");
    }
    const int colorBy = int(optics.colorBy);
    requireThat(colorBy >= int(ColorBy::kValue) && colorBy <= int(ColorBy::kIndex), "`colorBy`",
                std::to_string(colorBy), "one of ColorBy");
    if (optics.shading) {
        requireThat(optics.colorBy == ColorBy::kValue, "`shading`",
                    "`colorBy` " + colorByName(optics.colorBy) + " besides", "`colorBy` value");
        checkShading(*optics.shading);
    }
    if (optics.surface) checkSurface(optics);
    checkGradientOpacity(optics.gradientOpacity);
    if (optics.scattering) checkScattering(optics);
    checkMedium(optics);
    const double extinction = optics.extinctionScale;
    requireThat(std::isfinite(extinction) && extinction >= 0, "`extinctionScale`",
                numberText(extinction), "a number >= 0");
    if (optics.densityScale) {
        const double scale = *optics.densityScale;
        requireThat(std::isfinite(scale) && scale >= 0, "`densityScale`", numberText(scale),
                    "a number >= 0");
        requireThat(!optics.surface, "`densityScale`", "`surface` besides", "one of the two");
    }
    if (optics.range) checkRange("`range`", *optics.range);
}

}  // namespace deltasplat
