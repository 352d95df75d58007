// SPDX-License-Identifier: Apache-2.0
#include "vdb/leaf_pieces.h"

#include <algorithm>
#include <utility>

#include "deltasplat/threads.h"
#include "parallel.h"
#include "vdb/leaf_notes.h"

namespace deltasplat {
namespace {

constexpr std::size_t kPiece = 256;  // leaves; 1 MiB of floats at most
constexpr std::size_t kPiecesPerThread = 4;

}  // namespace

LeafPieces::LeafPieces(const WrittenTree& tree, bool half) : tree_(tree), half_(half) {}

std::size_t LeafPieces::count() const {
    return (tree_.leafCount() + kPiece - 1) / kPiece;
}

PackedLeaves LeafPieces::packPiece(std::size_t piece) const {
    PackedLeaves packed;
    const std::size_t begin = piece * kPiece;
    tree_.packLeaves(begin, std::min(begin + kPiece, tree_.leafCount()), half_, packed);
    return packed;
}

// Packs pieces from `begin` on, and calls use() for each of them, in order.
void LeafPieces::forBatches(std::size_t begin, const std::function<void(PackedLeaves)>& use) const {
    const std::size_t most = std::size_t(std::max(1, threadCount())) * kPiecesPerThread;
    for (; begin < count(); begin += most) {
        std::vector<PackedLeaves> batch(std::min(most, count() - begin));
        parallelFor(batch.size(), [&](std::size_t i) { batch[i] = packPiece(begin + i); });
        for (PackedLeaves& piece : batch) use(std::move(piece));
    }
}

void LeafPieces::pack(std::uint64_t& room, const std::function<void(double)>& step) {
    std::size_t done = 0;
    forBatches(0, [&](PackedLeaves piece) {
        bytes_ += piece.bytes.size();
        kinds_.insert(kinds_.end(), piece.kinds.begin(), piece.kinds.end());
        sizes_.insert(sizes_.end(), piece.sizes.begin(), piece.sizes.end());
        if (kept_.size() == done && piece.bytes.size() <= room) {
            room -= piece.bytes.size();
            piece.bytes.shrink_to_fit();
            kept_.push_back(std::move(piece.bytes));
        }
        step(double(++done) / double(count()));
    });
}

std::string LeafPieces::notes(bool mayPack) const {
    return leafNotes(kinds_, sizes_, mayPack);
}

void LeafPieces::take(const std::function<void(const std::string&)>& use) {
    for (std::string& piece : kept_) use(std::exchange(piece, {}));
    forBatches(kept_.size(), [&](const PackedLeaves& piece) { use(piece.bytes); });
}

}  // namespace deltasplat
