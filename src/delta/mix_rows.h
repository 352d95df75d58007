// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>

#include "delta/mix_window.h"
#include "deltasplat/view/factorization.h"

namespace deltasplat {

/// Returns what lies between two values, or the first where there is no other; NaN where there is
/// none. Without a branch, so that several are mixed at once.
template <typename T>
inline T mixed(T here, T other, T share) {
    // Halves, so that no difference overflows.
    const T difference = T(0.5) * other - T(0.5) * here;
    const T step = difference * (T(2) * share);
    return here + (difference == difference ? step : T(0));
}

/// Makes a row of thin voxels of one of voxels and what lies before and behind it.
template <typename T>
inline void mixHalves(const T* row, T* thin) {
    for (int v = 0; v < 8; ++v) {
        thin[2 * v] = mixed(row[v + 1], row[v], T(0.25));
        thin[2 * v + 1] = mixed(row[v + 1], row[v + 2], T(0.25));
    }
}

/// Mixes the values of the thin voxels that those of a block become: calls use(part, place, values)
/// for rows along v of 8, where `part` is [along u][along slices][along v] and place 64 slice + 8
/// u.
/// @param values  as MixWindow::slots, NaN where there are none
template <typename T, typename Use>
void mixRows(const std::array<T, MixWindow::kSide * MixWindow::kPlane>& values,
             const Subdivision& parts, const Use& use) {
    constexpr int kSide = MixWindow::kSide;
    constexpr int kPlane = MixWindow::kPlane;
    std::array<T, kPlane> plane;
    std::array<T, kSide> row;
    std::array<T, 16> thin;
    for (int s = 0; s < 8 * parts.slices; ++s) {
        // How far from the voxels' middle, in halves of a thin slice.
        const int offset = 2 * (s % parts.slices) + 1 - parts.slices;
        const T* here = values.data() + (1 + s / parts.slices) * kPlane;
        const T* other = offset < 0 ? here - kPlane : here + kPlane;
        const T share = T(std::abs(offset)) / T(2 * parts.slices);
        for (int n = 0; n < kPlane; ++n) plane[n] = mixed(here[n], other[n], share);
        for (int u = 0; u < 8 * parts.within; ++u) {
            const int part = (u / 8 * parts.slices + s / 8) * parts.within;
            const int place = 64 * (s % 8) + 8 * (u % 8);
            const T* own = plane.data() + (1 + u / parts.within) * kSide;
            if (parts.within == 1) {
                use(part, place, own + 1);
                continue;
            }
            const T* beside = u % 2 == 0 ? own - kSide : own + kSide;
            for (int v = 0; v < kSide; ++v) row[v] = mixed(own[v], beside[v], T(0.25));
            mixHalves(row.data(), thin.data());
            use(part, place, thin.data());
            use(part + 1, place, thin.data() + 8);
        }
    }
}

}  // namespace deltasplat
