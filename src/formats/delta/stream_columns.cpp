// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/stream_columns.h"

#include <algorithm>
#include <utility>

#include "base/memory.h"
#include "formats/delta/part_walker.h"
#include "formats/delta/word_tree.h"

namespace deltasplat {

namespace {

class StreamWalker : public DeltaWalker {
  public:
    StreamWalker(const std::uint64_t* words, const std::vector<StreamPart>& parts,
                 const DeltaHeader& header)
        : parts_(parts), part_(words, header) {}

    bool start(const DeltaColumn& column) override {
        next_ = column.begin;
        end_ = column.end;
        return goOn();
    }
    int block() const override { return isDone_ ? kNoBlock : part_.block(); }
    const BlockDeltas* take() override {
        const BlockDeltas* const deltas = part_.take();
        if (deltas && part_.isDone() && !goOn()) return nullptr;
        return deltas;
    }

  private:
    // Goes to the next part; returns whether it is sound so far.
    bool goOn() {
        isDone_ = next_ == end_;
        return isDone_ || part_.start(parts_[next_++]);
    }

    const std::vector<StreamPart>& parts_;
    std::size_t next_ = 0;
    std::size_t end_ = 0;
    bool isDone_ = true;
    PartWalker<std::int32_t> part_;
};

}  // namespace

StreamColumns::StreamColumns(UnclearedVector<std::uint64_t> words, StreamIndex index,
                             const DeltaHeader& header)
    : header_(&header), words_(std::move(words)), parts_(std::move(index.parts)) {
    columns_ = orderByColumns(parts_, [](const StreamPart& part) { return part.first; });
    blocks_ = countBlocks(words_.data(), parts_);
    if (index.histogram.empty()) return;
    knownCodes_.emplace();
    knownCodes_->all = codesInUse(index, header);
    knownCodes_->parts.reserve(parts_.size());
    const int first = toSliceOrder(header.box.min, header.sliceAxis).x >> 3;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const StreamPart& part = parts_[i];
        const glm::ivec2 place(part.first.y, part.first.z);
        const int slab = (part.first.x - first) / (header.keyInterval / 8);
        knownCodes_->parts.push_back({{place, i, i + 1}, slab, part.lowest, part.highest});
    }
}

std::optional<StreamColumns> StreamColumns::read(const VdbLeaves& leaves, const DeltaHeader& header,
                                                 const std::string& where) {
    const std::optional<std::size_t> count = countWords(leaves);
    if (!count) return std::nullopt;
    auto words = wordsOfLeaves(leaves, *count, kStreamPadding, where);
    if (!words) return std::nullopt;
    StreamIndex index;
    if (*count > 0) index = readStreamIndex(words->data(), *count, header, where);
    requireMemory(where, double(index.parts.size()) * (sizeof(DeltaColumn) + sizeof(DeltaPart)));
    return StreamColumns(std::move(*words), std::move(index), header);
}

std::unique_ptr<DeltaWalker> StreamColumns::walker() const {
    return std::make_unique<StreamWalker>(words_.data(), parts_, *header_);
}

}  // namespace deltasplat
