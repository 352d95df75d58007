// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/dense_layout.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/text.h"
#include "deltasplat/ingest/label_list.h"
#include "formats/raw/raw_format.h"
#include "formats/vdb/grid_metadata.h"
#include "volume/grid_values.h"
#include "volume/placement.h"
#include "volume/tree_grid.h"

namespace deltasplat {

glm::dvec3 DenseLayout::spacing() const {
    glm::dvec3 lengths;
    for (int axis = 0; axis < 3; ++axis)
        lengths[axis] = glm::length(glm::dvec3(worldFromIndex[axis]));
    return lengths;
}

glm::dmat3 DenseLayout::directions() const {
    glm::dmat3 units;
    for (int axis = 0; axis < 3; ++axis) {
        units[axis] = glm::dvec3(worldFromIndex[axis]) / spacing()[axis];
    }
    return units;
}

bool DenseLayout::isOrthogonal() const {
    constexpr double kNearly = 1e-5;
    const glm::dmat3 units = directions();
    return std::abs(glm::dot(units[0], units[1])) < kNearly &&
           std::abs(glm::dot(units[1], units[2])) < kNearly &&
           std::abs(glm::dot(units[2], units[0])) < kNearly;
}

void DenseLayout::turnTo(const std::string& otherSpace) {
    if (space.empty() || space == otherSpace) return;
    for (int column = 0; column < 4; ++column) {
        // Adding 0 turns -0, which is the same place, into 0.
        worldFromIndex[column].x = -worldFromIndex[column].x + 0.0;
        worldFromIndex[column].y = -worldFromIndex[column].y + 0.0;
    }
    space = otherSpace;
}

void DenseLayout::noteLabels(const std::string& format, bool all, WriteNotes& notes) const {
    if (!labels || (!all && labels->entries.empty())) return;
    const std::string named = labels->entries.empty() ? "" : "names and colours of labels";
    const std::string said = all ? "that values are labels" : "";
    notes.loss(named + (named.empty() || said.empty() ? "" : ", and ") + said +
               (all && named.empty() ? " is left out: " : " are left out: ") + format +
               " has no place for " + (all && named.empty() ? "it" : "them") +
               " (.vdb and .seg.nrrd have)");
}

void DenseLayout::turnToMillimetres() {
    if (lengthUnit.empty() || lengthUnit == "mm") return;
    scaleLengths(worldFromIndex, millimetresIn(lengthUnit));
    lengthUnit = "mm";
}

namespace {

std::optional<RawType> typeNamed(const std::string& name) {
    for (int i = 0; i <= int(RawType::kInt64); ++i) {
        if (name == rawTypeName(RawType(i))) return RawType(i);
    }
    return {};
}

std::string sourceType(const Volume& volume) {
    return volume.source() ? volume.source()->grid.metadata.text(kSourceTypeKey) : "";
}

// Returns the name that dense formats give to one of OpenVDB's types.
std::string denseName(const std::string& type) {
    if (type == "float" || type == "half") return "float32";
    if (type == "double") return "float64";
    return type == "bool" || type == "mask" ? "uint8" : type;
}

RawType chooseType(const Volume& volume, const ValueFacts& facts, bool wide) {
    for (const std::string& name : {sourceType(volume), denseName(volume.type())}) {
        const std::optional<RawType> type = typeNamed(name);
        const bool known = wide || (type != RawType::kInt64 && type != RawType::kUint64);
        if (type && known && facts.fit(*type)) return *type;
    }
    if (volume.type() == "int64" && facts.fit(RawType::kInt32)) return RawType::kInt32;
    return facts.fit(RawType::kFloat32) ? RawType::kFloat32 : RawType::kFloat64;
}

}  // namespace

RawType denseType(const Volume& volume, const ValueFacts& facts, bool wide, WriteNotes& notes) {
    const RawType type = chooseType(volume, facts, wide);
    const std::string name = rawTypeName(type);
    const std::string before = sourceType(volume).empty() ? volume.type() : sourceType(volume);
    if (!facts.fit(type)) {
        notes.loss(before + " stored as " + name + ", which is off by up to " +
                   numberText(facts.doubleError));
    } else if (name != before && volume.readError() == 0 &&
               !(before == "float" && name == "float32") &&
               !(before == "double" && name == "float64")) {
        notes.remark(before + " stored as " + name + ", which holds every value");
    }
    return type;
}

namespace {

template <typename T>
bool within(const ValueFacts& facts) {
    // A whole number below the next power of two is at most the largest.
    return facts.whole && facts.doubleError == 0 &&
           facts.min >= double(std::numeric_limits<T>::min()) &&
           facts.max < std::ldexp(1.0, std::numeric_limits<T>::digits);
}

struct Adding {
    bool inactiveOnly = false;  // skips active voxels of leaves
    bool isUnsigned = false;    // int64 values are bits of uint64

    template <typename T>
    void add(T value, ValueFacts& facts) const {
        if constexpr (std::is_same_v<T, std::int64_t>)
            if (isUnsigned) return facts.add(std::uint64_t(value));
        facts.add(value);
    }
    template <typename Leaf>
    void addLeaf(const Leaf& leaf, ValueFacts& facts) const {
        if (inactiveOnly) {
            for (auto voxel = leaf.cbeginValueOff(); voxel; ++voxel) add(*voxel, facts);
        } else {
            for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) add(leaf.getValue(i), facts);
        }
    }
};

template <typename Tree>
ValueFacts factsOfTree(const Tree& tree, const Adding& adding) {
    std::vector<const typename Tree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    std::vector<ValueFacts> parts(leaves.size() / kLeafRun + 1);
    forLeafRuns(leaves.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) adding.addLeaf(*leaves[i], parts[run]);
    });

    ValueFacts whole;
    adding.add(tree.background(), whole);
    for (const ValueFacts& part : parts) whole.append(part);
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) adding.add(*tile, whole);
    return whole;
}

ValueFacts factsOfCodes(const Volume& volume) {
    ValueFacts facts;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] != 0) facts.add(volume.codeBook().valueOf(Code(code)));
    }
    if (volume.hasBackground()) facts.add(volume.background());
    return facts;
}

}  // namespace

void ValueFacts::append(const ValueFacts& other) {
    if (!other.any) return;
    min = any ? std::min(min, other.min) : other.min;
    max = any ? std::max(max, other.max) : other.max;
    any = true;
    whole = whole && other.whole;
    floats = floats && other.floats;
    ints = ints && other.ints;
    unsignedInts = unsignedInts && other.unsignedInts;
    doubleError = std::max(doubleError, other.doubleError);
}

bool ValueFacts::fit(RawType type) const {
    return withRawType(type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_same_v<T, std::int64_t>) return ints;
        if constexpr (std::is_same_v<T, std::uint64_t>) return unsignedInts;
        if constexpr (std::is_integral_v<T>) return within<T>(*this);
        return doubleError == 0 && (floats || std::is_same_v<T, double>);
    });
}

ValueFacts factsOf(const Volume& volume) {
    if (!volume.source()) return factsOfCodes(volume);
    // The histogram knows exact codes.
    const bool isExact = volume.codeBook().isExact();
    ValueFacts facts = isExact ? factsOfCodes(volume) : ValueFacts();
    const Adding adding{isExact, holdsUnsigned(volume)};
    volume.source()->grid.apply<ScalarTrees>(
        [&](const auto& tree) { facts.append(factsOfTree(tree, adding)); });
    return facts;
}

}  // namespace deltasplat
