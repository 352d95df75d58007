// SPDX-License-Identifier: Apache-2.0
#include "diff/error_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "volume/grid_values.h"

namespace deltasplat {
namespace {

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

// Without a branch inside, so that the compiler uses whole vectors.
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

// Eight largest ones side by side, as in addUp.
double largestOf(const Errors& errors) {
    std::array<double, 8> largest{};
    for (int i = 0; i < kVoxels; i += 8) {
        for (int lane = 0; lane < 8; ++lane) {
            largest[lane] = largest[lane] < errors[i + lane] ? errors[i + lane] : largest[lane];
        }
    }
    return *std::max_element(largest.begin(), largest.end());
}

// Adds errors and their squares, eight sums side by side.
void addUp(const Errors& errors, double max, ErrorSums& sums) {
    // Scaled by a power of two, which is exact, squares stay within the range of a double.
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

// Number, in the order of a leaf, of the first voxel in the order of z, y, x that has this error.
int firstWith(const Errors& errors, double error) {
    for (int n = 0; n < kVoxels; ++n) {
        const int i = (n & 7) * 64 + (n & 56) + (n >> 6);
        if (errors[i] == error) return i;
    }
    return 0;
}

}  // namespace

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

    // Voxels that are background in both volumes are no errors of these voxels.
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

}  // namespace deltasplat
