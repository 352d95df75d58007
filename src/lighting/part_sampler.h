// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/ingest/volume.h"
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

}  // namespace deltasplat
