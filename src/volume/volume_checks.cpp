// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_checks.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/ingest/value_statistics.h"
#include "volume/code_tree.h"
#include "volume/placement.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

// Throws what is wrong with parts of a volume: for a file, that is bad input.
void requireSound(const VolumeData& data, const std::string& where, ErrorCode code) {
    const auto refuseVolume = [&](const std::string& got, const std::string& expected) {
        throw Error(code, where, got, expected);
    };
    const std::size_t counts = data.histogram.size();
    if (counts != 0 && counts != std::size_t(kCodeCount)) {
        refuseVolume("a histogram of " + std::to_string(counts) + " numbers",
                     std::to_string(kCodeCount) + ", or none");
    }
    if (!(data.valueMin <= data.valueMax) || !std::isfinite(data.valueMin) ||
        !std::isfinite(data.valueMax)) {
        refuseVolume(
            "values from " + numberText(data.valueMin) + " to " + numberText(data.valueMax),
            "a range of finite numbers");
    }
    if (!data.empty() && data.box.empty()) refuseVolume("active voxels in no box", "their box");
    if (!givesPlaces(data.worldFromIndex))
        refuseVolume("a transform that gives no place to voxels", "one that can be inverted");
    if (!data.lengthUnit.empty() && millimetresIn(data.lengthUnit) == 0)
        refuseVolume("the unit of length \"" + printable(data.lengthUnit) + "\"", "mm, m, in, ...");
    if (!data.space.empty() && data.space != "RAS" && data.space != "LPS")
        refuseVolume("the space \"" + printable(data.space) + "\"", "RAS, LPS or none");
}

// Shared by all volumes without voxels.
std::shared_ptr<const VolumeData> nothing() {
    static const auto data = std::make_shared<const VolumeData>();
    return data;
}

}  // namespace

Volume::Volume() : data_(nothing()) {}

Volume::Volume(VolumeData data) {
    requireSound(data, "volume", ErrorCode::kUsage);
    data_ = std::make_shared<const VolumeData>(std::move(data));
}

Volume Volume::withName(std::string name) const {
    VolumeData data = *data_;
    data.name = std::move(name);
    return Volume(std::move(data));
}

Volume Volume::withPlace(const glm::dmat4& worldFromIndex, std::string space,
                         std::string lengthUnit) const {
    const bool isSame = worldFromIndex == data_->worldFromIndex && space == data_->space &&
                        lengthUnit == data_->lengthUnit;
    if (isSame) return *this;
    VolumeData data = *data_;
    data.worldFromIndex = worldFromIndex;
    data.space = std::move(space);
    data.lengthUnit = std::move(lengthUnit);
    return Volume(std::move(data));
}

Volume Volume::withLabels(std::shared_ptr<const LabelList> labels) const {
    VolumeData data = *data_;
    data.labels = std::move(labels);
    return Volume(std::move(data));
}

Volume Volume::withoutCodes() const {
    VolumeData data = *data_;
    data.codes.reset();
    data.uncut.reset();
    return Volume(std::move(data));
}

Volume Volume::withoutVoxels() const {
    VolumeData data = *data_;
    data.codes.reset();
    data.uncut.reset();
    data.source.reset();
    return Volume(std::move(data));
}

Volume volumeOfFile(const std::string& where, VolumeData data) {
    requireSound(data, where, ErrorCode::kInput);
    return Volume(std::move(data));
}

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

void summarize(VolumeData& volume) {
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

void warnOfCodeError(const std::string& where, const VolumeData& volume, const ReadOptions& options,
                     const Listener& listener) {
    constexpr double kWorthSaying = 1e-3;
    // A caller who keeps the source has the exact values.
    if (options.keepSource && !options.bits) return;
    if (!(volume.codeError.relative > kWorthSaying)) return;
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.3g", 100 * volume.codeError.relative);
    listener.warn(where + ": values are kept as codes that are off by up to " +
                  numberText(volume.codeError.absolute) + ", or " + std::string(percent) +
                  " % of a value (" + volume.codeBook.name() + " code book)");
}

namespace {

// @param valueOf  value of a stored active voxel
template <typename Tree, typename ValueOf>
void readTree(const Tree& tree, const Volume& volume, const IndexBox& box, const ValueOf& valueOf,
              std::span<double> values, std::span<std::uint8_t> active) {
    const glm::ivec3 dims = box.dims();
    const double background = volume.hasBackground() ? volume.background() : 0;
    const auto rows = std::size_t(dims.y) * std::size_t(dims.z);
    parallelForChunks(rows, [&](std::size_t begin, std::size_t end) {
        openvdb::tree::ValueAccessor<const Tree> accessor(tree);
        for (std::size_t row = begin; row < end; ++row) {
            const int y = box.min.y + int(row % std::size_t(dims.y));
            const int z = box.min.z + int(row / std::size_t(dims.y));
            std::size_t place = row * std::size_t(dims.x);
            for (int x = 0; x < dims.x; ++x, ++place) {
                typename Tree::ValueType value;
                const bool isActive =
                    accessor.probeValue(openvdb::Coord(box.min.x + x, y, z), value);
                values[place] = isActive ? valueOf(value) : background;
                if (!active.empty()) active[place] = isActive ? 1 : 0;
            }
        }
    });
}

}  // namespace

void readVoxels(const Volume& volume, const IndexBox& box, std::span<double> values,
                std::span<std::uint8_t> active) {
    constexpr int kMost = (1 << 30) - 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (box.min[axis] >= -kMost && box.max[axis] <= kMost) continue;
        throw Error(
            ErrorCode::kUsage, "voxels to read",
            "a box from " + std::to_string(box.min[axis]) + " to " + std::to_string(box.max[axis]),
            "indices within 2^30 of 0");
    }
    const glm::dvec3 dims = box.dims();
    const double voxels = dims.x * dims.y * dims.z;
    const auto requireSize = [&](const char* what, std::size_t size) {
        if (double(size) == voxels) return;
        throw Error(ErrorCode::kUsage, std::string("voxels to read: ") + what,
                    std::to_string(size) + " values", numberText(voxels));
    };
    requireSize("values", values.size());
    if (!active.empty()) requireSize("active", active.size());
    if (voxels == 0) return;
    if (volume.source()) {
        const bool isScalar = volume.source()->grid.apply<ScalarTrees>([&](const auto& tree) {
            readTree(
                tree, volume, box, [](auto value) { return double(value); }, values, active);
        });
        if (!isScalar) {
            throw Error(ErrorCode::kUsage, "voxels to read", "type " + volume.source()->grid.type(),
                        "a scalar grid");
        }
    } else if (volume.codes()) {
        readTree(
            volume.codes()->tree(), volume, box,
            [&](Code code) { return volume.codeBook().valueOf(code); }, values, active);
    } else {
        throw Error(ErrorCode::kUsage, "voxels to read", "a volume without voxels",
                    "one that was read or made");
    }
}

std::optional<double> guessBackground(const Volume& volume) {
    if (volume.hasBackground()) return volume.background();
    if (volume.empty()) return std::nullopt;
    const FrequentValue most = volume.mostFrequent().value_or(mostFrequentCode(volume));
    if (double(most.count) < kBackgroundShare * double(volume.activeCount())) return std::nullopt;
    return most.value;
}

FrequentValue mostFrequentCode(const VolumeData& volume) {
    if (volume.histogram.empty()) return {volume.valueMin, 0};
    const auto most = std::max_element(volume.histogram.begin(), volume.histogram.end());
    return {volume.codeBook.valueOf(Code(most - volume.histogram.begin())), *most};
}

FrequentValue mostFrequentCode(const Volume& volume) {
    return mostFrequentCode(volume.data());
}

ValueHistogram histogramOfValues(const Volume& volume, int bins) {
    ValueHistogram result{volume.valueMin(), volume.valueMax(), {}};
    result.counts.assign(bins, 0);
    if (volume.codeBook().kind == CodeBook::Kind::kInteger) {
        const double values = volume.valueMax() - volume.valueMin() + 1;
        result.high = result.low + bins * std::ceil(values / bins);
    }
    const double width = (result.high - result.low) / bins;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] == 0) continue;
        const double value = volume.codeBook().valueOf(Code(code));
        // Codes may lie slightly outside of the values.
        const double bin = width > 0 ? std::max(0.0, (value - result.low) / width) : 0;
        result.counts[std::min(int(bin), bins - 1)] += volume.histogram()[code];
    }
    return result;
}

Code percentileCode(std::span<const std::uint64_t> counts, int percent) {
    // Split, so that 2^62 voxels do not overflow.
    const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    const std::uint64_t wanted = total / 100 * percent + (total % 100 * percent + 99) / 100;
    const std::uint64_t rank = std::max<std::uint64_t>(1, wanted);
    std::uint64_t seen = 0;
    std::size_t code = 0;
    while (code < counts.size() && (seen += counts[code]) < rank) ++code;
    return code < counts.size() ? Code(code) : Code{0};
}

double percentileValue(const Volume& volume, int percent) {
    if (volume.empty()) return volume.background();
    // A code may lie slightly beyond all of its values.
    const double value = volume.codeBook().valueOf(percentileCode(volume.histogram(), percent));
    return std::clamp(value, volume.valueMin(), volume.valueMax());
}

}  // namespace deltasplat
