// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10 writes it (io/DelayedLoadMetadata.h,
// points/StreamCompression.h).
#include "formats/vdb/leaf_pieces.h"

#include <blosc.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "base/parallel.h"
#include "deltasplat/threads.h"
#include "formats/vdb/pack_values.h"

namespace deltasplat {

namespace {

// Smaller arrays are not packed, or with zeros behind them.
constexpr std::size_t kLeastBytes = 48;
constexpr std::size_t kLeastPacked = 128;

// Appends an array: how many bytes it is packed in, 0 if it is not, and those.
template <typename T>
void appendArray(const std::vector<T>& values, bool mayPack, std::string& to) {
    const std::size_t bytes = values.size() * sizeof(T);
    const std::size_t place = to.size();
    appendBytes(std::uint32_t{0}, to);
    if (mayPack && bytes > kLeastBytes && bytes <= BLOSC_MAX_BUFFERSIZE - BLOSC_MAX_OVERHEAD) {
        std::string padded(reinterpret_cast<const char*>(values.data()), bytes);
        if (bytes < kLeastPacked) padded.resize(kLeastPacked);
        const auto size = std::uint32_t(appendBlosc(padded.data(), padded.size(), to));
        if (size > 0 && size < bytes) {
            std::memcpy(&to[place], &size, sizeof size);
            return;
        }
        to.resize(place + sizeof size);
    }
    to.append(reinterpret_cast<const char*>(values.data()), bytes);
}

}  // namespace

std::string leafNotes(const std::vector<std::int8_t>& kinds, const std::vector<std::int64_t>& sizes,
                      bool mayPack) {
    std::string notes;
    if (kinds.empty()) return notes;
    appendBytes(std::uint32_t(kinds.size()), notes);
    appendArray(kinds, mayPack, notes);
    appendArray(sizes, mayPack, notes);
    return notes;
}

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
