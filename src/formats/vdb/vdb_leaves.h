// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Maps.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/volume.h"
#include "files/file_bytes.h"
#include "formats/vdb/vdb_walk.h"
#include "volume/tree_types.h"

namespace deltasplat {

/// A range of a file's bytes in memory.
class VdbRun {
  public:
    /// Loads the bytes [begin, end), if possible into its old memory. Returns whether they exist.
    /// @throw Error(kInput) if the file cannot be read
    bool read(const FileBytes& file, std::uint64_t begin, std::uint64_t end);
    bool has(const VdbLeaf& leaf) const { return leaf.begin >= begin_ && leaf.end() <= end_; }
    /// @param leaf  has() it
    std::span<const char> of(const VdbLeaf& leaf) const {
        return {bytes_.get() + (leaf.begin - begin_), leaf.size};
    }
    std::uint64_t begin() const { return begin_; }

  private:
    std::uint64_t begin_ = 0;
    std::uint64_t end_ = 0;
    std::unique_ptr<char[]> bytes_;
    std::uint64_t capacity_ = 0;
};

/// The packed leaves of a grid in its file, without a tree. Each unpacking checks its leaf.
class VdbLeaves {
  public:
    static constexpr int kVoxels = 512;
    /// Leaves per read; each run starts at a multiple of this number.
    static constexpr std::size_t kRun = 128;
    using Mask = VdbLeaf::Mask;

    /// Scratch room of a thread, reused from leaf to leaf.
    template <typename Stored>
    struct Room {
        /// The leaf's values as stored, and Blosc's spare room.
        std::array<Stored, kVoxels + 64 / sizeof(Stored)> values;
        VdbRun run;
        /// Index behind the last leaf that the thread will ask for.
        std::size_t end = std::numeric_limits<std::size_t>::max();
    };

    /// @param leaves  in the order of the file
    VdbLeaves(std::shared_ptr<const FileBytes> file, std::vector<VdbLeaf> leaves,
              const VdbValueFormat& format, openvdb::math::MapBase::ConstPtr transform);

    const std::vector<VdbLeaf>& leaves() const { return leaves_; }
    const openvdb::math::MapBase& transform() const { return *transform_; }
    /// Unpacks the values of a leaf's active voxels, in the order of the mask's bits. Thread-safe.
    /// @tparam Stored  of the format's size: a number, or std::uint16_t for halves
    /// @param leaf     of leaves()
    /// @param mask     receives the active voxels
    /// @return a part of `room`; nothing if the leaf's bytes are damaged
    template <typename Stored>
    std::optional<std::span<const Stored>> activeValues(const VdbLeaf& leaf, Mask& mask,
                                                        Room<Stored>& room) const;

    /// Scratch room of a thread for allValues.
    struct BytesRoom {
        VdbRun run;
        std::vector<char> stored;
    };
    /// Unpacks the values of all voxels of a leaf, inactive ones included. Thread-safe.
    /// @tparam T      the grid's value type: a number or a vector
    /// @param mask    receives the active voxels
    /// @param behind  index behind the last leaf that the caller will ask for
    /// @return whether the leaf's bytes are intact
    template <typename T>
    bool allValues(const VdbLeaf& leaf, T background, std::size_t behind, Mask& mask,
                   BytesRoom& room, T* values) const;
    /// Does the same for grids of bools and masks.
    /// @param values  receives the true voxels: in a mask all active ones
    bool allBools(const VdbLeaf& leaf, std::size_t behind, Mask& mask, VdbRun& run,
                  Mask& values) const;

  private:
    std::optional<std::span<const char>> bytesOf(const VdbLeaf& leaf, VdbRun& room,
                                                 std::size_t behind) const;
    bool readRun(const VdbLeaf& leaf, VdbRun& run, std::size_t behind) const;

    std::shared_ptr<const FileBytes> file_;
    std::vector<VdbLeaf> leaves_;
    VdbValueFormat format_;
    openvdb::math::MapBase::ConstPtr transform_;
};

/// Returns the most bytes of the size notes of this many leaves: packing may add a little.
constexpr std::uint64_t mostLeafSizesBytes(std::size_t leaves) {
    return 64 + 9 * std::uint64_t{leaves};
}

/// Returns the number of bytes per leaf behind its mask, in file order; nothing if the notes are
/// unsound or of another number of leaves. Notes may be wrong.
/// @param stored  value of the grid's metadata "file_delayed_load" as the file has it
std::optional<std::vector<std::uint64_t>> leafSizesOf(const std::string& stored, std::size_t leaves,
                                                      const VdbValueFormat& format);

/// A grid of numbers whose leaf values stay in the file, for callers that visit each leaf once.
struct PackedGrid {
    template <typename T>
    using Tree = typename openvdb::tree::Tree4<T, 5, 4, 3>::Type;
    template <typename T>
    using Nodes = std::shared_ptr<const Tree<T>>;

    /// Nodes whose leaves have no values, made by readNodes().
    std::variant<Nodes<float>, Nodes<double>, Nodes<std::int32_t>, Nodes<std::int64_t>> nodes;
    VdbLeaves leaves;
};

/// Says that a packed grid must be read whole: damaged, not finite, or needed elsewhere.
struct NeedsWholeGrid : Error {
    explicit NeedsWholeGrid(const std::string& where)
        : Error(ErrorCode::kInput, where, "a grid that is read leaf by leaf",
                "one that is read as a whole") {}
};

/// Reads a grid of a .vdb for compareVolumes(): a volume without codes whose `source` keeps the
/// values packed. If those are not enough, compareVolumes() throws NeedsWholeGrid.
/// @param options  what to read; level sets stay level sets
/// @return nothing for grids that need readVolume(): vectors, bools, masks, deltas, NaN to replace
/// @throw as readVolume
std::optional<Volume> readPackedVolume(const std::filesystem::path& file,
                                       const ReadOptions& options, const Listener& listener);

}  // namespace deltasplat
