// SPDX-License-Identifier: Apache-2.0
#include "optics/voxel_painter.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/opacity_steps.h"
#include "optics/check_optics.h"

namespace deltasplat {

// The alpha of a step follows from the reduced opacity over a unit distance.
void LookLight::fade(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const {
    unsigned any = 0;
    for (std::size_t n = 0; n < 64; ++n) any |= looks[n].faded;
    if (any == 0) return;
    std::array<float, 64> opacities;
    for (std::size_t n = 0; n < 64; ++n) {
        const float left = float(OwnLook::kAll - looks[n].faded) / OwnLook::kAll;
        opacities[n] = left * units_.opacityOf(classes[n]);
    }
    std::array<float, 64 + kStepsSpare> steps;
    steps.fill(units_.unitDistances());
    repeatOpacity(opacities.data(), steps.data(), opacities.size());
    for (std::size_t n = 0; n < 64; ++n) {
        const float alpha = units_.alphaOf(classes[n]);
        if (looks[n].faded == 0 || alpha == 0) continue;
        const float ratio = std::min(opacities[n] * units_.unitsOfOpaque() / alpha, 1.0f);
        for (auto& channel : colors) channel[n] *= ratio;
    }
}

std::unique_ptr<const VoxelPainter> makePainter(const Volume& volume, const Optics& optics) {
    checkOptics(optics);
    const bool isMedium = !optics.parts.empty() || optics.colorGrids;
    if (isMedium) return makeMediumPainter(volume, optics);
    if (volume.empty()) return nullptr;
    if (optics.scattering) return makeScatterPainter(volume, optics);
    if (optics.surface) return makeSurfacePainter(volume, *optics.surface, optics.shading);
    std::unique_ptr<const VoxelPainter> painter;
    if (optics.colorBy != ColorBy::kValue) {
        painter = makePositionPainter(volume, optics.colorBy);
    } else if (optics.shading) {
        painter = makeShadingPainter(volume, *optics.shading);
    }
    if (optics.gradientOpacity.empty()) return painter;
    return makeFadingPainter(volume, optics.gradientOpacity, std::move(painter));
}

ClassLight::ClassLight(const ClassTable& classes)
    : LookLight(VoxelUnits(classes, brightestOf(classes))),
      colors_(units().unitsOfClasses(classes)) {}

void ClassLight::lightVoxels(const WordPlace&, const std::uint16_t* classes, const OwnLook*,
                             WordUnits& colors) const {
    for (std::size_t n = 0; n < 64; ++n)
        for (int c = 0; c < 4; ++c) colors[std::size_t(c)][n] = colors_[classes[n]][c];
}

}  // namespace deltasplat
