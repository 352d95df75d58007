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

/// How the voxels of another grid lie among a volume's.
enum class PartFit {
    kSame,     ///< voxel by voxel, perhaps moved by whole ones
    kBetween,  ///< values are read between voxels, linearly along each axis
    kFiner     ///< values are means of the voxels that fall into one
};

/// Returns how the voxels of a part lie among those that another map places.
/// @param worldFromIndex  of the volume at whose voxels the part is read
PartFit fitOf(const Volume& part, const glm::dmat4& worldFromIndex);

/// Along x first, then y, then z.
struct PlaceLess {
    bool operator()(const glm::ivec3& a, const glm::ivec3& b) const {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    }
};

/// Blocks, (x, y, z) / 8 of their first voxels, in order.
using PlaceSet = std::set<glm::ivec3, PlaceLess>;

/// Reads another grid at the voxels of a volume. What is not active has the grid's background, or 0
/// if it has none.
class PartSampler {
  public:
    /// What a voxel reads that has none of the grid's active voxels near it.
    enum class Around { kBackground, kNothing };

    /// @param part            must outlive the sampler
    /// @param worldFromIndex  of the volume at whose voxels it is read
    /// @param around          kNothing: only active voxels take part in what is read between
    PartSampler(const Volume& part, const glm::dmat4& worldFromIndex, Around around);

    /// The grid as classification sees it: where values are read between voxels, each within 2e-4
    /// of itself, of magnitudes from the largest down to 2^-22 of it.
    const Volume& levels() const { return levels_; }
    /// Reads the voxels of a block, [slice][u][v]: slots of levels(), empty where nothing is.
    /// Thread-safe.
    void read(const BlockPlace& place, std::span<Slot, 512> slots) const;
    /// Adds the blocks of the volume in which voxels may have other slots than those of a map
    /// [kSlotCount] of levels() that are 0, and makes a box hold those voxels.
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
    std::optional<BookEncoder> encoder_;  // of levels that are not the grid's own
    std::vector<double> valueOfCode_;
};

/// Returns the unit distances of the way from one corner to the other of all that there is of a
/// medium.
inline double longestWay(const Volume& volume, const Optics& optics) {
    WorldBox world = worldBox(volume.box, volume.worldFromIndex);
    for (const MediumPart& part : optics.parts) {
        const WorldBox other = worldBox(part.volume->box, part.volume->worldFromIndex);
        world.min = glm::min(world.min, other.min);
        world.max = glm::max(world.max, other.max);
    }
    return glm::length(world.max - world.min) / unitDistanceOf(volume, optics);
}

/// Returns a volume with room for what is seen besides. What is seen where nothing else is makes it
/// one that is not empty.
Volume withRoom(const Volume& volume, const BlockSet& more);

/// Black bodies that are hotter are taken for this hot.
inline constexpr double kHottestKelvin = 1e5;

/// What a part of a medium adds to a ray on a unit distance.
struct PartLook {
    double extinction = 0;  ///< may be infinite
    glm::dvec3 color{0.0};  ///< of what swallows light, not multiplied by opacity
    glm::dvec3 glow{0.0};   ///< radiance

    bool operator==(const PartLook&) const = default;
};

/// The different looks that a part's values have.
struct PartLooks {
    std::vector<PartLook> looks;        ///< the first is that of nothing
    std::vector<std::uint16_t> ofSlot;  ///< [kSlotCount]: which look a slot has

    /// Returns the largest that any has of each member.
    PartLook largest() const;
};

/// Looks up what the values of a part look like.
/// @param levels         the part as it is read (PartSampler)
/// @param unitDistances  that the longest way through the volume has: what glows too little to be
///                       seen on it is nothing
PartLooks lookUpPart(const MediumPart& part, const Volume& levels, double unitDistances);

}  // namespace deltasplat
