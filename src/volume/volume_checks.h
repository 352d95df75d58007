// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Returns the volume that a file holds.
/// @throw Error(kInput) "<where>: got ...; expected ..." if a condition of Volume does not hold
Volume volumeOfFile(const std::string& where, VolumeData data);

/// @throw Error(kInput) if `high - low` is not finite, because no code book spans such a range
void requireFiniteSpan(const std::string& where, double low, double high);

/// @throw Error(kUsage) if the replacement for NaN is not finite itself
void requireFiniteNan(const ReadOptions& options);

/// @throw Error(kUsage) if `nanValue`, a replacement, is not finite as float
void requireFloatNan(double nanValue);

/// Sets activeCount, valueMin, valueMax and mostFrequent from the histogram and the code book. With
/// an exact book these are the source's own.
void summarize(VolumeData& volume);

/// Returns the value of the code with the most voxels, and its count.
FrequentValue mostFrequentCode(const VolumeData& volume);

/// Warns if codes are so inexact that a picture may show it.
void warnOfCodeError(const std::string& where, const VolumeData& volume, const ReadOptions& options,
                     const Listener& listener);

}  // namespace deltasplat
