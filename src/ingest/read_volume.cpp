// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/read_volume.h"

#include <cmath>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/file_name.h"
#include "ingest/readers.h"

namespace deltasplat {
namespace {

std::vector<Volume> read(const std::filesystem::path& file, const ReadOptions& options, bool all,
                         const Listener& listener) {
    if (options.nanValue && !std::isfinite(*options.nanValue)) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("--nan", numberText(*options.nanValue), "a finite number"));
    }
    requireRegularFile(file);
    const std::string extension = lowerExtension(file);
    std::vector<Volume> volumes;
    if (extension == ".vdb") {
        volumes = readVdb(file, options, all, listener);
    } else if (extension == ".raw" || extension == ".raw.gz") {
        volumes.push_back(readRaw(file, options, listener));
    } else {
        throw Error(ErrorCode::kInput, gotExpected(file.string(), "extension \"" + extension + "\"",
                                                   ".raw, .raw.gz or .vdb"));
    }
    listener.report(1);
    return volumes;
}

}  // namespace

Volume readVolume(const std::filesystem::path& file, const ReadOptions& options,
                  const Listener& listener) {
    return std::move(read(file, options, false, listener).front());
}

std::vector<Volume> readAllVolumes(const std::filesystem::path& file, const ReadOptions& options,
                                   const Listener& listener) {
    return read(file, options, true, listener);
}

void requireFiniteSpan(const std::string& where, double low, double high) {
    if (std::isfinite(high - low)) return;
    throw Error(ErrorCode::kInput,
                gotExpected(where, "values from " + numberText(low) + " to " + numberText(high),
                            "a range that a double can hold"));
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
}

}  // namespace deltasplat
