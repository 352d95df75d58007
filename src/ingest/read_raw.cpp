// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>

#include "deltasplat/error.h"
#include "ingest/byte_source.h"
#include "ingest/code_tree_builder.h"
#include "ingest/file_name.h"
#include "ingest/raw_format.h"
#include "ingest/raw_values.h"
#include "ingest/readers.h"
#include "memory.h"

namespace deltasplat {
namespace {

constexpr int kLayerSlices = 8;

// A part of the whole work, as shares of 1, and whom to tell.
struct Progress {
    const Listener& listener;
    double begin;
    double end;
    void report(double share) const { listener.report(begin + (end - begin) * share); }
};

struct RawFile {
    const std::filesystem::path& path;
    const RawLayout& layout;
    bool gzip;

    glm::ivec3 dims() const { return glm::ivec3(layout.dims); }
    std::size_t rowBytes() const { return std::size_t(layout.dims.x) * rawTypeBytes(layout.type); }
    std::size_t sliceBytes() const { return rowBytes() * std::size_t(layout.dims.y); }
};

[[noreturn]] void throwSize(const RawFile& file, std::uint64_t bytes) {
    throw Error(ErrorCode::kInput,
                gotExpected(file.path.string(),
                            std::to_string(bytes) + (file.gzip ? " bytes unpacked" : " bytes"),
                            file.layout.expectedSize()));
}

// A plain file's size is known before anything is read; a gzip file's only at its end.
void checkPlainSize(const RawFile& file) {
    if (file.gzip) return;
    const std::uint64_t bytes = std::filesystem::file_size(file.path);
    if (bytes != file.layout.skipBytes + file.layout.dataBytes()) throwSize(file, bytes);
}

// Calls use(first slice, slices, bytes) for every layer of 8 slices from front to back.
void forEachLayer(const RawFile& file, const Progress& progress,
                  const std::function<void(int, int, const std::byte*)>& use) {
    ByteSource source(file.path, file.gzip);
    const auto beat = [&](double share) { return [&progress, share] { progress.report(share); }; };
    std::uint64_t done = source.skip(file.layout.skipBytes, beat(0));
    const int slices = file.dims().z;
    const std::size_t layerBytes = file.sliceBytes() * std::size_t(std::min(slices, kLayerSlices));
    const auto bytes = std::make_unique_for_overwrite<std::byte[]>(layerBytes);
    for (int first = 0; first < slices; first += kLayerSlices) {
        const int count = std::min(kLayerSlices, slices - first);
        const std::size_t wanted = file.sliceBytes() * std::size_t(count);
        const std::size_t got = source.read(bytes.get(), wanted);
        done += got;
        if (got != wanted) throwSize(file, done);
        use(first, count, bytes.get());
        progress.report(double(first + count) / slices);
    }

    // What follows the last voxel says that the dims are wrong: count it for the message.
    const std::uint64_t more = source.skip(std::numeric_limits<std::uint64_t>::max(), beat(1));
    if (more != 0) throwSize(file, done + more);
}

std::string placeText(const glm::i64vec3& dims, std::uint64_t position) {
    const auto width = std::uint64_t(dims.x);
    const auto height = std::uint64_t(dims.y);
    return "(" + std::to_string(position % width) + ", " +
           std::to_string(position / width % height) + ", " +
           std::to_string(position / width / height) + ")";
}

RawRange scan(const RawFile& file, const Progress& progress) {
    RawRange whole;
    forEachLayer(file, progress, [&](int, int slices, const std::byte* bytes) {
        const std::size_t count =
            std::size_t(file.layout.dims.x) * std::size_t(file.layout.dims.y) * std::size_t(slices);
        whole.append(scanRawValues(bytes, count, file.layout.type, file.layout.bigEndian));
    });
    return whole;
}

void settleNonFinite(const RawFile& file, RawRange& range, std::optional<double> nanValue) {
    if (range.nonFinite == 0) return;
    if (!nanValue) {
        throw Error(
            ErrorCode::kInput,
            gotExpected(file.path.string(),
                        std::to_string(range.nonFinite) + " NaN or infinite values, the first at " +
                            placeText(file.layout.dims, range.firstNonFinite),
                        "finite values (--nan VALUE replaces them)"));
    }
    if (file.layout.type == RawType::kFloat32) requireFloatNan(*nanValue);
    RawRange replaced;
    replaced.min = replaced.max = *nanValue;
    replaced.finite = range.nonFinite;
    range.append(replaced);
}

CodeBook bookOfRange(const RawFile& file, const RawRange& range) {
    const RawType type = file.layout.type;
    const bool whole = type == RawType::kUint32 || type == RawType::kInt32;
    if (whole && range.max - range.min < kCodeCount) {
        return CodeBook::integer(std::int64_t(range.min));
    }
    requireFiniteSpan(file.path.string(), range.min, range.max);
    return CodeBook::linear(range.min, range.max);
}

CodeBook chooseBook(const RawFile& file, std::optional<double> nanValue, const Progress& progress) {
    switch (file.layout.type) {
        case RawType::kUint8:
        case RawType::kUint16:
            return CodeBook::integer(0);
        case RawType::kInt8:
            return CodeBook::integer(std::numeric_limits<std::int8_t>::min());
        case RawType::kInt16:
            return CodeBook::integer(std::numeric_limits<std::int16_t>::min());
        default:
            break;
    }
    RawRange range = scan(file, progress);
    settleNonFinite(file, range, nanValue);
    return bookOfRange(file, range);
}

void readCodes(const RawFile& file, const RawCoding& coding, const Progress& progress,
               Volume& volume) {
    CodeTreeBuilder builder(file.dims());
    const EncodeBlock encode = blockEncoder(coding);
    const std::size_t valueBytes = std::size_t(rawTypeBytes(coding.type));
    forEachLayer(file, progress, [&](int first, int slices, const std::byte* bytes) {
        requireMemory(file.path.string(), builder.worstLayerBytes());
        builder.addLayer(first, [&](const glm::ivec2& corner, const glm::ivec2& size, Code* codes) {
            const std::size_t start =
                std::size_t(corner.y) * file.rowBytes() + std::size_t(corner.x) * valueBytes;
            encode({bytes + start, file.rowBytes(), file.sliceBytes(), glm::ivec3(size, slices)},
                   coding, codes);
        });
    });
    volume.histogram = builder.histogram();
    volume.codes = builder.takeTree();
}

glm::dmat4 worldFromIndex(const RawFormat& format) {
    return glm::scale(glm::translate(glm::dmat4(1), format.origin), format.spacing);
}

}  // namespace

Volume readRaw(const std::filesystem::path& path, const ReadOptions& options,
               const Listener& listener) {
    const RawLayout layout = resolveRawLayout(path, options.raw);
    const RawFile file{path, layout, lowerExtension(path) == ".raw.gz"};
    checkPlainSize(file);
    requireMemory(path.string(), double(file.sliceBytes()) * std::min(file.dims().z, kLayerSlices) +
                                     CodeTreeBuilder(file.dims()).worstLayerBytes());

    // Types that do not fit 16 bits are read twice: first for the range that their codes span.
    const bool twice = rawTypeBytes(layout.type) > 2;
    Volume volume;
    volume.codeBook = chooseBook(file, options.nanValue, {listener, 0, 0.5});
    const RawCoding coding{layout.type, layout.bigEndian, volume.codeBook,
                           options.nanValue.value_or(0)};
    readCodes(file, coding, {listener, twice ? 0.5 : 0.0, 1}, volume);

    volume.name = nameWithoutExtensions(path);
    volume.type = rawTypeName(layout.type);
    volume.gridClass = "unknown";
    volume.box = {glm::ivec3(0), file.dims() - 1};
    volume.worldFromIndex = worldFromIndex(options.raw);
    summarize(volume);
    return volume;
}

}  // namespace deltasplat
