// SPDX-License-Identifier: Apache-2.0
// Based on: N. Max, Optical Models for Direct Volume Rendering, 1995 (absorption plus emission: an
// even glow along a way of depth t leaves it with (1 - exp(-t)) / t of its light).
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "lighting/part_sampler.h"
#include "optics/color_space.h"
#include "optics/voxel_painter.h"

namespace deltasplat {
namespace {

/// Light of a medium of several parts. Extinctions add up and dim all glow. A voxel's look has in
/// bits[i] the number of part i's look or, if i >= 1, a colour factor.
class MediumLight : public LookLight {
  public:
    /// @param inner   light of the volume alone
    /// @param parts   must outlive the light
    /// @param factor  largest colour factor; null: there are none
    MediumLight(std::unique_ptr<const LookLight> inner, const std::vector<PartLooks>& parts,
                const glm::dvec3* factor, const ClassTable& classes);

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override;

  private:
    // A look of a part, per step; colours in units.
    struct StepLook {
        float depth;      // extinction
        glm::vec3 color;  // of the absorbing matter, not multiplied by opacity
        glm::vec3 glow;
    };
    struct StepClass {
        float depth;
        float dimmed;  // share of an even glow that leaves the step
    };

    // Evaluates unitsFor() before it moves `inner`.
    MediumLight(const VoxelUnits& units, std::unique_ptr<const LookLight>&& inner,
                const std::vector<PartLooks>& parts, const glm::dvec3* factor,
                const ClassTable& classes);
    void findLooks(const std::vector<PartLooks>& parts, const ClassTable& classes);
    void addGlow(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const;
    void addParts(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const;

    std::unique_ptr<const LookLight> inner_;
    glm::vec4 fromInner_;  // units of the inner light in units of this light
    bool hasFactors_;
    bool absorbs_ = false;  // whether any part absorbs
    glm::vec3 factor_{1};
    std::vector<std::vector<StepLook>> looks_;  // [parts][looks]
    std::vector<StepClass> classes_;
};

namespace {

// Deeper extinction looks the same.
constexpr double kMostDepth = 1e30;
// With brighter steps one plane is too coarse for the other parts: 2^-25.
constexpr double kMostOnPlane = 64;

double dimmedBy(double depth) {
    if (depth < 1e-9) return 1;
    return -portable::expm1(-depth) / depth;
}

double stepsOf(const ClassTable& classes) {
    return classes.stepWorld / classes.unitDistanceWorld;
}

double depthOf(const PartLook& look, double unitDistances) {
    return look.extinction > 0 ? std::min(look.extinction * unitDistances, kMostDepth) : 0;
}

// The largest channels that the parts add in a step to the inner light.
glm::dvec4 mostOf(const std::vector<PartLooks>& parts, double unitDistances) {
    glm::dvec4 most(0);
    for (const PartLooks& part : parts) {
        const PartLook largest = part.largest();
        const double alpha = -portable::expm1(-depthOf(largest, unitDistances));
        most += glm::dvec4(alpha * largest.color + unitDistances * largest.glow, 0);
    }
    return most;
}

// The smallest ratio, of any channel, of an inner unit to a unit.
double smallestShare(const VoxelUnits& inner, const VoxelUnits& units) {
    double share = 1;
    for (int c = 0; c < 4; ++c)
        if (inner.scale()[c] > 0) share = std::min(share, inner.scale()[c] / units.scale()[c]);
    return share;
}

// Units that hold all that a voxel may show.
VoxelUnits unitsFor(const LookLight& inner, const std::vector<PartLooks>& parts,
                    const glm::dvec3* factor, const ClassTable& classes) {
    VoxelUnits units = inner.units();
    const double unitDistances = stepsOf(classes);
    double depth = 0;
    for (const double one : depthsOf(classes, classes.stepWorld)) depth = std::max(depth, one);
    for (const PartLooks& part : parts) depth += depthOf(part.largest(), unitDistances);
    glm::dvec4 most = units.scale() * double(ClassTable::kMax);
    if (factor) most *= glm::dvec4(*factor, 1);
    most += mostOf(parts, unitDistances);
    most.a = std::max(most.a, -portable::expm1(-depth));
    units.raise(most);
    return units;
}

}  // namespace

MediumLight::MediumLight(std::unique_ptr<const LookLight> inner,
                         const std::vector<PartLooks>& parts, const glm::dvec3* factor,
                         const ClassTable& classes)
    : MediumLight(unitsFor(*inner, parts, factor, classes), std::move(inner), parts, factor,
                  classes) {}

MediumLight::MediumLight(const VoxelUnits& common, std::unique_ptr<const LookLight>&& inner,
                         const std::vector<PartLooks>& parts, const glm::dvec3* factor,
                         const ClassTable& classes)
    : LookLight(common, inner->dimmest() * smallestShare(inner->units(), common)),
      inner_(std::move(inner)),
      hasFactors_(factor != nullptr) {
    const glm::dvec4 scale = units().scale();
    for (int c = 0; c < 4; ++c)
        fromInner_[c] = scale[c] > 0 ? float(inner_->units().scale()[c] / scale[c]) : 0;
    if (factor) factor_ = glm::vec3(*factor);
    if (inner_->isFine()) setFine();
    findLooks(parts, classes);
}

void MediumLight::findLooks(const std::vector<PartLooks>& parts, const ClassTable& classes) {
    const glm::dvec4& scale = units().scale();
    const double unitDistances = stepsOf(classes);
    glm::dvec3 toUnits(0);
    for (int c = 0; c < 3; ++c) toUnits[c] = scale[c] > 0 ? 1 / scale[c] : 0;
    for (const PartLooks& part : parts) {
        std::vector<StepLook>& looks = looks_.emplace_back();
        for (const PartLook& look : part.looks) {
            const double depth = depthOf(look, unitDistances);
            looks.push_back({float(depth), glm::vec3(look.color * toUnits),
                             glm::vec3(look.glow * unitDistances * toUnits)});
            absorbs_ = absorbs_ || depth > 0;
        }
        const glm::dvec3 glow = unitDistances * part.largest().glow;
        if (std::max({glow.x, glow.y, glow.z}) > kMostOnPlane) setFine();
    }
    for (const double one : depthsOf(classes, classes.stepWorld)) {
        const double depth = std::min(one, kMostDepth);
        classes_.push_back({float(depth), float(dimmedBy(depth))});
    }
}

void MediumLight::lightVoxels(const WordPlace& place, const std::uint16_t* classes,
                              const OwnLook* looks, WordUnits& colors) const {
    inner_->light(place, classes, looks, colors);
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t n = 0; n < 64; ++n) colors[c][n] *= fromInner_[int(c)];
    if (hasFactors_) {
        const WordFactors factors = factorsOf(looks);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t n = 0; n < 64; ++n) colors[c][n] *= factor_[int(c)] * factors[c][n];
    }
    if (absorbs_) {
        addParts(classes, looks, colors);
    } else {
        addGlow(classes, looks, colors);
    }
}

// If parts only shine, the classes determine how much they are dimmed.
void MediumLight::addGlow(const std::uint16_t* classes, const OwnLook* looks,
                          WordUnits& colors) const {
    for (std::size_t part = 0; part < looks_.size(); ++part) {
        for (std::size_t n = 0; n < 64; ++n) {
            const std::uint16_t look = looks[n].bits[part];
            if (look == 0) continue;
            const glm::vec3 glow = classes_[classes[n]].dimmed * looks_[part][look].glow;
            for (int c = 0; c < 3; ++c) colors[std::size_t(c)][n] += glow[c];
        }
    }
}

// Every part has a share of the common opacity in proportion to its depth.
void MediumLight::addParts(const std::uint16_t* classes, const OwnLook* looks,
                           WordUnits& colors) const {
    const double opaque = units().unitsOfOpaque();
    for (std::size_t n = 0; n < 64; ++n) {
        const double own = classes_[classes[n]].depth;
        double depth = own;
        glm::dvec3 shines(0);
        bool isAny = false;
        for (std::size_t part = 0; part < looks_.size(); ++part) {
            const std::uint16_t number = looks[n].bits[part];
            if (number == 0) continue;
            isAny = true;
            const StepLook& look = looks_[part][number];
            depth += look.depth;
            shines += double(look.depth) * glm::dvec3(look.color) + glm::dvec3(look.glow);
        }
        if (!isAny) continue;
        const double dimmed = dimmedBy(depth);
        // The volume's own light was dimmed by its own depth already.
        const double left = dimmed / classes_[classes[n]].dimmed;
        for (int c = 0; c < 3; ++c) {
            float& channel = colors[std::size_t(c)][n];
            channel = float(channel * left + dimmed * shines[c]);
        }
        colors[3][n] = float(dimmed * depth * opaque);
    }
}

}  // namespace

namespace {

// Grids of colour factors.
class ColorReader {
  public:
    ColorReader(const ColorGrids& grids, const glm::dmat4& worldFromIndex)
        : grids_(grids), largest_(ColorFactor::largestOf(grids)) {
        for (const auto& grid : grids_) {
            samplers_.emplace_back(*grid, worldFromIndex, PartSampler::Around::kNothing);
            std::vector<double>& values = values_.emplace_back(kSlotCount, 1.0);
            const Volume& levels = samplers_.back().levels();
            for (std::size_t code = 0; code < levels.histogram().size(); ++code)
                if (levels.histogram()[code] != 0)
                    values[code + 1] = levels.codeBook().valueOf(Code(code));
        }
    }

    const glm::dvec3& largest() const { return largest_; }

    // Paints visible voxels; without a colour they are white.
    void paint(const BlockPlace& place, std::span<const std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const {
        std::array<std::array<Slot, 512>, 3> slots;
        for (std::size_t c = 0; c < 3; ++c) samplers_[c].read(place, slots[c]);
        for (std::size_t n = 0; n < looks.size(); ++n) {
            if (classes[n] == 0) continue;
            glm::dvec3 color;
            for (std::size_t c = 0; c < 3; ++c)
                color[int(c)] = values_[c][std::size_t(slots[c][n])];
            const std::uint32_t bits = ColorFactor::packed(color / largest_);
            looks[n].bits[1] = std::uint16_t(bits);
            looks[n].bits[2] = std::uint16_t(bits >> 16);
        }
    }

  private:
    ColorGrids grids_;
    glm::dvec3 largest_;
    std::vector<PartSampler> samplers_;
    std::vector<std::vector<double>> values_;  // [channels][kSlotCount]
};

// Reads the other parts of a medium at a volume's voxels.
class MediumPainter : public VoxelPainter {
  public:
    MediumPainter(const Volume& volume, const Optics& optics) : parts_(optics.parts) {
        const double unitDistances = longestWay(volume, optics);
        for (const MediumPart& part : parts_) {
            const PartSampler& sampler = samplers_.emplace_back(
                *part.volume, volume.worldFromIndex(), PartSampler::Around::kBackground);
            looks_.push_back(lookUpPart(part, sampler.levels(), unitDistances));
        }
        if (optics.colorGrids) colors_.emplace(*optics.colorGrids, volume.worldFromIndex());
        findMore();
        // The sweep needs the whole box, whichever parts shine.
        if (optics.scattering && !volume.empty())
            inner_ = makeScatterPainter(room_.emplace(withRoom(volume, more_)), optics);
    }

    bool needsColors() const override { return true; }
    bool dependsOnCamera() const override { return inner_ && inner_->dependsOnCamera(); }
    bool mayHold() const override { return false; }
    bool isEverywhereOther() const override { return inner_ && inner_->isEverywhereOther(); }
    bool dividesVoxels() const override { return false; }
    const BlockSet* more() const override { return &more_; }

    void paint(const BlockPlace& place, const BlockField* field,
               std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        if (inner_) {
            inner_->paint(place, field, classes, looks);
        } else {
            std::fill(looks.begin(), looks.end(), OwnLook{});
        }
        if (colors_) colors_->paint(place, classes, looks);
        std::array<Slot, 512> slots;
        for (std::size_t part = 0; part < parts_.size(); ++part) {
            samplers_[part].read(place, slots);
            for (std::size_t n = 0; n < looks.size(); ++n) {
                const std::uint16_t look = looks_[part].ofSlot[std::size_t(slots[n])];
                looks[n].bits[part] = look;
                if (look != 0 && classes[n] == 0) classes[n] = ClassTable::kClearClass;
            }
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        std::unique_ptr<const LookLight> inner;
        if (inner_) {
            inner = inner_->lightOf(classes, scene);
        } else {
            inner = std::make_unique<ClassLight>(classes);
        }
        return std::make_unique<MediumLight>(std::move(inner), looks_,
                                             colors_ ? &colors_->largest() : nullptr, classes);
    }

  private:
    void findMore() {
        PlaceSet places;
        for (std::size_t part = 0; part < parts_.size(); ++part) {
            const std::vector<Slot> map(looks_[part].ofSlot.begin(), looks_[part].ofSlot.end());
            samplers_[part].addBlocksSeen(map, places, more_.box);
        }
        more_.positions.assign(places.begin(), places.end());
    }

    std::optional<Volume> room_;                 // the volume that light is swept through
    std::unique_ptr<const VoxelPainter> inner_;  // null: voxels look like their classes
    std::vector<MediumPart> parts_;
    std::vector<PartSampler> samplers_;  // [parts]
    std::vector<PartLooks> looks_;       // [parts]
    std::optional<ColorReader> colors_;
    BlockSet more_;
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeMediumPainter(const Volume& volume, const Optics& optics) {
    return std::make_unique<MediumPainter>(volume, optics);
}

}  // namespace deltasplat
