// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/read_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "base/default_floats.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/value_statistics.h"
#include "ingest/dense/dense_source.h"
#include "ingest/dicom/dicom_sniff.h"
#include "ingest/input_files.h"
#include "ingest/input_kind.h"
#include "ingest/nifti/read_nifti.h"
#include "ingest/raw/read_npy.h"
#include "ingest/read_compared.h"
#include "ingest/readers.h"

namespace deltasplat {

DenseSource openDense(const std::filesystem::path& input, const InputKind& kind,
                      const ReadOptions& options, const Listener& listener) {
    switch (kind.format) {
        case InputKind::Format::kNifti:
            return openNifti(input, options, listener);
        case InputKind::Format::kNpy:
            return openNpy(input, options);
        case InputKind::Format::kNrrd:
            return openNrrd(input, options, listener);
        case InputKind::Format::kMetaImage:
            return openMetaImage(input, options, listener);
        case InputKind::Format::kDicom:
            return openDicom(input, kind.name,
                             chooseSeries(input, findSeries(input, kind.files), options.series));
        case InputKind::Format::kImages:
            return openImages(input, kind.name, kind.files, options, listener);
        default:
            return openRaw(input, options.raw);
    }
}

namespace {

void read(const std::filesystem::path& file, const ReadOptions& options, bool all,
          const VolumeVisitor& visitor, const Listener& listener,
          decltype(&readDense) readValues = &readDense) {
    const DefaultFloats floats;
    requireFiniteNan(options);
    const InputKind kind = findInput(file, listener);
    if (inputsAreConfined()) requireConfined(file);
    if (kind.format == InputKind::Format::kVdb) {
        readVdb(file, options, all, visitor, listener);
    } else {
        Volume volume = readValues(openDense(file, kind, options, listener), options, listener);
        if (visitor.volume) visitor.volume(std::move(volume));
    }
    listener.report(1);
}

std::vector<Volume> collect(const std::filesystem::path& file, const ReadOptions& options, bool all,
                            const Listener& listener,
                            decltype(&readDense) readValues = &readDense) {
    std::vector<Volume> volumes;
    VolumeVisitor visitor;
    visitor.volume = [&](Volume volume) { volumes.push_back(std::move(volume)); };
    read(file, options, all, visitor, listener, readValues);
    return volumes;
}

}  // namespace

Volume readVolume(const std::filesystem::path& file, const ReadOptions& options,
                  const Listener& listener) {
    return std::move(collect(file, options, false, listener).front());
}

Volume readCompared(const std::filesystem::path& file, const ReadOptions& options,
                    const Listener& listener) {
    return std::move(collect(file, options, false, listener, &readDenseUnsigned).front());
}

int placeDigitsOf(const std::filesystem::path& file) {
    if (findInput(file, {}).format != InputKind::Format::kNifti)
        return std::numeric_limits<double>::digits;
    return readNiftiHeader(file, {}).placeDigits;
}

std::vector<Volume> readAllVolumes(const std::filesystem::path& file, const ReadOptions& options,
                                   const Listener& listener) {
    return collect(file, options, true, listener);
}

void forEachVolume(const std::filesystem::path& file, const ReadOptions& options,
                   const VolumeVisitor& visitor, const Listener& listener) {
    read(file, options, true, visitor, listener);
}

void requireFiniteSpan(const std::string& where, double low, double high) {
    if (std::isfinite(high - low)) return;
    throw Error(ErrorCode::kInput,
                gotExpected(where, "values from " + numberText(low) + " to " + numberText(high),
                            "a range that a double can hold"));
}

void requireFiniteNan(const ReadOptions& options) {
    if (!options.nanValue || std::isfinite(*options.nanValue)) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("`nanValue`", numberText(*options.nanValue), "a finite number"));
}

void requireFloatNan(double nanValue) {
    if (std::abs(nanValue) <= double(std::numeric_limits<float>::max())) return;
    throw Error(ErrorCode::kUsage,
                gotExpected("`nanValue`", numberText(nanValue), "a value that is finite as float"));
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
