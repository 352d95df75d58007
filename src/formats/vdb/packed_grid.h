// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/volume.h"
#include "formats/vdb/vdb_leaves.h"
#include "volume/tree_types.h"

namespace deltasplat {

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
