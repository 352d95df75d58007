// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// An exact value: the sum of both parts. `low` is used only if 64-bit integers are compared; then
/// `high` is a multiple of 2^32 and |low| < 2^32, both with the value's sign.
struct WideValue {
    double high = 0;
    double low = 0;

    double rounded() const { return high + low; }
    /// Returns the shortest decimal number that identifies the double, or all digits if 64-bit
    /// integers are finer than doubles.
    std::string text() const {
        const double size = std::fabs(rounded());
        const bool isWhole = low == std::trunc(low) && high == std::trunc(high);
        if (!isWhole || size < 0x1p53 || std::fabs(high) >= 0x1p64) return numberText(rounded());
        const auto digits = std::uint64_t(std::fabs(high)) + std::uint64_t(std::fabs(low));
        return (rounded() < 0 ? "-" : "") + std::to_string(digits);
    }
    bool operator==(const WideValue&) const = default;
};

/// One voxel, or many equal ones.
struct Sample {
    WideValue value;
    bool active = false;
};

/// 8x8x8 voxels in the order of a leaf (x slowest, z fastest).
struct BlockSamples {
    static constexpr int kVoxels = 512;
    alignas(64) std::array<double, kVoxels> high;
    alignas(64) std::array<double, kVoxels> low;  ///< as WideValue::low
    std::array<std::uint64_t, 8> active;          ///< one bit per voxel

    void fill(const Sample& sample, bool wide);
};

/// Reads one volume's voxels, on one thread.
/// @throw NeedsWholeGrid if voxels cannot be unpacked or are not finite
class VoxelReader {
  public:
    virtual ~VoxelReader() = default;
    /// Level of the node that holds the voxel's value: -1 background, 0 a tile of 4096^3 voxels, 1
    /// of 128^3, 2 of 8^3, 3 a leaf.
    virtual int depthAt(const openvdb::Coord& at) = 0;
    virtual Sample sampleAt(const openvdb::Coord& at) = 0;
    /// Fills the block at `origin`; false if there is no leaf, and sampleAt gives all its voxels.
    virtual bool readLeaf(const openvdb::Coord& origin, BlockSamples& block) = 0;
};

/// A uniform view of any volume for the comparison.
class VoxelSource {
  public:
    /// @param wide        whether values are split as in WideValue
    /// @param background  value outside a dense volume
    /// @param offset      added to all indices; if not 0, voxels are copied
    /// @throw NeedsWholeGrid if voxels of a packed volume would have to be copied
    VoxelSource(const Volume& volume, bool wide, WideValue background,
                const openvdb::Coord& offset = openvdb::Coord(0));

    const WideValue& background() const { return background_; }
    /// First voxels of the 4096^3 regions outside which everything is background.
    const std::vector<openvdb::Coord>& regions() const { return regions_; }
    std::unique_ptr<VoxelReader> makeReader() const { return makeReader_(); }

  private:
    WideValue background_;
    std::vector<openvdb::Coord> regions_;
    std::function<std::unique_ptr<VoxelReader>()> makeReader_;
};

/// Whether the volume's own values are 64-bit integers.
bool holdsInt64(const Volume& volume);

/// Returns the value of inactive voxels outside all stored data; `wide` as in VoxelSource.
WideValue backgroundOf(const Volume& volume, bool wide);

}  // namespace deltasplat
