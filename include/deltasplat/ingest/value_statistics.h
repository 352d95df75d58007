// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// The share of the active voxels from which on the most frequent value is taken for the
/// background. Found on scanned and simulated volumes: backgrounds hold from 22 % on, the most
/// frequent code of a region without one up to 18 %.
inline constexpr double kBackgroundShare = 0.2;

/// Returns the value that stands for "nothing here": the background of a volume that has one;
/// otherwise the source's most frequent value (of several the smallest) if at least
/// `kBackgroundShare` of the active voxels have it; otherwise none.
std::optional<double> guessBackground(const Volume& volume);

/// Returns the value of the code that most active voxels have, of several the smallest, of a volume
/// that is not empty.
FrequentValue mostFrequentCode(const Volume& volume);

/// How many active voxels have values in each of several bins of one width,
/// (high - low) / counts.size(): a bin holds its lower edge, the last one its upper edge too.
struct ValueHistogram {
    double low = 0;   ///< lower edge of the first bin: the smallest active value
    double high = 0;  ///< upper edge of the last bin
    std::vector<std::uint64_t> counts;
};

/// Sorts the active values into `bins` >= 1 bins. For values of an integer code book bins are a
/// whole number wide, so that all hold equally many values, and the last ones may lie beyond the
/// largest value; otherwise they span the values. A volume of one value that is no integer has it
/// in the first bin, and low = high.
ValueHistogram histogramOfValues(const Volume& volume, int bins);

/// Returns the smallest code up to which at least `percent` % (0..100) of the counted voxels, and
/// at least one, lie; 0 if none are counted.
/// @param counts  [at most kCodeCount] how often each code occurs
Code percentileCode(std::span<const std::uint64_t> counts, int percent);

/// Returns the smallest value up to which at least `percent` % (0..100) of the active voxels lie;
/// the background of an empty volume.
double percentileValue(const Volume& volume, int percent);

}  // namespace deltasplat
