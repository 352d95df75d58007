// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/word_tree.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <span>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "formats/delta/bit_reader.h"
#include "volume/leaf_slices.h"

namespace deltasplat {
namespace {

using Tree = openvdb::Int64Tree;
using Leaf = Tree::LeafNodeType;
constexpr std::size_t kLeafWords = Leaf::NUM_VALUES;

bool holdsFirst(const VdbLeaves::Mask& mask, std::size_t count) {
    for (std::size_t i = 0; i < mask.size(); ++i) {
        const std::size_t bits = count < 64 * i ? 0 : std::min<std::size_t>(64, count - 64 * i);
        if (mask[i] != BitReader::lowBits(int(bits))) return false;
    }
    return true;
}
bool holdsFirst(const Leaf& leaf, std::size_t count) {
    VdbLeaves::Mask mask;
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask[i] = leaf.getValueMask().getWord<std::uint64_t>(openvdb::Index(i));
    return holdsFirst(mask, count);
}

// Takes the words of a file's leaves.
class LeafWords {
  public:
    // @param end  index behind the last leaf that will be asked for
    LeafWords(const VdbLeaves& leaves, std::size_t end) : leaves_(leaves) { room_.end = end; }

    // Returns a leaf's words until the next call; nothing for gaps or a wrong origin.
    std::optional<std::span<const std::int64_t>> of(std::size_t i) {
        const VdbLeaf& leaf = leaves_.leaves()[i];
        if (openvdb::Coord(leaf.origin.data()) != wordLeafOrigin(i)) return std::nullopt;
        VdbLeaves::Mask mask;
        const auto words = leaves_.activeValues(leaf, mask, room_);
        if (!words || words->empty() || !holdsFirst(mask, words->size())) return std::nullopt;
        return words;
    }

  private:
    const VdbLeaves& leaves_;
    VdbLeaves::Room<std::int64_t> room_;
};

}  // namespace

openvdb::Coord wordLeafOrigin(std::size_t leaf) {
    const std::size_t node = leaf >> 12;  // a node has 16^3 leaves; 32^3 nodes make a node in turn
    return {int(8 * (leaf >> 8 & 15) + 128 * (node >> 10)),
            int(8 * (leaf >> 4 & 15) + 128 * (node >> 5 & 31)),
            int(8 * (leaf & 15) + 128 * (node & 31))};
}

Tree::Ptr treeOfWords(const std::vector<std::uint64_t>& words) {
    auto tree = std::make_shared<Tree>(0);
    openvdb::tree::ValueAccessor<Tree> accessor(*tree);
    for (std::size_t begin = 0; begin < words.size(); begin += kLeafWords) {
        const std::size_t count = std::min(kLeafWords, words.size() - begin);
        auto leaf = std::make_unique<Leaf>(wordLeafOrigin(begin / kLeafWords), 0, false);
        std::memcpy(leaf->buffer().data(), &words[begin], count * sizeof words[0]);
        for (std::size_t i = 0; i < count; ++i) leaf->setValueOn(openvdb::Index(i));
        accessor.addLeaf(leaf.release());
    }
    return tree;
}

std::vector<std::uint64_t> wordsOfTree(const Tree& tree, std::size_t padding,
                                       const std::string& where) {
    const auto count = std::size_t(tree.activeVoxelCount());
    // Words of tiles are only a claim of the file.
    const auto require = tree.hasActiveTiles() ? requireClaimedMemory : requireMemory;
    require(where, double(count) * sizeof(std::uint64_t));
    std::vector<std::uint64_t> words(count + padding);
    const openvdb::tree::ValueAccessor<const Tree> accessor(tree);
    for (std::size_t begin = 0; begin < count; begin += kLeafWords) {
        const std::size_t size = std::min(kLeafWords, count - begin);
        const openvdb::Coord origin = wordLeafOrigin(begin / kLeafWords);
        const Leaf* const leaf = accessor.probeConstLeaf(origin);
        if (leaf && holdsFirst(*leaf, size)) {
            std::memcpy(&words[begin], leaf->buffer().data(), size * sizeof words[0]);
        } else if (!leaf && size == kLeafWords && accessor.isValueOn(origin)) {
            // Other programs make tiles of equal words.
            std::fill_n(&words[begin], size, std::uint64_t(accessor.getValue(origin)));
        } else {
            throw Error(ErrorCode::kInput, where,
                        "a gap in its words in or behind number " + std::to_string(begin),
                        std::to_string(count) + ", one behind the other");
        }
    }
    return words;
}

std::optional<std::size_t> countWords(const VdbLeaves& leaves) {
    if (leaves.leaves().empty()) return 0;
    const std::size_t last = leaves.leaves().size() - 1;
    LeafWords leafWords(leaves, last + 1);
    const auto words = leafWords.of(last);
    if (!words) return std::nullopt;
    return last * kLeafWords + words->size();
}

std::optional<UnclearedVector<std::uint64_t>> wordsOfLeaves(const VdbLeaves& leaves,
                                                            std::size_t count, std::size_t padding,
                                                            const std::string& where) {
    requireMemory(where, double(count + padding) * sizeof(std::uint64_t));
    UnclearedVector<std::uint64_t> words(count + padding);
    std::fill(words.end() - std::ptrdiff_t(padding), words.end(), 0);
    constexpr std::size_t kLeaves = VdbLeaves::kRun;
    const std::size_t leafCount = (count + kLeafWords - 1) / kLeafWords;
    std::atomic<bool> areWhole = true;
    parallelFor((leafCount + kLeaves - 1) / kLeaves, [&](std::size_t part) {
        const std::size_t end = std::min(leafCount, (part + 1) * kLeaves);
        LeafWords leafWords(leaves, end);
        for (std::size_t leaf = part * kLeaves; leaf < end; ++leaf) {
            const std::size_t place = leaf * kLeafWords;
            const std::size_t size = std::min(kLeafWords, count - place);
            const auto some = leafWords.of(leaf);
            if (!some || some->size() < size) {
                areWhole = false;
                return;
            }
            std::memcpy(&words[place], some->data(), size * sizeof words[0]);
        }
    });
    if (!areWhole) return std::nullopt;
    return words;
}

}  // namespace deltasplat
