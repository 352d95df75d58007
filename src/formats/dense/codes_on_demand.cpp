// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/codes_on_demand.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/sorting.h"
#include "formats/dense/dense_tree_builder.h"
#include "formats/raw/raw_format.h"
#include "formats/raw/raw_values.h"
#include "volume/book_encoder.h"
#include "volume/code_counts.h"
#include "volume/code_kernels.h"

namespace deltasplat {
namespace {

constexpr int kBlock = CodeTree::Leaf::DIM;
constexpr std::size_t kBlockVoxels = CodeTree::Leaf::SIZE;

// The bytes of blocks with the same y and z: few enough to stay in the cache.
class BlockRow {
  public:
    BlockRow(const DenseSource& source, int y, int z)
        : dims_(source.dims),
          valueBytes_(std::size_t(rawTypeBytes(source.type))),
          rowBytes_(source.rowBytes()),
          size_(glm::min(glm::ivec2(dims_.y - y, dims_.z - z), glm::ivec2(kBlock))),
          bytes_(std::make_unique_for_overwrite<std::byte[]>(sliceBytes() * std::size_t(size_.y))) {
        for (int slice = 0; slice < size_.y; ++slice) {
            source.rows->read(z + slice, y, size_.x, &bytes_[std::size_t(slice) * sliceBytes()]);
        }
    }

    RawBlock at(int x) const {
        return {&bytes_[std::size_t(x) * valueBytes_],
                rowBytes_,
                sliceBytes(),
                {std::min(dims_.x - x, kBlock), size_.x, size_.y}};
    }

  private:
    std::size_t sliceBytes() const { return std::size_t(size_.x) * rowBytes_; }

    glm::ivec3 dims_;
    std::size_t valueBytes_;
    std::size_t rowBytes_;
    glm::ivec2 size_;  // rows, slices
    std::unique_ptr<std::byte[]> bytes_;
};

class BlockCoder {
  public:
    BlockCoder(const DenseSource& source, const CodeBook& book)
        : book_(book),
          encoder_(book),
          coding_{source.type, source.bigEndian, book_, encoder_},
          encode_(blockEncoder(coding_)) {}
    BlockCoder(const BlockCoder&) = delete;
    BlockCoder& operator=(const BlockCoder&) = delete;

    void encode(const RawBlock& block, Code* codes) const { encode_(block, coding_, codes); }
    const RawCoding& coding() const { return coding_; }

  private:
    CodeBook book_;
    BookEncoder encoder_;
    RawCoding coding_;
    EncodeBlock encode_;
};

void readLeaf(const BlockRow& row, const BlockCoder& coder, CodeTree::Leaf& leaf) {
    expectPieces(kBlockVoxels * sizeof(Code));
    leaf.allocate();
    Code* const codes = leaf.buffer().data();
    if (!leaf.isDense()) std::fill_n(codes, kBlockVoxels, Code{0});
    coder.encode(row.at(leaf.origin().x()), codes);
}

class DenseLeaves : public LeafReader {
  public:
    DenseLeaves(const DenseSource& source, const CodeBook& book)
        : source_(source), coder_(source, book) {
        source_.forEachLayer = nullptr;
    }

    void read(std::span<CodeTree::Leaf* const> leaves) const override {
        std::vector<CodeTree::Leaf*> sorted(leaves.begin(), leaves.end());
        parallelSort(sorted, [](const CodeTree::Leaf* a, const CodeTree::Leaf* b) {
            return rowOf(*a) < rowOf(*b);
        });
        std::vector<std::size_t> begins;  // of rows, and the end
        for (std::size_t i = 0; i < sorted.size(); ++i)
            if (i == 0 || rowOf(*sorted[i]) != rowOf(*sorted[i - 1])) begins.push_back(i);
        begins.push_back(sorted.size());
        parallelFor(begins.size() - 1, [&](std::size_t i) {
            readRow(std::span(sorted).subspan(begins[i], begins[i + 1] - begins[i]));
        });
        source_.rows->requireUnchanged();
    }

  private:
    // Leaves in the same row of blocks are read together.
    static std::pair<int, int> rowOf(const CodeTree::Leaf& leaf) {
        return {leaf.origin().z(), leaf.origin().y()};
    }

    void readRow(std::span<CodeTree::Leaf* const> leaves) const {
        const openvdb::Coord first = leaves.front()->origin();
        const BlockRow row(source_, first.y(), first.z());
        for (CodeTree::Leaf* const leaf : leaves) readLeaf(row, coder_, *leaf);
    }

    DenseSource source_;
    BlockCoder coder_;
};

// Finds the code ranges of blocks, and counts the codes.
class BlockLooker {
  public:
    BlockLooker(const DenseSource& source, const CodeBook& book, std::size_t workers)
        : coder_(source, book),
          isPlain_(rawTypeBytes(source.type) == 1 || !mustSwap(source.bigEndian)),
          counts_(workers) {}

    /// Not concurrently for the same worker.
    std::pair<Code, Code> lookAt(std::size_t worker, const RawBlock& block) {
        const bool isWhole = block.size == glm::ivec3(kBlock);
        return isWhole && isPlain_ ? lookAtPlain(worker, block) : lookAtAny(worker, block);
    }
    const BlockCoder& coder() const { return coder_; }
    std::vector<std::uint64_t> takeHistogram() { return counts_.take(); }

  private:
    std::pair<Code, Code> lookAtPlain(std::size_t worker, const RawBlock& block) {
        const RawCoding& coding = coder_.coding();
        return rawTypeBytes(coding.type) == 1 ? lookAtAll<std::uint8_t>(worker, block)
                                              : lookAtAll<std::uint16_t>(worker, block);
    }

    // @param T  integer type of the codes
    template <typename T>
    std::pair<Code, Code> lookAtAll(std::size_t worker, const RawBlock& block) {
        std::array<T, kBlockVoxels> codes;
        // Codes begin with the type's least number: 0, or the sign bit alone.
        const auto first = std::uint64_t(T(std::int64_t(coder_.coding().book.offset)));
        constexpr std::uint64_t kEach = ~std::uint64_t{0} / std::numeric_limits<T>::max();
        T* next = codes.data();
        for (int z = 0; z < kBlock; ++z) {
            for (int y = 0; y < kBlock; ++y) {
                const std::byte* stored = block.first + std::size_t(z) * block.sliceBytes +
                                          std::size_t(y) * block.rowBytes;
                for (std::size_t i = 0; i < sizeof(T);
                     ++i, next += sizeof(std::uint64_t) / sizeof(T)) {
                    std::uint64_t word;
                    std::memcpy(&word, stored + i * sizeof word, sizeof word);
                    word ^= kEach * first;
                    std::memcpy(next, &word, sizeof word);
                }
            }
        }
        const std::span<const T> all(codes);
        const auto range = rangeOfCodes(all);
        counts_.add(worker, all, range.first, range.second);
        return range;
    }

    std::pair<Code, Code> lookAtAny(std::size_t worker, const RawBlock& block) {
        alignas(64) std::array<Code, kBlockVoxels> codes;
        coder_.encode(block, codes.data());
        return counts_.addBlock(worker, block.size, codes);
    }

    BlockCoder coder_;
    bool isPlain_;
    CodeCounts counts_;
};

// A row of blocks as addRanges() needs it.
struct SeenRow {
    std::size_t worker;
    BlockLooker& looker;
    const SeenCodes* wanted;
    BlockRow row;

    std::pair<Code, Code> rangeOf(int x) const { return looker.lookAt(worker, row.at(x)); }
    bool isWanted(Code low, Code high) const { return wanted && wanted->hasAny(low, high); }
    void read(CodeTree::Leaf& leaf) const { readLeaf(row, looker.coder(), leaf); }
};

}  // namespace

CodesOnDemand codesOnDemand(const DenseSource& source, const CodeBook& book,
                            const SeenCodes* wanted, const Listener& listener) {
    using Builder = DenseTreeBuilder<CodeTree::Tree>;
    const glm::ivec3 dims(source.dims);
    auto codes = std::make_shared<CodeTree>();
    requireMemory(source.where, Builder::bytes(dims));
    Builder builder(codes->tree(), dims);
    BlockLooker looker(source, book, builder.workers());
    const double rowBytes = double(source.rowBytes()) * std::min(dims.y, kBlock) *
                            std::min(dims.z, kBlock) * double(builder.workers());
    const int step = source.stepSlices();
    for (int first = 0; first < dims.z; first += step) {
        const int slices = std::min(step, dims.z - first);
        requireMemory(source.where, rowBytes + builder.worstBytes(slices));
        builder.addRanges(first, slices, [&](std::size_t worker, int y, int z) {
            return SeenRow{worker, looker, wanted, BlockRow(source, y, z)};
        });
        listener.report(double(first + slices) / dims.z);
    }
    source.rows->requireUnchanged();
    codes->noteLeaves(builder.takeLeaves(), std::make_unique<const DenseLeaves>(source, book));
    return {std::move(codes), looker.takeHistogram()};
}

}  // namespace deltasplat
