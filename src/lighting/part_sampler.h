// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "base/affine.h"
#include "deltasplat/ingest/slot.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/medium.h"
#include "optics/color_digits.h"
#include "optics/voxel_painter.h"
#include "volume/book_encoder.h"

namespace deltasplat {

/// How the voxels of another grid lie relative to a volume's.
enum class PartFit {
    kSame,     ///< same voxels, perhaps moved by whole voxels
    kBetween,  ///< values are interpolated linearly along each axis
    kFiner     ///< values are means of the voxels within a voxel of the volume
};

/// @param worldFromIndex  of the volume whose voxels read the part
PartFit fitOf(const Volume& part, const glm::dmat4& worldFromIndex);

/// Orders by x, then y, then z.
struct PlaceLess {
    bool operator()(const glm::ivec3& a, const glm::ivec3& b) const {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    }
};

/// Blocks, by (x, y, z) / 8 of their first voxels.
using PlaceSet = std::set<glm::ivec3, PlaceLess>;

/// Reads another grid at a volume's voxels. Inactive voxels have the grid's background, or 0.
class PartSampler {
  public:
    /// The value of a voxel without active voxels of the grid near it.
    enum class Around { kBackground, kNothing };

    /// @param part            must outlive the sampler
    /// @param worldFromIndex  of the volume whose voxels read the part
    /// @param around          kNothing: interpolation ignores inactive voxels
    PartSampler(const Volume& part, const glm::dmat4& worldFromIndex, Around around);

    /// The grid for classification. Interpolated values are rounded by at most 2e-4 of themselves,
    /// from the largest magnitude down to 2^-22 of it.
    const Volume& levels() const { return levels_; }
    /// Reads a block, [slice][u][v]: slots of levels(), or empty. Thread-safe.
    void read(const BlockPlace& place, std::span<Slot, 512> slots) const;
    /// Adds the volume's blocks that may contain slots of levels() with nonzero entries in slotMap,
    /// [kSlotCount], and enlarges the box by the voxels.
    void addBlocksSeen(std::span<const Slot> slotMap, PlaceSet& places, IndexBox& box) const;

  private:
    class Reader;

    void makeLevels();
    std::vector<Slot> seenCodes(std::span<const Slot> slotMap) const;
    double valueOf(const Reader& reader, const glm::dvec3& at) const;
    double meanOf(const Reader& reader, const glm::dvec3& at) const;
    IndexBox reachOf(const IndexBox& box) const;

    const Volume& part_;
    std::shared_ptr<const CodeTree> codes_;
    Around around_;
    glm::dmat4 partFromIndex_;
    PartFit fit_;
    glm::ivec3 samples_;  // along each of the volume's axes
    double background_;
    Volume levels_;
    std::optional<BookEncoder> encoder_;  // if levels are not the grid's own
    std::vector<double> valueOfCode_;
};

/// Returns the diagonal of the whole medium in unit distances.
inline double longestWay(const Volume& volume, const Optics& optics) {
    WorldBox world = worldBox(volume.box(), volume.worldFromIndex());
    for (const MediumPart& part : optics.parts) {
        const WorldBox other = worldBox(part.volume->box(), part.volume->worldFromIndex());
        world.min = glm::min(world.min, other.min);
        world.max = glm::max(world.max, other.max);
    }
    return glm::length(world.max - world.min) / unitDistanceOf(volume, optics);
}

/// Returns a volume whose box also holds `more`; with `more` the volume is never empty.
Volume withRoom(const Volume& volume, const BlockSet& more);

/// Hotter black bodies are clamped to this temperature.
inline constexpr double kHottestKelvin = 1e5;

/// Effect of a part of a medium on a ray per unit distance.
struct PartLook {
    double extinction = 0;  ///< may be infinite
    glm::dvec3 color{0.0};  ///< of the absorbing matter, not multiplied by opacity
    glm::dvec3 glow{0.0};   ///< radiance

    bool operator==(const PartLook&) const = default;
};

/// The different looks of a part's values.
struct PartLooks {
    std::vector<PartLook> looks;        ///< entry 0: nothing
    std::vector<std::uint16_t> ofSlot;  ///< [kSlotCount]: the look of each slot

    /// Returns the largest value of each member.
    PartLook largest() const;
};

/// @param levels         the part as PartSampler reads it
/// @param unitDistances  longest way through the medium; a glow invisible over it counts as 0
PartLooks lookUpPart(const MediumPart& part, const Volume& levels, double unitDistances);

}  // namespace deltasplat
