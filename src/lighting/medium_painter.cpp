// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lighting/medium_light.h"
#include "lighting/part_looks.h"
#include "lighting/part_sampler.h"
#include "optics/color_space.h"
#include "optics/voxel_painter.h"

namespace deltasplat {
namespace {

// Grids that colours are multiplied by.
class ColorReader {
  public:
    ColorReader(const ColorGrids& grids, const glm::dmat4& worldFromIndex)
        : grids_(grids), largest_(ColorFactor::largestOf(grids)) {
        for (const auto& grid : grids_) {
            samplers_.emplace_back(*grid, worldFromIndex, PartSampler::Around::kNothing);
            std::vector<double>& values = values_.emplace_back(kSlotCount, 1.0);
            const Volume& levels = samplers_.back().levels();
            for (std::size_t code = 0; code < levels.histogram.size(); ++code)
                if (levels.histogram[code] != 0)
                    values[code + 1] = levels.codeBook.valueOf(Code(code));
        }
    }

    const glm::dvec3& largest() const { return largest_; }

    // Paints what can be seen; where no colours are, they are white.
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
            const PartSampler& sampler = samplers_.emplace_back(*part.volume, volume.worldFromIndex,
                                                                PartSampler::Around::kBackground);
            looks_.push_back(lookUpPart(part, sampler.levels(), unitDistances));
        }
        if (optics.colorGrids) colors_.emplace(*optics.colorGrids, volume.worldFromIndex);
        findMore();
        // Light is swept through all there is, whichever parts of it shine.
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

    std::optional<Volume> room_;                 // what light is swept through
    std::unique_ptr<const VoxelPainter> inner_;  // null: voxels look as their classes do
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
