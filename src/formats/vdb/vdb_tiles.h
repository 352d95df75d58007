// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <optional>
#include <span>
#include <vector>

#include "files/file_bytes.h"
#include "formats/vdb/vdb_walk.h"
#include "volume/code_nodes.h"

namespace deltasplat {

/// The active tiles of a grid of numbers.
class VdbTiles {
  public:
    const std::vector<TilePlace>& places() const { return places_; }
    /// @tparam T  the grid's value type
    template <typename T>
    std::span<const T> values() const {
        assert(values_.size() == places_.size() * sizeof(T));
        return {reinterpret_cast<const T*>(values_.data()), places_.size()};
    }

    /// Reads and unpacks them, on all threads.
    /// @return nothing if they are damaged
    static std::optional<VdbTiles> read(const FileBytes& file, const VdbValueFormat& format,
                                        const std::vector<VdbNode>& nodes);

  private:
    std::vector<TilePlace> places_;
    std::vector<char> values_;  // halves as floats or doubles
};

}  // namespace deltasplat
