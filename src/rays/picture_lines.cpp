// SPDX-License-Identifier: Apache-2.0
#include "rays/picture_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>

#include "deltasplat/ingest/slot.h"
#include "deltasplat/view/factorization.h"
#include "view/picture_rays.h"

namespace deltasplat {

namespace {

// Reach of values between voxels.
constexpr double kReach = 1;

Camera refined(Camera camera, int perSide) {
    camera.sizePixels *= perSide;
    return camera;
}

// Width over length of a voxel as seen in the middle of the volume: 1 for a cube.
double narrowness(const Volume& volume, const Camera& camera) {
    const glm::dmat3 edges(volume.worldFromIndex());
    glm::dvec3 sight = camera.direction;
    if (camera.projection != Projection::kOrtho) {
        const glm::dvec3 middle =
            0.5 * (glm::dvec3(volume.box().min) + glm::dvec3(volume.box().max));
        const glm::dvec3 away =
            glm::dvec3(volume.worldFromIndex() * glm::dvec4(middle, 1)) - camera.eyeWorld();
        if (glm::length(away) > 0) sight = glm::normalize(away);
    }
    const glm::dmat3 across = edges - glm::outerProduct(sight, sight * edges);
    // Squared length and width, from their sum and the sum of their squares.
    const glm::dmat3 squares = across * glm::transpose(across);
    const double sum = squares[0][0] + squares[1][1] + squares[2][2];
    double ofSquares = 0;
    for (int column = 0; column < 3; ++column)
        ofSquares += glm::dot(squares[column], squares[column]);
    const double apart = std::sqrt(std::max(0.0, 2 * ofSquares - sum * sum));
    return sum > apart ? std::sqrt((sum - apart) / (sum + apart)) : 0;
}

double pixelsPerVoxel(const Volume& volume, const Camera& camera) {
    return camera.projection == Projection::kOrtho
               ? factorize(camera, volume.worldFromIndex(), 1).pixelsPerVoxel
               : factorizeRegions(camera, volume.box(), volume.worldFromIndex(), 1)
                     .front()
                     .pixelsPerVoxel;
}

}  // namespace

LineCount countLines(const Volume& volume, const Camera& camera) {
    const double pixels = pixelsPerVoxel(volume, camera);
    const glm::dvec2 size(camera.sizePixels);
    // From an eye, every row and column is kept in memory.
    const double mostAcross = camera.projection == Projection::kOrtho ? 0x1p30 : 0x1p18;
    const double most =
        std::max(std::floor(mostAcross / std::max(size.x, size.y)), double(kLeastPerSide));
    const double narrow = pixels * narrowness(volume, camera);
    // Neither a tenth of a voxel too few matters, nor pixels half as large again as voxels.
    constexpr double kHardlyNarrow = 1.5;
    const auto linesOf = [most](double side) {
        return side > 0 ? std::max(std::ceil(1 / side - 0.1), 1.0) : most;
    };
    const double all = narrow * kHardlyNarrow >= 1 ? linesOf(pixels) : linesOf(narrow);
    const double wanted = std::min(all, most);
    if (wanted <= kLeastPerSide) return {int(wanted), all / wanted};
    const SeenBox seen = seenBox(volume.box(), volume.worldFromIndex(), camera, kReach);
    const double shown = std::min(seen.size.x, size.x) * std::min(seen.size.y, size.y);
    const double affordable = std::sqrt(kMostLines / std::max(shown, 0x1p-60));
    const double count = std::min(wanted, std::max(std::floor(affordable), double(kLeastPerSide)));
    return {int(count), all / count};
}

PictureLines::PictureLines(const Volume& volume, const Camera& camera, int perSide)
    : camera_(camera),
      perSide_(perSide),
      fine_(refined(camera, perSide)),
      world_(volume.worldFromIndex()),
      box_(volume.box()),
      seen_(seenOf(volume.box())),
      linear_(volume.worldFromIndex()) {
    const glm::dmat3 fromWorld = glm::inverse(linear_);
    const glm::dvec3 first(volume.worldFromIndex() * glm::dvec4(volume.box().min, 1));
    if (camera.projection != Projection::kOrtho) {
        rays_.emplace(fine_, fromWorld);
        origin_ = fromWorld * (camera.eyeWorld() - first);
        return;
    }
    origin_ = fromWorld * (fine_.worldFromPixel({0.5, 0.5}) - first);
    alongX_ = fine_.pixelWorld() * (fromWorld * camera.right);
    alongY_ = -fine_.pixelHeightWorld() * (fromWorld * camera.up);
    first_ = lineOf(origin_, fromWorld * camera.direction);
}

PixelBox PictureLines::seenOf(const IndexBox& box) const {
    return seenBox(box, world_, fine_, kReach).part;
}

PictureLine PictureLines::at(int x, int y) const {
    if (first_) {
        PictureLine line = *first_;
        line.ray.moveTo(origin_ + double(x) * alongX_ + double(y) * alongY_);
        return line;
    }
    PictureLine line = lineOf(origin_, rays_->at(x, y));
    line.ray.beginAt(camera_.nearWorld / line.depthWorld);
    return line;
}

PictureLine PictureLines::lineOf(const glm::dvec3& through, const glm::dvec3& direction) const {
    const SightRay ray(box_, through, direction);
    const glm::dvec3 perSlice = linear_ * (direction / std::abs(direction[ray.axes.order[0]]));
    const double length = glm::length(perSlice);
    const bool isFlat = camera_.projection != Projection::kLatlong;
    return {ray, length, isFlat ? glm::dot(perSlice, camera_.direction) : length,
            rays_ ? 0 : camera_.targetDistanceWorld};
}

namespace {

// Limit for ties and straight views, so that rounding neither chooses an axis nor tilts a view.
constexpr double kRounding = 1e-9;

int mostParallelAxis(const glm::dvec3& ray) {
    int axis = 0;
    for (int other = 1; other < 3; ++other) {
        if (std::abs(ray[other]) >= std::abs(ray[axis]) * (1 - kRounding)) axis = other;
    }
    return axis;
}

double snapped(double slope) {
    return slope < kRounding ? 0 : slope > 1 - kRounding ? 1 : slope;
}

}  // namespace

SightRay::SightRay(const IndexBox& box, const glm::dvec3& through, const glm::dvec3& ray) {
    axes.order = sliceOrder(mostParallelAxis(ray));
    for (int i = 0; i < 3; ++i) {
        const int axis = axes.order[i];
        axes.sign[i] = ray[axis] < 0 ? -1 : 1;
        axes.first[i] = ray[axis] < 0 ? box.max[axis] : box.min[axis];
        axes.count[i] = box.max[axis] - box.min[axis] + 1;
    }
    const double along = std::abs(ray[axes.order[0]]);
    for (int i = 0; i < 2; ++i) slope[i] = snapped(std::abs(ray[axes.order[i + 1]]) / along);
    moveTo(through);
}

void SightRay::moveTo(const glm::dvec3& through) {
    glm::dvec3 point;
    for (int i = 0; i < 3; ++i) {
        const double at = through[axes.order[i]];
        point[i] = axes.sign[i] < 0 ? axes.count[i] - 1 - at : at;
    }
    point_ = point.x;
    start = glm::dvec2(point.y, point.z) - point.x * slope;
    nearest = -std::numeric_limits<double>::infinity();
    clip();
}

void SightRay::beginAt(double slicesFromPoint) {
    nearest = point_ + slicesFromPoint;
    clip();
}

// A voxel is read from up to one voxel away.
void SightRay::clip() {
    slices = {std::max(nearest, -1.0), axes.count[0]};
    for (int i = 0; i < 2; ++i) {
        const double low = -1 - start[i];
        const double high = axes.count[i + 1] - start[i];
        if (slope[i] > 0) {
            slices.x = std::max(slices.x, low / slope[i]);
            slices.y = std::min(slices.y, high / slope[i]);
        } else if (low >= 0 || high <= 0) {
            slices.y = slices.x - 1;
        }
    }
}

void LineGroup::addSlices(const glm::dvec2& slices) {
    slices_ = {std::min(slices_.x, slices.x), std::max(slices_.y, slices.y)};
}

void LineGroup::addLine(const glm::dvec2& start, const glm::dvec2& slope) {
    const auto add = [&](Range& range, double slice) {
        range.low = glm::min(range.low, start + slice * slope);
        range.high = glm::max(range.high, start + slice * slope);
    };
    add(first_, slices_.x - 1);
    add(last_, slices_.y + 1);
}

// The minimum of linear functions lies above the straight line between its ends, the maximum below.
LineGroup::Range LineGroup::rangeAt(double slice) const {
    const double way = std::clamp((slice - slices_.x + 1) / (slices_.y - slices_.x + 2), 0.0, 1.0);
    return {glm::mix(first_.low, last_.low, way), glm::mix(first_.high, last_.high, way)};
}

float LineGroup::topOf(const TopGrid& tops, const RayAxes& axes, const BlockLayer& layer) const {
    // Rounding puts no line into an unseen voxel.
    constexpr double kRounding = 1e-6;
    const glm::dvec2 from = rangeAt(layer.slices.x - 1).low - kRounding;
    const glm::dvec2 to = rangeAt(layer.slices.y + 1).high + kRounding + 1.0;
    glm::ivec3 low(0), high(0);
    low[axes.order[0]] = high[axes.order[0]] = layer.block;
    for (int i = 1; i < 3; ++i) {
        const double last = axes.count[i];
        if (to[i - 1] < 0 || from[i - 1] > last) return -std::numeric_limits<float>::infinity();
        const int a = axes.voxelAt(i, int(std::floor(std::max(from[i - 1], 0.0)))) >> 3;
        const int b = axes.voxelAt(i, int(std::floor(std::min(to[i - 1], last)))) >> 3;
        low[axes.order[i]] = std::min(a, b);
        high[axes.order[i]] = std::max(a, b);
    }
    return tops.topBetween(low, high);
}

namespace {

// Following a square takes longer than placing this many blocks in a picture.
constexpr double kBlocksOfCell = 16;
// Near an eye, one block may be in all squares.
constexpr double kPlacesOfBlock = 64;

PixelBox bothOf(const PixelBox& a, const PixelBox& b) {
    return {glm::max(a.min, b.min), glm::min(a.max, b.max)};
}

}  // namespace

LineCells::LineCells(const PictureLines& lines, const RayVolume& volume, int side)
    : side_(side), box_(cellsOf(lines.seen())) {
    const glm::dvec2 size = box_.size();
    const auto blocks = double(volume.blocks.size());
    if (box_.empty() || blocks > kBlocksOfCell * size.x * size.y) return;
    std::vector<PixelBox> places;
    double placed = 0;
    for (const CodeBlock& block : volume.blocks) {
        const IndexBox voxels{8 * block.position, 8 * block.position + 7};
        places.push_back(bothOf(cellsOf(lines.seenOf(voxels)), box_));
        if (places.back().empty()) continue;
        const glm::dvec2 cells = places.back().size();
        placed += cells.x * cells.y;
        if (placed > size.x * size.y + kPlacesOfBlock * blocks) return;
    }
    const auto forPlaces = [&](const auto& use) {
        for (std::size_t i = 0; i < places.size(); ++i)
            for (int y = places[i].min.y; y < places[i].max.y; ++y)
                for (int x = places[i].min.x; x < places[i].max.x; ++x)
                    use(indexOf({x, y}), std::uint32_t(i));
    };
    ends_.resize(std::size_t(size.x) * std::size_t(size.y) + 1);
    forPlaces([&](std::size_t cell, std::uint32_t) { ++ends_[cell + 1]; });
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    blocks_.resize(ends_.back());
    // An end starts as its cell's begin, and grows with the cell's blocks.
    forPlaces([&](std::size_t cell, std::uint32_t block) { blocks_[ends_[cell]++] = block; });
}

std::vector<std::uint32_t> LineCells::blocksBehind(const PixelBox& lines) const {
    std::vector<std::uint32_t> found;
    const PixelBox cells = bothOf(cellsOf(lines), box_);
    for (int y = cells.min.y; y < cells.max.y; ++y) {
        for (int x = cells.min.x; x < cells.max.x; ++x) {
            const std::size_t cell = indexOf({x, y});
            const std::size_t begin = cell > 0 ? ends_[cell - 1] : 0;
            found.insert(found.end(), blocks_.begin() + std::ptrdiff_t(begin),
                         blocks_.begin() + std::ptrdiff_t(ends_[cell]));
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

PixelBox LineCells::cellsOf(const PixelBox& lines) const {
    return {lines.min / side_, (lines.max + side_ - 1) / side_};
}

std::size_t LineCells::indexOf(glm::ivec2 cell) const {
    const glm::ivec2 place = cell - box_.min;
    return std::size_t(place.y) * std::size_t(box_.size().x) + std::size_t(place.x);
}

}  // namespace deltasplat
