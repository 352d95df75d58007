// SPDX-License-Identifier: Apache-2.0
#include <openvdb/Types.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "base/affine.h"
#include "base/parallel.h"
#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/progress.h"
#include "diff/voxel_source.h"
#include "volume/grid_values.h"
#include "volume/placement.h"

namespace deltasplat {

namespace {

struct ErrorTerms {
    WideValue backgroundA;
    WideValue backgroundB;
    double fail = 0;
    double warn = 0;
    bool wide = false;  ///< as VoxelSource
};

/// Returns |a - b|: 0 if equal (NaN equals NaN), at most the largest double.
double errorOf(const WideValue& a, const WideValue& b);

/// Summed errors of some voxels. Callers keep one order of additions, because the sums depend on
/// it.
struct ErrorSums {
    std::uint64_t voxels = 0;
    std::uint64_t overFail = 0;
    std::uint64_t overWarn = 0;
    std::uint64_t activeMismatch = 0;
    long double sum = 0;  ///< squares may exceed a double's range
    long double sumOfSquares = 0;
    double max = 0;
    openvdb::Coord maxAt{0, 0, 0};
    WideValue maxA;
    WideValue maxB;

    /// Adds `count` equal voxels, starting at `first`.
    void addTile(const Sample& a, const Sample& b, const openvdb::Coord& first, std::uint64_t count,
                 const ErrorTerms& terms);
    void addBlock(const BlockSamples& a, const BlockSamples& b, const openvdb::Coord& origin,
                  const ErrorTerms& terms);
    void append(const ErrorSums& other);

  private:
    void addMax(double error, const openvdb::Coord& at, const WideValue& a, const WideValue& b);
};

using openvdb::Coord;

constexpr int kVoxels = BlockSamples::kVoxels;
constexpr double kLargest = std::numeric_limits<double>::max();

using Errors = std::array<double, kVoxels>;

bool isCompared(const Sample& a, const Sample& b, const ErrorTerms& terms) {
    return a.active || b.active || a.value != terms.backgroundA || b.value != terms.backgroundB;
}

WideValue valueAt(const BlockSamples& block, int i, bool wide) {
    return {block.high[i], wide ? block.low[i] : 0};
}

Sample sampleAt(const BlockSamples& block, int i, bool wide) {
    return {valueAt(block, i, wide), (block.active[i >> 6] >> (i & 63) & 1) != 0};
}

bool areAllActive(const BlockSamples& a, const BlockSamples& b) {
    for (int word = 0; word < 8; ++word) {
        if (~(a.active[word] | b.active[word]) != 0) return false;
    }
    return true;
}

// Branch-free, so that the compiler vectorizes it.
bool areSame(const std::array<double, kVoxels>& a, const std::array<double, kVoxels>& b) {
    int different = 0;
    for (int i = 0; i < kVoxels; ++i) different |= a[i] != b[i];
    return different == 0;
}

void findErrors(const BlockSamples& a, const BlockSamples& b, bool wide, Errors& errors) {
    int odd = 0;
    if (wide) {
        for (int i = 0; i < kVoxels; ++i) {
            errors[i] = std::fabs((a.high[i] - b.high[i]) + (a.low[i] - b.low[i]));
            odd |= !(errors[i] <= kLargest);
        }
    } else {
        for (int i = 0; i < kVoxels; ++i) {
            errors[i] = std::fabs(a.high[i] - b.high[i]);
            odd |= !(errors[i] <= kLargest);
        }
    }
    if (odd == 0) return;
    for (int i = 0; i < kVoxels; ++i) {
        errors[i] = errorOf(valueAt(a, i, wide), valueAt(b, i, wide));
    }
}

// Keeps eight maxima in parallel, like addUp.
double largestOf(const Errors& errors) {
    std::array<double, 8> largest{};
    for (int i = 0; i < kVoxels; i += 8) {
        for (int lane = 0; lane < 8; ++lane) {
            largest[lane] = largest[lane] < errors[i + lane] ? errors[i + lane] : largest[lane];
        }
    }
    return *std::max_element(largest.begin(), largest.end());
}

// Adds errors and their squares, as eight parallel sums.
void addUp(const Errors& errors, double max, ErrorSums& sums) {
    // An exact scale by a power of two keeps squares in a double's range.
    const int exponent = std::max(std::ilogb(max), -1000);
    const double scale = std::ldexp(1.0, -exponent);
    std::array<double, 8> sum{};
    std::array<double, 8> squares{};
    for (int i = 0; i < kVoxels; i += 8) {
        for (int lane = 0; lane < 8; ++lane) {
            const double error = errors[i + lane] * scale;
            sum[lane] += error;
            squares[lane] += error * error;
        }
    }
    double wholeSum = 0;
    double wholeSquares = 0;
    for (int lane = 0; lane < 8; ++lane) {
        wholeSum += sum[lane];
        wholeSquares += squares[lane];
    }
    sums.sum += std::ldexp(static_cast<long double>(wholeSum), exponent);
    sums.sumOfSquares += std::ldexp(static_cast<long double>(wholeSquares), 2 * exponent);
}

std::uint64_t countOver(const Errors& errors, double threshold) {
    int count = 0;
    for (int i = 0; i < kVoxels; ++i) count += errors[i] > threshold;
    return std::uint64_t(count);
}

// Returns the leaf offset of the first voxel, in z, y, x order, with this error.
int firstWith(const Errors& errors, double error) {
    for (int n = 0; n < kVoxels; ++n) {
        const int i = (n & 7) * 64 + (n & 56) + (n >> 6);
        if (errors[i] == error) return i;
    }
    return 0;
}

double errorOf(const WideValue& a, const WideValue& b) {
    const double error = std::fabs((a.high - b.high) + (a.low - b.low));
    if (error <= kLargest) return error;
    const bool same = a == b || (std::isnan(a.high) && std::isnan(b.high));
    return same ? 0 : kLargest;
}

void ErrorSums::addMax(double error, const Coord& at, const WideValue& a, const WideValue& b) {
    if (error < max || error == 0 || (error == max && !GridScan::isBefore(at, maxAt))) return;
    max = error;
    maxAt = at;
    maxA = a;
    maxB = b;
}

void ErrorSums::addTile(const Sample& a, const Sample& b, const Coord& first, std::uint64_t count,
                        const ErrorTerms& terms) {
    if (!isCompared(a, b, terms)) return;
    voxels += count;
    if (a.active != b.active) activeMismatch += count;
    const double error = errorOf(a.value, b.value);
    if (error == 0) return;
    if (error > terms.fail) overFail += count;
    if (error > terms.warn) overWarn += count;
    const long double wideError = error;
    sum += wideError * static_cast<long double>(count);
    sumOfSquares += wideError * wideError * static_cast<long double>(count);
    addMax(error, first, a.value, b.value);
}

void ErrorSums::addBlock(const BlockSamples& a, const BlockSamples& b, const Coord& origin,
                         const ErrorTerms& terms) {
    for (int word = 0; word < 8; ++word) {
        activeMismatch += std::uint64_t(std::popcount(a.active[word] ^ b.active[word]));
    }
    const bool allActive = areAllActive(a, b);
    const bool same = areSame(a.high, b.high) && (!terms.wide || areSame(a.low, b.low));
    alignas(64) Errors errors;
    if (!same) findErrors(a, b, terms.wide, errors);

    // Voxels that are background in both volumes are not compared.
    int compared = kVoxels;
    for (int i = 0; i < kVoxels && !allActive; ++i) {
        if (isCompared(sampleAt(a, i, terms.wide), sampleAt(b, i, terms.wide), terms)) continue;
        --compared;
        errors[i] = 0;
    }
    voxels += std::uint64_t(compared);
    if (same) return;

    const double blockMax = largestOf(errors);
    if (blockMax == 0) return;
    overFail += countOver(errors, terms.fail);
    overWarn += countOver(errors, terms.warn);
    addUp(errors, blockMax, *this);
    if (blockMax < max) return;
    const int i = firstWith(errors, blockMax);
    addMax(blockMax, origin.offsetBy(i >> 6, i >> 3 & 7, i & 7), valueAt(a, i, terms.wide),
           valueAt(b, i, terms.wide));
}

void ErrorSums::append(const ErrorSums& other) {
    voxels += other.voxels;
    overFail += other.overFail;
    overWarn += other.overWarn;
    activeMismatch += other.activeMismatch;
    sum += other.sum;
    sumOfSquares += other.sumOfSquares;
    addMax(other.max, other.maxAt, other.maxA, other.maxB);
}

/// Adds up the errors of all voxels, in an order that depends on the volumes only.
ErrorSums compareTrees(const VoxelSource& a, const VoxelSource& b, const ErrorTerms& terms,
                       const Listener& listener);

namespace {

using openvdb::Coord;

// Edges of the regions of a root entry and of the two node levels below.
constexpr int kRegion = 4096;
constexpr int kTile = 128;
constexpr int kBlock = 8;

constexpr std::uint64_t cube(int edge) {
    return std::uint64_t(edge) * std::uint64_t(edge) * std::uint64_t(edge);
}

class ReaderPair {
  public:
    ReaderPair(const VoxelSource& a, const VoxelSource& b, const ErrorTerms& terms)
        : a_(a.makeReader()), b_(b.makeReader()), terms_(terms) {}

    // Adds a region if both volumes are uniform in it, i.e. have nodes of at most this depth there.
    bool addIfUniform(const Coord& first, int depth, int edge, ErrorSums& sums) {
        if (a_->depthAt(first) > depth || b_->depthAt(first) > depth) return false;
        sums.addTile(a_->sampleAt(first), b_->sampleAt(first), first, cube(edge), terms_);
        return true;
    }

    void addBlock(const Coord& origin, ErrorSums& sums) {
        const bool leafA = a_->readLeaf(origin, blockA_);
        const bool leafB = b_->readLeaf(origin, blockB_);
        if (!leafA && !leafB) {
            sums.addTile(a_->sampleAt(origin), b_->sampleAt(origin), origin, cube(kBlock), terms_);
            return;
        }
        if (!leafA) blockA_.fill(a_->sampleAt(origin), terms_.wide);
        if (!leafB) blockB_.fill(b_->sampleAt(origin), terms_.wide);
        sums.addBlock(blockA_, blockB_, origin, terms_);
    }

  private:
    std::unique_ptr<VoxelReader> a_;
    std::unique_ptr<VoxelReader> b_;
    const ErrorTerms& terms_;
    BlockSamples blockA_;
    BlockSamples blockB_;
};

// Calls visit(first) for each cube of an edge length in the box at `origin`, in memory order.
template <typename Visit>
void forEachCube(const Coord& origin, const Coord& size, int edge, const Visit& visit) {
    for (int x = 0; x < size.x(); x += edge) {
        for (int y = 0; y < size.y(); y += edge) {
            for (int z = 0; z < size.z(); z += edge) visit(origin.offsetBy(x, y, z));
        }
    }
}

std::vector<Coord> regionsOf(const VoxelSource& a, const VoxelSource& b) {
    std::vector<Coord> regions = a.regions();
    regions.insert(regions.end(), b.regions().begin(), b.regions().end());
    std::sort(regions.begin(), regions.end());
    regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
    return regions;
}

// Pieces of 8x128x128 voxels, one layer of a node's blocks: enough work for one thread.
const Coord kPiece{kBlock, kTile, kTile};

// Adds large uniform regions; returns the first voxels of all other pieces.
std::vector<Coord> addLargeTiles(const VoxelSource& a, const VoxelSource& b, ReaderPair& readers,
                                 ErrorSums& sums) {
    std::vector<Coord> pieces;
    for (const Coord& region : regionsOf(a, b)) {
        if (readers.addIfUniform(region, 0, kRegion, sums)) continue;
        forEachCube(region, Coord(kRegion), kTile, [&](const Coord& tile) {
            if (readers.addIfUniform(tile, 1, kTile, sums)) return;
            for (int x = 0; x < kTile; x += kBlock) pieces.push_back(tile.offsetBy(x, 0, 0));
        });
    }
    return pieces;
}

}  // namespace

ErrorSums compareTrees(const VoxelSource& a, const VoxelSource& b, const ErrorTerms& terms,
                       const Listener& listener) {
    ErrorSums whole;
    ReaderPair readers(a, b, terms);
    const std::vector<Coord> pieces = addLargeTiles(a, b, readers, whole);

    // Batches limit the sums in memory and let the listener report.
    constexpr std::size_t kBatch = 512;
    for (std::size_t begin = 0; begin < pieces.size(); begin += kBatch) {
        listener.report(double(begin) / double(pieces.size()));
        std::vector<ErrorSums> sums(std::min(kBatch, pieces.size() - begin));
        parallelFor(sums.size(), [&](std::size_t i) {
            ReaderPair own(a, b, terms);
            forEachCube(pieces[begin + i], kPiece, kBlock,
                        [&](const Coord& block) { own.addBlock(block, sums[i]); });
        });
        for (const ErrorSums& part : sums) whole.append(part);
    }
    listener.report(1);
    return whole;
}

// Returns the other's length units per unit of `volume`; 1 if a unit is unknown.
double unitFactor(const Volume& other, const Volume& volume) {
    if (other.lengthUnit() == volume.lengthUnit()) return 1;
    const double from = millimetresIn(volume.lengthUnit()), to = millimetresIn(other.lengthUnit());
    return from > 0 && to > 0 ? from / to : 1;
}

// Converts patient coordinates, where signs of x and y differ, and lengths to the other's unit.
glm::dmat4 inSpaceOf(const Volume& other, const Volume& volume) {
    const bool turned =
        !volume.space().empty() && !other.space().empty() && volume.space() != other.space();
    const double unit = unitFactor(other, volume);
    if (!turned && unit == 1) return volume.worldFromIndex();
    glm::dmat4 turn(1.0);
    turn[0][0] = turn[1][1] = turned ? -unit : unit;
    turn[2][2] = unit;
    return turn * volume.worldFromIndex();
}

IndexBox movedBox(const IndexBox& box, const glm::ivec3& offset) {
    return box.empty() ? box : IndexBox{box.min + offset, box.max + offset};
}

// Distances between B's voxels and A's at indices `offset` higher.
struct Places {
    glm::ivec3 offset{0};
    double shift = 0;     // as VolumeComparison
    bool asHeld = false;  // within the precision of the coarser format
};

// Returns a voxel's error in place if each matrix element is off by half a unit in its last digit.
glm::dvec3 roundingAt(const glm::dmat4& worldFromIndex, int digits, const glm::dvec4& index) {
    constexpr int kLeastExponent = std::numeric_limits<float>::min_exponent - 1;
    glm::dvec3 rounding(0);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            const int exponent = std::max(std::ilogb(worldFromIndex[column][row]), kLeastExponent);
            rounding[row] += std::ldexp(std::abs(index[column]), exponent - digits);
        }
    }
    return rounding;
}

// The map between the places is affine, so a corner moves farthest.
// @param digits  precision of A's and B's numbers
Places placesAt(const Volume& a, const Volume& b, const glm::ivec3& offset, glm::ivec2 digits) {
    const glm::dmat4 placeB = inSpaceOf(a, b);
    const glm::dmat4 moved = placeB - glm::translate(a.worldFromIndex(), glm::dvec3(offset));
    IndexBox box = boxOfBoth(movedBox(a.box(), -offset), b.box());
    // Without voxels, compares where the first ones would be.
    if (box.empty()) box = {glm::ivec3(0), glm::ivec3(1)};
    double farthest = 0;
    bool asHeld = true;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 indexB(cornerOf(box, corner), 1);
        const glm::dvec4 indexA = indexB + glm::dvec4(offset, 0);
        const glm::dvec3 way(moved * indexB);
        farthest = std::max(farthest, glm::length(way));
        // Computations here and in the writer add a few roundings.
        constexpr int kComputed = std::numeric_limits<double>::digits - 3;
        const glm::dvec3 held =
            glm::max(roundingAt(a.worldFromIndex(), digits.x, indexA),
                     roundingAt(placeB, digits.y, indexB)) +
            roundingAt(a.worldFromIndex(), kComputed, glm::abs(indexA) + glm::abs(indexB));
        asHeld = asHeld && glm::all(glm::lessThanEqual(glm::abs(way), held));
    }
    const double voxel = std::min(smallestSize(a), unitFactor(a, b) * smallestSize(b));
    return {offset, std::min(farthest / voxel, std::numeric_limits<double>::max()), asHeld};
}

// Returns candidate offsets: none; the nearest whole number of voxels between both voxels (0,0,0);
// and between the first voxels of equally large boxes, right even for imprecise transforms.
std::vector<glm::ivec3> offsetsOf(const Volume& a, const Volume& b) {
    std::vector<glm::ivec3> offsets{glm::ivec3(0)};
    const auto add = [&](const glm::dvec3& offset) {
        constexpr double kMost = 0x1p29;
        if (std::max({std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)}) <= kMost)
            offsets.emplace_back(offset);
    };
    const glm::dvec3 way(inSpaceOf(a, b)[3] - a.worldFromIndex()[3]);
    add(glm::round(glm::inverse(glm::dmat3(a.worldFromIndex())) * way));
    if (!a.box().empty() && a.box().dims() == b.box().dims())
        add(glm::dvec3(a.box().min) - glm::dvec3(b.box().min));
    return offsets;
}

// Chooses the first offset with equal places; else one within format precision; else the smallest
// shift below half a voxel; else none.
Places choosePlaces(const Volume& a, const Volume& b, const CompareOptions& options) {
    std::vector<Places> places;
    const glm::ivec2 digits(options.placeDigitsA, options.placeDigitsB);
    for (const glm::ivec3& offset : offsetsOf(a, b))
        places.push_back(placesAt(a, b, offset, digits));
    const auto isEqual = [&](const Places& one) { return one.shift <= options.shift; };
    const auto equal = std::find_if(places.begin(), places.end(), isEqual);
    if (equal != places.end()) return *equal;
    const auto held =
        std::find_if(places.rbegin(), places.rend(), [](const Places& one) { return one.asHeld; });
    if (held != places.rend()) return *held;
    const auto least = std::min_element(
        places.begin(), places.end(),
        [](const Places& one, const Places& other) { return one.shift < other.shift; });
    return least->shift < 0.5 ? *least : places.front();
}

void takePlaces(const Volume& a, const Volume& b, const CompareOptions& options,
                VolumeComparison& result) {
    const Places places = choosePlaces(a, b, options);
    result.offset = places.offset;
    result.shift = places.shift;
    result.transformEqual = places.asHeld || places.shift <= options.shift;
    result.sizeEqual =
        a.hasBackground() || b.hasBackground() || a.box() == movedBox(b.box(), result.offset);
}

void takeSums(const ErrorSums& sums, VolumeComparison& result) {
    result.voxels = sums.voxels;
    if (sums.voxels > 0) {
        // Rounding must not make a mean exceed the maximum.
        const long double count = static_cast<long double>(sums.voxels);
        result.meanError = std::min(double(sums.sum / count), sums.max);
        result.rmsError = std::min(double(std::sqrt(sums.sumOfSquares / count)), sums.max);
    }
    result.maxError = sums.max;
    result.maxAt = {sums.maxAt.x(), sums.maxAt.y(), sums.maxAt.z()};
    result.valueA = sums.maxA.rounded();
    result.valueB = sums.maxB.rounded();
    result.valueTextA = sums.maxA.text();
    result.valueTextB = sums.maxB.text();
    result.overFail = sums.overFail;
    result.overWarn = sums.overWarn;
    result.activeMismatch = sums.activeMismatch;
}

}  // namespace

VolumeComparison compareVolumes(const Volume& a, const Volume& b, const CompareOptions& options,
                                const Listener& listener) {
    const DefaultFloats floats;
    const bool wide = holdsInt64(a) || holdsInt64(b);
    // A dense volume has no background and takes the other's.
    const WideValue backgroundA = backgroundOf(a.hasBackground() ? a : b, wide);
    const WideValue backgroundB = backgroundOf(b.hasBackground() ? b : a, wide);
    const ErrorTerms terms{backgroundA, backgroundB, options.fail, options.warn, wide};

    VolumeComparison result;
    takePlaces(a, b, options, result);
    const openvdb::Coord offset(result.offset.x, result.offset.y, result.offset.z);
    takeSums(compareTrees({a, wide, backgroundA}, {b, wide, backgroundB, offset}, terms, listener),
             result);
    result.backgroundError = errorOf(backgroundA, backgroundB);
    result.typeEqual = a.type() == b.type();
    result.classEqual = a.gridClass() == b.gridClass();
    result.nameEqual = a.name() == b.name();
    return result;
}

}  // namespace deltasplat
