// SPDX-License-Identifier: Apache-2.0
// Based on: Bruce Walter et al., "Lightcuts: A Scalable Approach to Illumination", 2005 (groups of
// lights, each with all of its light at one place), with the cuts of Kuntee Viriyothai and Paul
// Debevec, "Variance Minimization Light Probe Sampling", 2009, in space: each cut brings the lights
// closest to the places that shine.
#include "deltasplat/optics/emission_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <queue>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "image/srgb.h"
#include "lighting/part_sampler.h"

namespace deltasplat {
namespace {

struct Moments {
    double energy = 0;    // luminance
    glm::dvec3 place{0};  // sum of energy times place in the world
    double square = 0;    // sum of energy times squared distance from Glow::origin()

    Moments& operator+=(const Moments& other) {
        energy += other.energy;
        place += other.place;
        square += other.square;
        return *this;
    }
    // The sum of energy times squared distance from the mean place.
    double spread() const {
        if (!(energy > 0)) return 0;
        return std::max(0.0, square - glm::dot(place, place) / energy);
    }
};

Moments operator-(const Moments& a, const Moments& b) {
    return {a.energy - b.energy, a.place - b.place, a.square - b.square};
}

struct GlowingBlock {
    glm::ivec3 position;  // (x, y, z) of the first voxel, divided by 8
    glm::dvec3 glow{0};   // radiance per unit distance, summed over voxels
    Moments moments;
};

// Reads the glow at a volume's voxels.
class Glow {
  public:
    Glow(const Volume& volume, const Optics& optics) : worldFromIndex_(volume.worldFromIndex()) {
        const double unitDistances = longestWay(volume, optics);
        PlaceSet places;
        for (const MediumPart& part : optics.parts) {
            if (part.kind == MediumPart::Kind::kAbsorption) continue;
            Part& read = parts_.emplace_back(Part{
                PartSampler(*part.volume, worldFromIndex_, PartSampler::Around::kBackground), {}});
            read.looks = lookUpPart(part, read.sampler.levels(), unitDistances);
            const std::vector<Slot> map(read.looks.ofSlot.begin(), read.looks.ofSlot.end());
            read.sampler.addBlocksSeen(map, places, box_);
        }
        for (const glm::ivec3& position : places) blocks_.push_back({position, {}, {}});
        if (blocks_.empty()) return;
        origin_ = worldOf(0.5 * (glm::dvec3(box_.min) + glm::dvec3(box_.max)));
        parallelFor(blocks_.size(), [&](std::size_t i) { read(blocks_[i]); });
        std::erase_if(blocks_,
                      [](const GlowingBlock& block) { return !(block.moments.energy > 0); });
    }

    /// By PlaceLess.
    const std::vector<GlowingBlock>& blocks() const { return blocks_; }
    /// Places are relative to this, because large coordinates could not tell voxels apart.
    const glm::dvec3& origin() const { return origin_; }

  private:
    struct Part {
        PartSampler sampler;
        PartLooks looks;
    };

    glm::dvec3 worldOf(const glm::dvec3& index) const {
        return glm::dvec3(worldFromIndex_ * glm::dvec4(index, 1));
    }

    void read(GlowingBlock& block) const {
        const BlockPlace place{glm::dvec3(8 * block.position), glm::dmat3(1)};
        std::array<glm::dvec3, 512> glows{};
        std::array<Slot, 512> slots;
        for (const Part& part : parts_) {
            part.sampler.read(place, slots);
            for (std::size_t n = 0; n < slots.size(); ++n)
                glows[n] += part.looks.looks[part.looks.ofSlot[std::size_t(slots[n])]].glow;
        }
        for (int n = 0; n < 512; ++n) {
            const glm::dvec3& glow = glows[std::size_t(n)];
            const double energy = glm::dot(glow, kLuminance);
            if (!(energy > 0)) continue;
            const glm::dvec3 world =
                worldOf(place.first + glm::dvec3(n / 64, n / 8 % 8, n % 8)) - origin_;
            block.glow += glow;
            block.moments += {energy, energy * world, energy * glm::dot(world, world)};
        }
    }

    glm::dmat4 worldFromIndex_;
    std::vector<Part> parts_;
    IndexBox box_;
    glm::dvec3 origin_{0};
    std::vector<GlowingBlock> blocks_;
};

using Group = std::vector<std::uint32_t>;  // numbers of blocks, in order

Moments momentsOf(const Group& group, const std::vector<GlowingBlock>& blocks) {
    Moments sum;
    for (const std::uint32_t number : group) sum += blocks[number].moments;
    return sum;
}

struct RankedGroup {
    double spread;
    Group blocks;

    // The largest spread is cut next; of equal ones, the group of the first block.
    bool operator<(const RankedGroup& other) const {
        return spread != other.spread ? spread < other.spread
                                      : blocks.front() > other.blocks.front();
    }
};

// Cuts a group of several blocks along a plane of blocks, where the parts' spreads sum to least.
std::pair<Group, Group> cut(const Group& group, const std::vector<GlowingBlock>& blocks) {
    const Moments all = momentsOf(group, blocks);
    double least = std::numeric_limits<double>::infinity();
    int bestAxis = 0;
    int bestEnd = 0;
    Group sorted = group;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = [&](std::uint32_t number) { return blocks[number].position[axis]; };
        std::ranges::stable_sort(sorted, {}, at);
        Moments before;
        for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
            before += blocks[sorted[i]].moments;
            if (at(sorted[i]) == at(sorted[i + 1])) continue;
            const double spread = before.spread() + (all - before).spread();
            if (!(spread < least)) continue;
            least = spread;
            bestAxis = axis;
            bestEnd = at(sorted[i + 1]);
        }
    }
    std::pair<Group, Group> parts;
    for (const std::uint32_t number : group) {
        const bool isBefore = blocks[number].position[bestAxis] < bestEnd;
        (isBefore ? parts.first : parts.second).push_back(number);
    }
    return parts;
}

std::vector<Group> cutIntoGroups(const std::vector<GlowingBlock>& blocks, int count) {
    std::vector<Group> whole;
    std::priority_queue<RankedGroup> toCut;
    const auto add = [&](Group group) {
        if (group.size() == 1) return whole.push_back(std::move(group));
        const double spread = momentsOf(group, blocks).spread();
        toCut.push({spread, std::move(group)});
    };
    Group all(blocks.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = std::uint32_t(i);
    if (!all.empty()) add(std::move(all));
    while (!toCut.empty() && whole.size() + toCut.size() < std::size_t(count)) {
        const Group group = toCut.top().blocks;
        toCut.pop();
        auto [before, behind] = cut(group, blocks);
        add(std::move(before));
        add(std::move(behind));
    }
    for (; !toCut.empty(); toCut.pop()) whole.push_back(toCut.top().blocks);
    return whole;
}

// @param perGlow  strength of a light per radiance on a unit distance of a voxel
// @param voxel    mean squared distance within a voxel from its middle
Light lightOf(const Group& group, const Glow& glow, double perGlow, double voxel) {
    const Moments moments = momentsOf(group, glow.blocks());
    glm::dvec3 color(0);
    for (const std::uint32_t number : group) color += glow.blocks()[number].glow;
    color *= perGlow;
    Light light{LightFrame::kWorld};
    light.strength = std::min(std::max({color.r, color.g, color.b}), kMostLight);
    light.color = color / light.strength;
    light.positionWorld = glow.origin() + moments.place / moments.energy;
    // A glowing ball of radius a has a mean squared distance of 3/5 a^2. It lights its middle as
    // its whole power would from a / sqrt(3) away.
    const double square = moments.spread() / moments.energy + voxel;
    light.radiusWorld = std::sqrt(5.0 / 9 * square);
    const double most = std::max({light.color.r, light.color.g, light.color.b});
    if (!(most <= kMostLight)) {
        throw Error(ErrorCode::kInput, "emission",
                    "a light of strength " + numberText(light.strength * most),
                    "at most " + numberText(kMostLight * kMostLight));
    }
    return light;
}

}  // namespace

std::vector<Light> emissionLights(const Volume& volume, const Optics& optics, int count) {
    const DefaultFloats floats;
    if (count < 1) {
        throw Error(ErrorCode::kUsage, "`emissionLights`", std::to_string(count), "1 or more");
    }
    const Glow glow(volume, optics);
    const glm::dmat3 voxel(volume.worldFromIndex());
    // Radiance per length, times volume, is power per direction; a light of strength 1 has pi.
    const double perGlow =
        std::abs(glm::determinant(voxel)) / unitDistanceOf(volume, optics) / std::numbers::pi;
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) square += glm::dot(voxel[axis], voxel[axis]) / 12;
    std::vector<Light> lights;
    for (const Group& group : cutIntoGroups(glow.blocks(), count))
        lights.push_back(lightOf(group, glow, perGlow, square));
    std::ranges::stable_sort(lights, [](const Light& a, const Light& b) {
        const auto brightness = [](const Light& light) {
            return light.strength * std::max({light.color.r, light.color.g, light.color.b});
        };
        return brightness(a) > brightness(b);
    });
    return lights;
}

}  // namespace deltasplat
