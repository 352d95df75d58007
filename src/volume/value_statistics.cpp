// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/value_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace deltasplat {

std::optional<double> guessBackground(const Volume& volume) {
    if (volume.hasBackground) return volume.background;
    if (volume.empty()) return std::nullopt;
    const FrequentValue most = volume.mostFrequent.value_or(mostFrequentCode(volume));
    if (double(most.count) < kBackgroundShare * double(volume.activeCount)) return std::nullopt;
    return most.value;
}

FrequentValue mostFrequentCode(const Volume& volume) {
    const auto most = std::max_element(volume.histogram.begin(), volume.histogram.end());
    return {volume.codeBook.valueOf(Code(most - volume.histogram.begin())), *most};
}

ValueHistogram histogramOfValues(const Volume& volume, int bins) {
    ValueHistogram result{volume.valueMin, volume.valueMax, {}};
    result.counts.assign(bins, 0);
    if (volume.codeBook.kind == CodeBook::Kind::kInteger) {
        const double values = volume.valueMax - volume.valueMin + 1;
        result.high = result.low + bins * std::ceil(values / bins);
    }
    const double width = (result.high - result.low) / bins;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] == 0) continue;
        const double value = volume.codeBook.valueOf(Code(code));
        // Codes may be a little outside of the values.
        const double bin = width > 0 ? std::max(0.0, (value - result.low) / width) : 0;
        result.counts[std::min(int(bin), bins - 1)] += volume.histogram[code];
    }
    return result;
}

Code percentileCode(std::span<const std::uint64_t> counts, int percent) {
    // In two parts, so that 2^62 voxels do not overflow.
    const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    const std::uint64_t wanted = total / 100 * percent + (total % 100 * percent + 99) / 100;
    const std::uint64_t rank = std::max<std::uint64_t>(1, wanted);
    std::uint64_t seen = 0;
    std::size_t code = 0;
    while (code < counts.size() && (seen += counts[code]) < rank) ++code;
    return code < counts.size() ? Code(code) : Code{0};
}

double percentileValue(const Volume& volume, int percent) {
    if (volume.empty()) return volume.background;
    // A code may be a little beyond all values that it stands for.
    const double value = volume.codeBook.valueOf(percentileCode(volume.histogram, percent));
    return std::clamp(value, volume.valueMin, volume.valueMax);
}

}  // namespace deltasplat
