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
#include "formats/dense/dense_source.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"
#include "formats/nifti/read_nifti.h"
#include "formats/read_compared.h"
#include "formats/readers.h"

namespace deltasplat {

namespace {

void read(const std::filesystem::path& file, const ReadOptions& options, bool all,
          const VolumeVisitor& visitor, const Listener& listener,
          decltype(&readDense) readValues = &readDense) {
    const DefaultFloats floats;
    requireFiniteNan(options);
    const InputKind kind = findInput(file, listener);
    if (inputsAreConfined()) requireConfined(file);
    if (kind.is(vdbFormat())) {
        readVdb(file, options, all, visitor, listener);
    } else {
        Volume volume =
            readValues(kind.format->open(file, kind, options, listener), options, listener);
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
    if (!findInput(file, {}).is(niftiFormat())) return std::numeric_limits<double>::digits;
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

}  // namespace deltasplat
