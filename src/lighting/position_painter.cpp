// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <limits>

#include "base/enum_name.h"
#include "optics/voxel_painter.h"

namespace deltasplat {
namespace {

// Looks are colours.
class OwnColors : public LookLight {
  public:
    explicit OwnColors(const ClassTable& classes) : LookLight(VoxelUnits(classes, glm::dvec3(1))) {}

  protected:
    void lightVoxels(const WordPlace&, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override {
        for (std::size_t n = 0; n < 64; ++n) {
            const glm::vec4 color = units().unitsOf(classes[n], glm::vec3(colorOfLook(looks[n])));
            for (int c = 0; c < 4; ++c) colors[std::size_t(c)][n] = color[c];
        }
    }
};

// Colours that grow evenly from one end of the volume to the other.
class PositionPainter : public VoxelPainter {
  public:
    // A channel is slopes[channel] * index position + starts[channel], of 0..1.
    PositionPainter(const glm::dmat3& slopes, const glm::dvec3& starts)
        : slopes_(slopes), starts_(starts) {}

    bool needsColors() const override { return false; }
    bool dependsOnCamera() const override { return false; }

    void paint(const BlockPlace& place, const BlockField*, std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        for (std::size_t n = 0; n < looks.size(); ++n) {
            if (classes[n] == 0) continue;
            const glm::dvec3 steps(glm::ivec3(n / 64, n / 8 % 8, n % 8));
            const glm::dvec3 index = place.first + place.steps * steps;
            glm::dvec3 color;
            for (int c = 0; c < 3; ++c) color[c] = glm::dot(slopes_[c], index) + starts_[c];
            looks[n] = lookOfColor(glm::clamp(color, 0.0, 1.0));
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene*) const override {
        return std::make_unique<OwnColors>(classes);
    }

  private:
    glm::dmat3 slopes_;  // [channel]
    glm::dvec3 starts_;
};

// A number that grows evenly: slope * index position + start.
struct Share {
    glm::dvec3 slope{0.0};
    double start = 0;
};

// Of the way from the voxel centre that lies lowest along `slope` to the highest; 0 if there is but
// one place.
Share shareAlong(const glm::dvec3& slope, const IndexBox& box) {
    double low = 0;
    double high = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double ends[] = {slope[axis] * box.min[axis], slope[axis] * box.max[axis]};
        low += std::min(ends[0], ends[1]);
        high += std::max(ends[0], ends[1]);
    }
    const Share share{slope / (high - low), -low / (high - low)};
    const double sum = share.slope.x + share.slope.y + share.slope.z + share.start;
    return high - low > 0 && std::isfinite(sum) ? share : Share{};
}

}  // namespace

std::string colorByName(ColorBy colorBy) {
    return enumName(colorBy, {"value", "x", "y", "z", "index"});
}

std::unique_ptr<const VoxelPainter> makePositionPainter(const Volume& volume, ColorBy colorBy) {
    glm::dmat3 slopes(0.0);
    glm::dvec3 starts(0.0);
    const auto setChannel = [&](int channel, const Share& share) {
        slopes[channel] = share.slope;
        starts[channel] = share.start;
    };
    if (colorBy == ColorBy::kIndex) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 along(0.0);
            along[axis] = 1;
            setChannel(axis, shareAlong(along, volume.box));
        }
    } else {
        const int axis = int(colorBy) - int(ColorBy::kX);
        const glm::dmat4& world = volume.worldFromIndex;
        const Share share =
            shareAlong({world[0][axis], world[1][axis], world[2][axis]}, volume.box);
        setChannel(0, share);
        setChannel(2, {-share.slope, 1 - share.start});
    }
    return std::make_unique<PositionPainter>(slopes, starts);
}

}  // namespace deltasplat
