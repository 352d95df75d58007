// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/io/Compression.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/vdb/tree_writer.h"
#include "volume/code_math.h"
#include "volume/code_tree.h"
#include "volume/value_cast.h"

namespace deltasplat {

/// How codes are written: as the values that they stand for, without a tree of these.
/// @tparam T  OpenVDB's tree of such values
template <typename T>
class CodeValues {
  public:
    using Tree = CodeTree::Tree;
    using Written = T;
    using Leaf = CodeTree::Leaf;
    using Value = typename Written::ValueType;

    /// @param background  what inactive voxels hold
    CodeValues(std::shared_ptr<const CodeTree> codes, const CodeBook& book, double background)
        : codes_(std::move(codes)), background_(valueAs<Value>(background)) {
        for (const double value : valuesOfCodes(book)) {
            values_.push_back(valueAs<Value>(value));
            if constexpr (ToHalf::isReal) halves_.push_back(ToHalf::convert(Value(values_.back())));
        }
    }

    const Tree& tree() const { return codes_->tree(); }
    Value background() const { return background_; }
    Value ofTile(Code stored, bool active) const {
        return active ? Value(values_[stored]) : background_;
    }
    LeafNote appendLeaf(const Leaf& leaf, bool half, std::string& to) const {
        constexpr std::int8_t kKind = openvdb::io::NO_MASK_OR_INACTIVE_VALS;
        appendBytes(kKind, to);
        return {kKind, ToHalf::isReal && half ? appendActive(leaf, halves_, half, to)
                                              : appendActive(leaf, values_, false, to)};
    }
    void appendBools(const Leaf& leaf, std::string& to) const {
        typename Leaf::NodeMaskType values(background_);
        for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
            values.set(voxel.pos(), values_[*voxel]);
        appendBytes(values, to);
    }

  private:
    using ToHalf = openvdb::io::RealToHalf<Value>;
    // No bits of a vector's words.
    using Kept = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t, Value>;

    template <typename Stored>
    static std::int64_t appendActive(const Leaf& leaf, const std::vector<Stored>& table, bool half,
                                     std::string& to) {
        std::array<Stored, Leaf::SIZE> values;
        const Code* const codes = leaf.buffer().data();
        std::size_t count = 0;
        if (leaf.isDense()) {
            for (; count < values.size(); ++count) values[count] = table[codes[count]];
        } else {
            forBits(leaf.getValueMask(), [&](std::size_t i) { values[count++] = table[codes[i]]; });
        }
        return appendStored(values.data(), count, half, to);
    }

    std::shared_ptr<const CodeTree> codes_;
    Value background_;
    std::vector<Kept> values_;                    // of each code
    std::vector<typename ToHalf::HalfT> halves_;  // of each code, of real values
};

}  // namespace deltasplat
