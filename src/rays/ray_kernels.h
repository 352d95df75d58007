// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Turns codes into values.
struct CodeValues {
    const float* table = nullptr;  ///< [kCodeCount]
    float offset = 0;              ///< value = code + offset, if `direct`
    bool direct = false;           ///< exact, and faster than the table
};

/// Where the values of an 8x8x8 block go: [slice][u][v], eight values along v side by side.
struct BlockPlace {
    float* first;
    std::size_t sliceStep;
    std::size_t rowStep;
};

/// Reads the 512 codes of a leaf (x slowest, z fastest) as values, in (slice, u, v) order.
void readBlockValues(const Code* codes, int sliceAxis, const CodeValues& values,
                     const BlockPlace& place);

/// A run of pixels along a row of the base plane, and where it reads a slice. The number of pixels
/// is a multiple of 8; the slice is read one pixel further.
struct RaySpan {
    const float* row;      ///< the slice at the run's first pixel
    const float* nextRow;  ///< the slice one row further
    float* plane;          ///< the base plane at the run's first pixel
    float* rest;           ///< likewise, how much the plane is too large; only for sums
    std::size_t pixels;
    const std::uint8_t* mask;  ///< bit i: pixel i is met by a voxel; null: all are
    /// Which slice the base plane's values are from, likewise; null: nobody asks. Only for maxima.
    float* places = nullptr;
};

/// A slice that largest values may come from.
struct SliceMark {
    float number = 0;
    bool isNearer = false;  ///< than those before: of equal values its own is the one that is seen
};

/// Reads a slice bilinearly, `fraction` behind its pixels, and adds what it reads to the base
/// plane; what rounding adds to that is kept in `rest` and taken off with the next slice, so that
/// many slices are as exact as one. Multiplications and additions are separate and per pixel, so
/// that every SIMD level gives the same bits. Where neighbours are equal, exactly their value is
/// read. Masks are not looked at.
void sumSpans(const std::vector<RaySpan>& spans, glm::vec2 fraction);

/// The same, but the base plane keeps the larger of what it has and, where pixels are met, what is
/// read.
/// @param skipsNaN  where spans have masks, NaN stands for what is not active: read is the mean of
///                  the others, by their weights; of equal ones exactly their value
void maxSpans(const std::vector<RaySpan>& spans, glm::vec2 fraction,
              const SliceMark& slice = SliceMark(), bool skipsNaN = false);

/// Weighs a row's neighbourhood: out[x] = sum over j, i of weights[j * width + i] * rows[j][x - i],
/// taps in this order, times `scale`.
/// @param rows  [width]: each may be read from -(width - 1) to pixels - 1
void weighRow(const float* const* rows, const float* weights, int width, float scale,
              std::size_t pixels, float* out);

}  // namespace deltasplat
