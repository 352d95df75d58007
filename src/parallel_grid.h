// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "deltasplat/threads.h"
#include "ingest/grids/file_metadata.h"
#include "parallel.h"

namespace deltasplat {

/// A grid that shares another's tree and, when written, packs its leaves on all threads: OpenVDB
/// packs one after the other, which takes most of the time of writing. The bytes are the same.
template <typename Grid>
class ParallelGrid : public Grid {
  public:
    using Leaf = typename Grid::TreeType::LeafNodeType;

    explicit ParallelGrid(const Grid& grid)
        : Grid(const_cast<Grid&>(grid), openvdb::ShallowCopy{}) {
        // A shallow copy has a transform of its own, and copying one rounds it.
        this->setTransform(const_cast<Grid&>(grid).transformPtr());
        // Writing sets these anew, and fails on one that a file gave another type.
        for (const char* const key : fileMetadata()) this->removeMeta(key);
    }

    /// The copy that OpenVDB writes in a grid's place.
    openvdb::GridBase::ConstPtr copyGrid() const override {
        return std::make_shared<ParallelGrid>(shallow());
    }
    openvdb::GridBase::Ptr copyGrid() override { return std::make_shared<ParallelGrid>(shallow()); }

    void writeBuffers(std::ostream& out) const override {
        // Nodes write their children depth first, which is the order of this list.
        std::vector<const Leaf*> leaves;
        this->tree().getNodes(leaves);
        const std::size_t pieces = (leaves.size() + kPiece - 1) / kPiece;
        const std::size_t batch = std::size_t(std::max(1, threadCount())) * kPiecesPerThread;
        std::vector<std::string> packed(std::min(batch, pieces));
        for (std::size_t first = 0; first < pieces; first += batch) {
            const std::size_t count = std::min(batch, pieces - first);
            parallelFor(count, [&](std::size_t i) {
                const std::size_t begin = (first + i) * kPiece;
                const std::size_t end = std::min(begin + kPiece, leaves.size());
                packed[i] = pack(leaves.data() + begin, end - begin, out);
            });
            for (std::size_t i = 0; i < count; ++i)
                out.write(packed[i].data(), std::streamsize(packed[i].size()));
        }
    }

  private:
    // As this, another grid would be made from the whole tree.
    const Grid& shallow() const { return *this; }

    static constexpr std::size_t kPiece = 256;  // leaves; 1 MiB of floats at most
    static constexpr std::size_t kPiecesPerThread = 4;

    /// Returns the bytes of leaves as they are in a stream written with the settings of `like`.
    std::string pack(const Leaf* const* leaves, std::size_t count, std::ostream& like) const {
        std::ostringstream out;
        const auto settings = openvdb::io::getStreamMetadataPtr(like);
        auto copy = openvdb::SharedPtr<openvdb::io::StreamMetadata>(
            new openvdb::io::StreamMetadata(*settings));
        openvdb::io::setStreamMetadataPtr(out, copy);
        for (std::size_t i = 0; i < count; ++i)
            leaves[i]->writeBuffers(out, this->saveFloatAsHalf());
        return std::move(out).str();
    }
};

}  // namespace deltasplat
