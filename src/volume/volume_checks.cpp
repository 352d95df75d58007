// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_checks.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/value_statistics.h"

namespace deltasplat {

void requireFiniteSpan(const std::string& where, double low, double high) {
    if (std::isfinite(high - low)) return;
    throw Error(ErrorCode::kInput, where,
                "values from " + numberText(low) + " to " + numberText(high),
                "a range that a double can hold");
}

void requireFiniteNan(const ReadOptions& options) {
    if (!options.nanValue || std::isfinite(*options.nanValue)) return;
    throw Error(ErrorCode::kUsage, "`nanValue`", numberText(*options.nanValue), "a finite number");
}

void requireFloatNan(double nanValue) {
    if (std::abs(nanValue) <= double(std::numeric_limits<float>::max())) return;
    throw Error(ErrorCode::kUsage, "`nanValue`", numberText(nanValue),
                "a value that is finite as float");
}

void summarize(Volume& volume) {
    volume.activeCount = 0;
    volume.valueMin = volume.valueMax = 0;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] == 0) continue;
        const double value = volume.codeBook.valueOf(Code(code));
        if (volume.activeCount == 0) volume.valueMin = value;
        volume.valueMax = value;
        volume.activeCount += volume.histogram[code];
    }
    volume.mostFrequent.reset();
    if (volume.activeCount > 0) volume.mostFrequent = mostFrequentCode(volume);
}

void warnOfCodeError(const std::string& where, const Volume& volume, const ReadOptions& options,
                     const Listener& listener) {
    constexpr double kWorthSaying = 1e-3;
    // Who keeps the source has its values.
    if (options.keepSource && !options.bits) return;
    if (!(volume.codeError.relative > kWorthSaying)) return;
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.3g", 100 * volume.codeError.relative);
    listener.warn(where + ": values are kept as codes that are off by up to " +
                  numberText(volume.codeError.absolute) + ", or " + std::string(percent) +
                  " % of a value (" + volume.codeBook.name() + " code book)");
}

}  // namespace deltasplat
