// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// @throw Error(kInput) if `high - low` is no finite number: no code book spans it
void requireFiniteSpan(const std::string& where, double low, double high);

/// @throw Error(kUsage) if what is to replace NaN is no finite number itself
void requireFiniteNan(const ReadOptions& options);

/// @throw Error(kUsage) if `nanValue`, which is to replace a value, is no finite float
void requireFloatNan(double nanValue);

/// Sets activeCount, valueMin, valueMax and mostFrequent from the histogram and the code book: the
/// source's own if that is exact.
void summarize(Volume& volume);

/// Warns if values are kept so badly that a picture may show it.
void warnOfCodeError(const std::string& where, const Volume& volume, const ReadOptions& options,
                     const Listener& listener);

}  // namespace deltasplat
