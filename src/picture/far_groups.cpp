// SPDX-License-Identifier: Apache-2.0
// Based on: Henry Fuchs, Zvi Kedem and Bruce Naylor, "On Visible Surface Generation by A Priori
// Tree Structures", 1980: planes between groups order them for every eye.
#include "picture/far_groups.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <memory>
#include <queue>
#include <string>
#include <utility>

#include "base/affine.h"
#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/ingest/slot.h"
#include "optics/voxel_painter.h"
#include "view/picture_rays.h"
#include "volume/code_blocks.h"
#include "volume/code_tree.h"
#include "volume/slot_blocks.h"

namespace deltasplat {
namespace {

// Cost of drawing a box of blocks, in blocks: its three faces are sheets and layers; every slice
// and the picture itself cost something, too.
double costOf(const IndexBox& blocks) {
    constexpr double kBlocksPerSlice = 512;
    const glm::dvec3 d = glm::dvec3(blocks.max) - glm::dvec3(blocks.min) + 1.0;
    return d.x * d.y + d.y * d.z + d.z * d.x + kBlocksPerSlice * (d.x + d.y + d.z);
}

// Cheaper boxes are drawn as one: about 3000 voxels a side, or 16000 along one.
constexpr double kLeastCost = 1 << 20;
// Cheaper groups are not divided.
constexpr double kSmallGroup = 1 << 16;
// Least gap between groups in blocks, wider than the reach of any voxel's footprint.
constexpr int kLeastGap = 16;
constexpr std::size_t kMostGroups = 4096;
// Limit of the pieces sorted for all splits together.
constexpr std::size_t kMostWork = 20'000'000;

IndexBox blocksOf(const IndexBox& voxels) {
    IndexBox blocks;
    for (int axis = 0; axis < 3; ++axis) {
        blocks.min[axis] = voxels.min[axis] >> 3;
        blocks.max[axis] = voxels.max[axis] >> 3;
    }
    return blocks;
}

// The widest gap between pieces along an axis.
struct Gap {
    std::int64_t blocks = 0;
    int axis = 0;
    int before = 0;  // the last block before the gap
};

std::string rangesText(const IndexBox& box) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        text += (axis > 0 ? "," : "") + std::to_string(box.min[axis]) + ":" +
                std::to_string(box.max[axis]);
    }
    return text;
}

std::string roundedText(double number) {
    constexpr int kDigits = 3;
    char text[32];
    const auto end =
        std::to_chars(text, text + sizeof text, number, std::chars_format::general, kDigits);
    return {text, end.ptr};
}

}  // namespace

struct FarGroups::Impl {
    // A leaf, a tile, or an added block, in blocks of 8x8x8 voxels, both ends inclusive.
    struct Piece {
        glm::ivec3 first{0};
        glm::ivec3 last{0};
        const CodeTree::Leaf* leaf = nullptr;
        int level = 0;  // of a tile; 0: no tile
        Code code = 0;
    };
    // A node of the tree of planes.
    struct Node {
        std::size_t begin = 0;  // of the node's pieces
        std::size_t end = 0;
        IndexBox blocks;
        int axis = -1;        // across the plane; -1: the node is a group
        double plane = 0;     // voxel index, between both sides
        std::size_t low = 0;  // nodes, or the number of a group
        std::size_t high = 0;
    };
    struct Group {
        std::size_t begin;
        std::size_t end;
        IndexBox box;  // of voxels
    };

    explicit Impl(const Volume& ofVolume) : volume(ofVolume) {}
    void listPieces(const BlockSet* more);
    void splitAll();
    Node nodeOf(std::size_t begin, std::size_t end) const;
    bool split(std::size_t number);
    double joinWhereCheaper();
    void numberGroups();
    IndexBox boxOf(std::size_t begin, std::size_t end) const;
    std::uint64_t voxelsOf(const Group& group) const;
    double widthWorld(const IndexBox& box) const;

    const Volume& volume;
    std::optional<IndexBox> moreBox;
    std::vector<Piece> pieces;
    std::vector<Node> nodes;  // the first holds all pieces
    std::vector<Group> groups;
};

std::optional<FarGroups> FarGroups::find(const Volume& volume, const BlockSet* more) {
    if (volume.empty() || !volume.codes()) return {};
    const double cost = costOf(blocksOf(volume.box()));
    // With many voxels, groups would not be cheaper.
    constexpr double kVoxelsOfBlock = 512;
    constexpr double kWorth = 2;
    if (cost < kLeastCost || kWorth * double(volume.activeCount()) / kVoxelsOfBlock > cost)
        return {};
    auto impl = std::make_shared<Impl>(volume);
    impl->listPieces(more);
    if (impl->pieces.empty()) return {};
    impl->splitAll();
    // Even a single group may be worth it: cuts leave voxels in a box made for more.
    if (kWorth * impl->joinWhereCheaper() > cost) return {};
    impl->numberGroups();
    return FarGroups(std::move(impl));
}

std::size_t FarGroups::size() const {
    return impl_->groups.size();
}

void FarGroups::Impl::splitAll() {
    nodes.push_back(nodeOf(0, pieces.size()));
    const auto isCheaper = [&](std::size_t a, std::size_t b) {
        return costOf(nodes[a].blocks) < costOf(nodes[b].blocks);
    };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(isCheaper)> left(isCheaper);
    left.push(0);
    std::size_t work = 0;
    while (!left.empty() && nodes.size() < 2 * kMostGroups && work < kMostWork) {
        const std::size_t number = left.top();
        left.pop();
        if (costOf(nodes[number].blocks) < kSmallGroup) break;
        work += nodes[number].end - nodes[number].begin;
        if (!split(number)) continue;
        left.push(nodes[number].low);
        left.push(nodes[number].high);
    }
}

void FarGroups::Impl::listPieces(const BlockSet* more) {
    const CodeTree::Tree& tree = volume.codes()->nodes();
    const auto positionOf = [](const openvdb::Coord& voxel) {
        return glm::ivec3(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
    };
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        if (leaf->isEmpty()) continue;
        const glm::ivec3 position = positionOf(leaf->origin());
        pieces.push_back({position, position, &*leaf});
    }
    auto tile = tree.cbeginValueOn();
    tile.setMaxDepth(CodeTree::Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        pieces.push_back({positionOf(box.min()), positionOf(box.max()), nullptr,
                          int(tile.getLevel()), Code(tile.getValue())});
    }
    if (more && !more->positions.empty()) {
        for (const glm::ivec3& position : more->positions) pieces.push_back({position, position});
        moreBox = more->box;
    }
    requireMemory("groups of voxels", double(sizeof(Piece)) * double(pieces.size()));
}

FarGroups::Impl::Node FarGroups::Impl::nodeOf(std::size_t begin, std::size_t end) const {
    Node node{begin, end, {pieces[begin].first, pieces[begin].last}};
    for (std::size_t i = begin; i < end; ++i) {
        node.blocks.min = glm::min(node.blocks.min, pieces[i].first);
        node.blocks.max = glm::max(node.blocks.max, pieces[i].last);
    }
    return node;
}

bool FarGroups::Impl::split(std::size_t number) {
    const Node node = nodes[number];
    Gap widest;
    std::vector<std::pair<int, int>> ends;
    for (int axis = 0; axis < 3; ++axis) {
        ends.clear();
        for (std::size_t i = node.begin; i < node.end; ++i)
            ends.emplace_back(pieces[i].first[axis], pieces[i].last[axis]);
        std::sort(ends.begin(), ends.end());
        int last = ends.front().second;
        for (const auto& [first, end] : ends) {
            const std::int64_t blocks = std::int64_t{first} - last - 1;
            if (blocks > widest.blocks) widest = {blocks, axis, last};
            last = std::max(last, end);
        }
    }
    if (widest.blocks < kLeastGap) return false;
    const auto begin = pieces.begin() + std::ptrdiff_t(node.begin);
    const auto end = pieces.begin() + std::ptrdiff_t(node.end);
    const auto middle = std::stable_partition(
        begin, end, [&](const Piece& piece) { return piece.last[widest.axis] <= widest.before; });
    const auto at = node.begin + std::size_t(middle - begin);
    const Node low = nodeOf(node.begin, at);
    const Node high = nodeOf(at, node.end);
    Node& divided = nodes[number];
    divided.axis = widest.axis;
    divided.plane = 8.0 * (widest.before + 1.0) + 4.0 * double(widest.blocks) - 0.5;
    divided.low = nodes.size();
    divided.high = nodes.size() + 1;
    nodes.push_back(low);
    nodes.push_back(high);
    return true;
}

// Undoes divisions that do not pay, and returns the cost of all groups.
double FarGroups::Impl::joinWhereCheaper() {
    std::vector<double> least(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        Node& node = nodes[i];
        least[i] = costOf(node.blocks);
        if (node.axis < 0) continue;
        const double divided = least[node.low] + least[node.high];
        if (divided < least[i]) {
            least[i] = divided;
        } else {
            node.axis = -1;
        }
    }
    return least.front();
}

void FarGroups::Impl::numberGroups() {
    std::vector<std::size_t> left{0};
    while (!left.empty()) {
        Node& node = nodes[left.back()];
        left.pop_back();
        if (node.axis >= 0) {
            left.insert(left.end(), {node.high, node.low});
            continue;
        }
        node.low = groups.size();
        groups.push_back({node.begin, node.end, boxOf(node.begin, node.end)});
    }
}

// The box of the pieces' voxels.
IndexBox FarGroups::Impl::boxOf(std::size_t begin, std::size_t end) const {
    openvdb::CoordBBox voxels;
    IndexBox added;
    for (std::size_t i = begin; i < end; ++i) {
        const Piece& piece = pieces[i];
        const IndexBox all{8 * piece.first, 8 * piece.last + 7};
        if (piece.leaf) {
            piece.leaf->evalActiveBoundingBox(voxels);
        } else if (piece.level > 0) {
            voxels.expand(openvdb::CoordBBox({all.min.x, all.min.y, all.min.z},
                                             {all.max.x, all.max.y, all.max.z}));
        } else {
            added = boxOfBoth(added,
                              {glm::max(all.min, moreBox->min), glm::min(all.max, moreBox->max)});
        }
    }
    if (voxels.empty()) return added;
    const openvdb::Coord low = voxels.min();
    const openvdb::Coord high = voxels.max();
    return boxOfBoth(added, {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}});
}

std::uint64_t FarGroups::Impl::voxelsOf(const Group& group) const {
    std::uint64_t voxels = 0;
    for (std::size_t i = group.begin; i < group.end; ++i) {
        const Piece& piece = pieces[i];
        const glm::u64vec3 size(8 * (piece.last - piece.first + 1));
        voxels += piece.leaf        ? piece.leaf->onVoxelCount()
                  : piece.level > 0 ? size.x * size.y * size.z
                                    : 0;
    }
    return voxels;
}

Volume FarGroups::volume(std::size_t number) const {
    const Impl::Group& group = impl_->groups[number];
    std::vector<const CodeTree::Leaf*> leaves;
    for (std::size_t i = group.begin; i < group.end; ++i)
        if (impl_->pieces[i].leaf) leaves.push_back(impl_->pieces[i].leaf);
    impl_->volume.codes()->readLeaves(leaves);
    requireMemory("codes of a group of voxels",
                  double(sizeof(CodeTree::Leaf) + 512 * sizeof(Code)) * double(leaves.size()));
    VolumeData volume = impl_->volume.data();
    auto codes = std::make_shared<CodeTree>();
    for (std::size_t i = group.begin; i < group.end; ++i) {
        const Impl::Piece& piece = impl_->pieces[i];
        const glm::ivec3 first = 8 * piece.first;
        if (piece.leaf) {
            codes->tree().addLeaf(new CodeTree::Leaf(*piece.leaf));
        } else if (piece.level > 0) {
            codes->tree().addTile(openvdb::Index(piece.level), {first.x, first.y, first.z},
                                  piece.code, true);
        }
    }
    volume.codes = std::move(codes);
    volume.box = group.box;
    volume.activeCount = std::max<std::uint64_t>(impl_->voxelsOf(group), 1);
    return Volume(std::move(volume));
}

bool FarGroups::Seen::isNothing() const {
    // Smaller shares of a pixel are lost in a 32-bit opacity.
    constexpr double kLeastPixels = 0x1p-26;
    return part.empty() || size.x * size.y < kLeastPixels;
}

FarGroups::Seen FarGroups::seenBy(const Camera& camera, std::size_t number) const {
    // Reach of footprints.
    constexpr double kAround = 8;
    const SeenBox seen =
        seenBox(impl_->groups[number].box, impl_->volume.worldFromIndex(), camera, kAround);
    return {seen.part, seen.size};
}

std::vector<std::size_t> FarGroups::frontToBack(const Camera& camera) const {
    const glm::dmat4& world = impl_->volume.worldFromIndex();
    const glm::dmat3 indexFromWorld = glm::inverse(glm::dmat3(world));
    const bool isParallel = camera.projection == Projection::kOrtho;
    const glm::dvec3 ahead = indexFromWorld * camera.direction;
    const glm::dvec3 eye = indexFromWorld * (camera.eyeWorld() - glm::dvec3(world[3]));
    std::vector<std::size_t> order;
    std::vector<std::size_t> left{0};
    while (!left.empty()) {
        const Impl::Node& node = impl_->nodes[left.back()];
        left.pop_back();
        if (node.axis < 0) {
            order.push_back(node.low);
            continue;
        }
        const bool isLowFirst = isParallel ? ahead[node.axis] >= 0 : eye[node.axis] < node.plane;
        left.push_back(isLowFirst ? node.high : node.low);
        left.push_back(isLowFirst ? node.low : node.high);
    }
    return order;
}

// The longest diagonal of a box of voxels, with a margin of one voxel.
double FarGroups::Impl::widthWorld(const IndexBox& box) const {
    double width = 0;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 diagonal = cornerOf(box, 7 - i) - cornerOf(box, i) +
                                    glm::dvec3(i & 1 ? -2 : 2, i & 2 ? -2 : 2, i & 4 ? -2 : 2);
        width = std::max(width, glm::length(glm::dmat3(volume.worldFromIndex()) * diagonal));
    }
    return width;
}

bool FarGroups::warnOfDots(const Camera& camera, const Listener& listener) const {
    constexpr double kDot = 2;  // pixels
    std::size_t seen = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        const Seen one = seenBy(camera, i);
        if (one.part.empty()) continue;
        if (std::max(one.size.x, one.size.y) > kDot) return false;
        ++seen;
    }
    if (seen == 0) return false;
    const auto largest = std::max_element(impl_->groups.begin(), impl_->groups.end(),
                                          [&](const Impl::Group& a, const Impl::Group& b) {
                                              return impl_->voxelsOf(a) < impl_->voxelsOf(b);
                                          });
    const double share =
        100.0 * double(impl_->voxelsOf(*largest)) / double(impl_->volume.activeCount());
    const glm::dvec3 middle(
        impl_->volume.worldFromIndex() *
        glm::dvec4(0.5 * (glm::dvec3(largest->box.min) + glm::dvec3(largest->box.max)), 1));
    std::string shownBy;
    // A perspective view would need another eye.
    if (camera.projection == Projection::kOrtho) {
        shownBy = ", and `targetWorld` " + numberText(middle) + " with `frameWidthWorld` " +
                  roundedText(impl_->widthWorld(largest->box)) + " shows";
    }
    const double tenths = std::floor(10 * std::min(share, 100.0)) / 10;
    listener.warn("picture: no more than dots, for the voxels lie far apart, in " +
                  std::to_string(size()) + " groups of a pixel or two at most; " +
                  numberText(tenths) + " % of the voxels lie in " + rangesText(largest->box) +
                  ", which `cropIndex` leaves" + shownBy);
    return true;
}

}  // namespace deltasplat
