// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Share of the active voxels from which the most frequent value counts as the background. From
/// scanned and simulated volumes: backgrounds hold at least 22 %, the most frequent code of a
/// region without background at most 18 %.
inline constexpr double kBackgroundShare = 0.2;

/// Returns the value for "nothing here": the background if the volume has one; otherwise the
/// source's most frequent value (of several the smallest) if at least `kBackgroundShare` of the
/// active voxels have it; otherwise none.
std::optional<double> guessBackground(const Volume& volume);

/// Returns the most frequent code's value (of several the smallest); not for empty volumes.
FrequentValue mostFrequentCode(const Volume& volume);

/// Active voxels per bin of equal width (high - low) / counts.size(). A bin holds its lower edge,
/// the last one its upper edge too.
struct ValueHistogram {
    double low = 0;   ///< lower edge of the first bin: the smallest active value
    double high = 0;  ///< upper edge of the last bin
    std::vector<std::uint64_t> counts;
};

/// Sorts the active values into `bins` >= 1 bins. Bins of an integer code book are a whole number
/// wide, so all hold equally many values and the last may lie beyond the largest value; otherwise
/// bins span the values. A single value that is no integer is in the first bin, with low = high.
ValueHistogram histogramOfValues(const Volume& volume, int bins);

/// Returns the smallest code that at least `percent` % (0..100) of the counted voxels, and at least
/// one, do not exceed; 0 if none are counted.
/// @param counts  [at most kCodeCount] how often each code occurs
Code percentileCode(std::span<const std::uint64_t> counts, int percent);

/// Returns the smallest value that at least `percent` % (0..100) of the active voxels do not
/// exceed; the background of an empty volume.
double percentileValue(const Volume& volume, int percent);

}  // namespace deltasplat
