// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/delta_stream.h"

#include <algorithm>
#include <bit>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "ingest/delta/bit_reader.h"
#include "ingest/delta/delta_format.h"
#include "ingest/delta/rice_code.h"
#include "ingest/delta/word_grid.h"
#include "ingest/grids/leaf_bytes.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

// More words than any block takes, of 512 numbers of 8 + 64 bits: so what is read behind the end of
// damaged words is there.
constexpr std::size_t kPadding = 1024;

// Takes the blocks of a column, one after the other.
template <typename Leaf>
class BlockTaker {
  public:
    using Delta = typename Leaf::ValueType;

    BlockTaker(BitReader in, RiceCode code) : in_(in), code_(code) {}

    BitReader& bits() { return in_; }

    // Returns whether it is a block with deltas: otherwise it is damaged.
    bool take(Leaf& leaf) {
        Delta* deltas = leaf.buffer().data();
        typename Leaf::NodeMaskType mask;
        for (openvdb::Index s = 0; s < 8; ++s, deltas += 64) {
            if (in_.take(1) == 0) continue;
            const auto form = SliceForm(in_.take(2));
            const auto parameter = int(in_.take(code_.parameterBits()));
            std::uint64_t& changed = mask.template getWord<std::uint64_t>(s);
            if (form == SliceForm::kAll) {
                changed = takeAll(parameter, deltas);
            } else {
                if (form != SliceForm::kMask && form != SliceForm::kRows) return false;
                changed = form == SliceForm::kMask ? in_.take(64) : takeRows();
                takeChanged(changed, parameter, deltas);
            }
        }
        leaf.setValueMask(mask);
        return !mask.isOff();
    }

  private:
    std::uint64_t takeAll(int parameter, Delta* deltas) {
        std::uint64_t changed = 0;
        for (int n = 0; n < 64; ++n) {
            deltas[n] = Delta(code_.take(in_, parameter));
            changed |= std::uint64_t{deltas[n] != 0} << n;
        }
        return changed;
    }

    void takeChanged(std::uint64_t changed, int parameter, Delta* deltas) {
        for (; changed != 0; changed &= changed - 1)
            deltas[std::countr_zero(changed)] = Delta(code_.take(in_, parameter) + 1);
    }

    std::uint64_t takeRows() {
        std::uint64_t changed = 0;
        for (std::uint64_t rows = in_.take(8); rows != 0; rows &= rows - 1)
            changed |= in_.take(8) << (8 * std::countr_zero(rows));
        return changed;
    }

    BitReader in_;
    RiceCode code_;
};

std::string placeText(const glm::ivec3& v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           ")";
}

// The blocks of one slab with the same u and v.
struct Column {
    glm::ivec3 first;   // the first of the slab, in (slice, u, v) order, divided by 8
    std::size_t begin;  // where its words begin
    std::size_t end;
};

class Unpacker {
  public:
    Unpacker(const openvdb::Int64Grid& grid, const DeltaHeader& header, const std::string& where)
        : header_(header),
          where_(where),
          count_(std::size_t(grid.activeVoxelCount())),
          words_(wordsOfGrid(grid, kPadding, where)),
          first_(toSliceOrder(header.box.min, header.sliceAxis) >> 3),
          last_(toSliceOrder(header.box.max, header.sliceAxis) >> 3) {}

    template <typename Grid>
    openvdb::GridBase::Ptr takeDeltas(const Listener& listener) const;

  private:
    template <typename Leaf>
    using Leaves = std::vector<std::unique_ptr<Leaf>>;

    [[noreturn]] void fail(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, gotExpected(where_, got, expected));
    }

    void requireBits(const BitReader& in) const;
    std::vector<Column> takeColumns() const;
    std::vector<Column> takePlaces(BitReader& in) const;
    template <typename Leaf>
    Leaves<Leaf> takeColumn(const Column& column) const;

    const DeltaHeader& header_;
    const std::string& where_;
    std::size_t count_;  // of words that are the file's
    std::vector<std::uint64_t> words_;
    glm::ivec3 first_, last_;  // blocks of the box
};

// What has been read has to lie before the end.
void Unpacker::requireBits(const BitReader& in) const {
    if (in.position() <= 64 * count_) return;
    fail("a stream of " + std::to_string(count_) + " words that ends early", "the rest of it");
}

// Returns the columns, with how many words they have as `begin`.
std::vector<Column> Unpacker::takePlaces(BitReader& in) const {
    const int blocksPerSlab = header_.keyInterval / 8;
    // Of each of slab, u and v what is more than in the column before, as far as those before it
    // are the same.
    glm::i64vec3 place(0, 0, -1);
    glm::i64vec3 most = glm::i64vec3(last_) - glm::i64vec3(first_);
    most.x /= blocksPerSlab;
    // Each has a word, and bits in the stream, which both may be few in a file.
    const auto failTooMany = [&](std::uint64_t words) {
        fail("columns of " + std::to_string(words) + " words or more",
             "at most " + std::to_string(count_) + ", those of the whole stream");
    };
    const std::uint64_t number = in.takeNumber();
    requireBits(in);
    if (number > count_) failTooMany(number);
    requireClaimedMemory(where_, double(number) * sizeof(Column));
    std::vector<Column> columns;
    columns.reserve(std::size_t(number));
    constexpr std::uint64_t kMostNumber = std::uint64_t{1} << 62;
    std::uint64_t words = 0;
    for (std::uint64_t left = number; left > 0; --left) {
        requireBits(in);
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint64_t more = in.takeNumber();
            const std::int64_t room = most[axis] - place[axis] - (axis == 2);
            if (header_.box.empty() || room < 0 || more > std::uint64_t(room))
                fail("deltas outside of the box", "columns within it, in order");
            place[axis] += std::int64_t(more) + (axis == 2);
            if (more > 0 && axis < 2) place[2] = -1;
            if (more > 0 && axis == 0) place[1] = 0;
        }
        const std::uint64_t size = in.takeNumber();
        if (size >= count_ - words) failTooMany(words + std::min(size, kMostNumber) + 1);
        words += size + 1;
        const glm::i64vec3 blocks(place.x * blocksPerSlab, place.y, place.z);
        columns.push_back({first_ + glm::ivec3(blocks), std::size_t(size) + 1, 0});
    }
    requireBits(in);
    return columns;
}

std::vector<Column> Unpacker::takeColumns() const {
    if (count_ == 0) return {};
    BitReader in(words_.data(), 0);
    std::vector<Column> columns = takePlaces(in);
    in.skipToWord();
    std::size_t end = in.position() / 64;
    for (Column& column : columns) {
        const std::size_t size = column.begin;
        column.begin = end;
        end += size;
        column.end = end;
        if (end > count_) break;
    }
    if (end != count_)
        fail("a stream of " + std::to_string(count_) + " words", "as many as its columns have");
    return columns;
}

template <typename Leaf>
Unpacker::Leaves<Leaf> Unpacker::takeColumn(const Column& column) const {
    BlockTaker<Leaf> taker(BitReader(words_.data(), 64 * column.begin),
                           RiceCode{deltaWidth(header_)});
    const int behind = std::min(last_.x + 1, column.first.x + header_.keyInterval / 8);
    const auto damaged = [&](int block) {
        const glm::ivec3 place = 8 * glm::ivec3(block, column.first.y, column.first.z);
        fail("a damaged stream at " + placeText(place), "blocks one behind the other");
    };
    Leaves<Leaf> leaves;
    int block = column.first.x;
    for (std::uint64_t left = taker.bits().takeNumber();; --left) {
        const std::uint64_t gap = taker.bits().takeNumber();
        if (gap >= std::uint64_t(behind - block)) damaged(block);
        block += int(gap);
        requireMemory(where_, leafBytes<Leaf>());
        auto leaf = std::make_unique<Leaf>(
            openvdb::Coord(8 * block, 8 * column.first.y, 8 * column.first.z), 0, false);
        if (!taker.take(*leaf) || taker.bits().position() > 64 * column.end) damaged(block);
        leaves.push_back(std::move(leaf));
        ++block;
        if (left == 0) break;
    }
    // Less than a word is left.
    if (taker.bits().position() + 63 < 64 * column.end) damaged(block);
    return leaves;
}

template <typename Grid>
openvdb::GridBase::Ptr Unpacker::takeDeltas(const Listener& listener) const {
    using Leaf = typename Grid::TreeType::LeafNodeType;
    const std::vector<Column> columns = takeColumns();
    auto grid = Grid::create(0);
    openvdb::tree::ValueAccessor<typename Grid::TreeType> accessor(grid->tree());
    // In portions, so that what is in no tree yet is little.
    constexpr std::size_t kPortion = 2048;
    for (std::size_t begin = 0; begin < columns.size(); begin += kPortion) {
        const std::size_t count = std::min(kPortion, columns.size() - begin);
        std::vector<Leaves<Leaf>> taken(count);
        parallelForChunks(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                taken[i] = takeColumn<Leaf>(columns[begin + i]);
        });
        for (Leaves<Leaf>& column : taken) {
            for (auto& leaf : column) accessor.addLeaf(leaf.release());
        }
        listener.report(double(begin + count) / double(columns.size()));
    }
    return grid;
}

}  // namespace

openvdb::GridBase::Ptr unpackDeltas(const openvdb::GridBase& grid, const DeltaHeader& header,
                                    const std::string& where, const Listener& listener) {
    const Unpacker unpacker(static_cast<const openvdb::Int64Grid&>(grid), header, where);
    const bool isWide = header.exact && *header.exact != ExactValues::kFloat32;
    const openvdb::GridBase::Ptr deltas = isWide
                                              ? unpacker.takeDeltas<openvdb::Int64Grid>(listener)
                                              : unpacker.takeDeltas<openvdb::Int32Grid>(listener);
    deltas->insertMeta(grid);
    deltas->setTransform(grid.transform().copy());
    return deltas;
}

int deltaWidth(const DeltaHeader& header) {
    if (header.exact) return *header.exact == ExactValues::kFloat32 ? 32 : 64;
    const std::size_t inactive = header.inactiveValues.size();
    const std::size_t largest =
        inactive > 0 ? std::size_t(kCodeCount) + inactive : std::size_t(header.codeCount);
    return int(std::bit_width(2 * largest));
}

}  // namespace deltasplat
