// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/leaf_columns.h"

#include <cstdint>

#include "ingest/delta/column_order.h"

namespace deltasplat {
namespace {

class LeafWalker : public DeltaWalker {
  public:
    LeafWalker(const VdbLeaves& leaves, const std::vector<LeafColumns::Placed>& order)
        : leaves_(leaves), order_(order) {}

    bool start(const DeltaColumn& column) override {
        next_ = column.begin;
        end_ = column.end;
        return true;
    }
    int block() const override { return next_ == end_ ? kNoBlock : order_[next_].block.x; }
    const BlockDeltas* take() override {
        const auto numbers = leaves_.activeValues(*order_[next_++].leaf, deltas_.changed, room_);
        if (!numbers) return nullptr;
        deltas_.given = deltas_.changed;
        deltas_.numbers = numbers->data();
        return &deltas_;
    }

  private:
    const VdbLeaves& leaves_;
    const std::vector<LeafColumns::Placed>& order_;
    std::size_t next_ = 0;
    std::size_t end_ = 0;
    VdbLeaves::Room<std::int32_t> room_;
    BlockDeltas deltas_;
};

}  // namespace

LeafColumns::LeafColumns(const VdbLeaves& leaves) : leaves_(leaves) {
    order_.reserve(leaves.leaves().size());
    for (const VdbLeaf& leaf : leaves.leaves()) {
        const auto& first = leaf.origin;
        order_.push_back({glm::ivec3(first[0], first[1], first[2]) >> 3, &leaf});
    }
    columns_ = orderByColumns(order_, [](const Placed& placed) { return placed.block; });
}

std::unique_ptr<DeltaWalker> LeafColumns::walker() const {
    return std::make_unique<LeafWalker>(leaves_, order_);
}

}  // namespace deltasplat
