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

/// Some bytes of a file that are in memory.
class VdbRun {
  public:
    /// Becomes the bytes [begin, end); returns whether they are there. Uses its memory again, if
    /// that is large enough.
    /// @throw Error(kInput) if the file cannot be read
    bool read(const FileBytes& file, std::uint64_t begin, std::uint64_t end);
    bool has(const VdbLeaf& leaf) const { return leaf.begin >= begin_ && leaf.end() <= end_; }
    /// Returns the bytes of a leaf that it has.
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

/// The leaves of a grid as they lie in its file, packed: each is unpacked by whoever wants its
/// values, on any thread, and no tree is made of them. What the
/// file says of a leaf is checked whenever it is unpacked.
class VdbLeaves {
  public:
    static constexpr int kVoxels = 512;
    /// So many that follow each other are read at once, from each multiple of it on.
    static constexpr std::size_t kRun = 128;
    using Mask = VdbLeaf::Mask;

    /// What a thread keeps from leaf to leaf.
    template <typename Stored>
    struct Room {
        /// A leaf's values as they are stored, and what Blosc wants besides to unpack them.
        std::array<Stored, kVoxels + 64 / sizeof(Stored)> values;
        VdbRun run;
        /// One behind the last leaf that is going to be asked for.
        std::size_t end = std::numeric_limits<std::size_t>::max();
    };

    /// @param leaves  in the order of the file
    VdbLeaves(std::shared_ptr<const FileBytes> file, std::vector<VdbLeaf> leaves,
              const VdbValueFormat& format, openvdb::math::MapBase::ConstPtr transform);

    const std::vector<VdbLeaf>& leaves() const { return leaves_; }
    const openvdb::math::MapBase& transform() const { return *transform_; }
    /// Unpacks the values of a leaf's active voxels, in the order of the mask's bits. Thread-safe.
    /// @tparam Stored  of the format's size: a number, or the std::uint16_t that a half is
    /// @param leaf     of leaves()
    /// @param mask     becomes which voxels are active
    /// @return within `room`; nothing if the leaf's bytes are damaged
    template <typename Stored>
    std::optional<std::span<const Stored>> activeValues(const VdbLeaf& leaf, Mask& mask,
                                                        Room<Stored>& room) const;

    /// What a thread keeps from leaf to leaf, of allValues.
    struct BytesRoom {
        VdbRun run;
        std::vector<char> stored;
    };
    /// Unpacks the values of all voxels of a leaf, inactive ones too. Thread-safe.
    /// @tparam T      the grid's value type: a number or a vector
    /// @param mask    becomes which voxels are active
    /// @param behind  one behind the last leaf that is going to be asked for
    /// @return whether the leaf's bytes are whole
    template <typename T>
    bool allValues(const VdbLeaf& leaf, T background, std::size_t behind, Mask& mask,
                   BytesRoom& room, T* values) const;
    /// As allValues, of grids of bools and masks.
    /// @param values  becomes which voxels are true; all that are active in a mask
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

/// Returns the most bytes that a note of so many leaves may have: packing may add a little.
constexpr std::uint64_t mostLeafSizesBytes(std::size_t leaves) {
    return 64 + 9 * std::uint64_t{leaves};
}

/// Returns how many bytes each leaf of a grid has in its file behind its mask, in file order, if
/// that is noted for as many leaves as there are, and soundly. A note may be wrong.
/// @param stored  value of the grid's metadata "file_delayed_load" as the file has it
std::optional<std::vector<std::uint64_t>> leafSizesOf(const std::string& stored, std::size_t leaves,
                                                      const VdbValueFormat& format);

/// A grid of numbers whose leaves' values are still in their file, for who looks at each of them
/// once.
struct PackedGrid {
    template <typename T>
    using Tree = typename openvdb::tree::Tree4<T, 5, 4, 3>::Type;
    template <typename T>
    using Nodes = std::shared_ptr<const Tree<T>>;

    /// Without values in leaves, as readNodes() makes it.
    std::variant<Nodes<float>, Nodes<double>, Nodes<std::int32_t>, Nodes<std::int64_t>> nodes;
    VdbLeaves leaves;
};

/// Says that what is packed has to be read as a whole: it is damaged, or has values that are not
/// finite, or somebody wants it elsewhere.
struct NeedsWholeGrid : Error {
    /// @param where  for messages
    explicit NeedsWholeGrid(const std::string& where)
        : Error(ErrorCode::kInput, where, "a grid that is read leaf by leaf",
                "one that is read as a whole") {}
};

/// Reads a grid of a .vdb whose values stay packed: a volume without codes, whose `source` has
/// them, for compareVolumes(), which throws NeedsWholeGrid where that is not enough.
/// @param options  what to read; level sets stay what they are
/// @return nothing where readVolume() has to read it: vectors, bools and masks, delta grids, what
///         is not finite to be replaced
/// @throw as readVolume
std::optional<Volume> readPackedVolume(const std::filesystem::path& file,
                                       const ReadOptions& options, const Listener& listener);

}  // namespace deltasplat
