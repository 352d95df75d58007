// SPDX-License-Identifier: Apache-2.0
#include "formats/raw/raw_file.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <string>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "formats/dense/dense_layout.h"
#include "formats/dense/dense_source.h"
#include "formats/format.h"
#include "formats/raw/raw_format.h"
#include "volume/volume_checks.h"

namespace deltasplat {

namespace {

std::string noHeader(const DenseLayout&, const std::string&) {
    return {};
}

// Whether the file's name says big endian: "head_uint16be.raw".
bool namesBigEndian(const std::string& file, const DenseLayout& layout) {
    RawFormat format;
    format.dims = glm::i64vec3(layout.dims);
    format.type = rawTypeName(layout.type);
    try {
        return resolveRawLayout(file, format).bigEndian;
    } catch (const Error&) {
        return false;  // 64-bit integers, which raw files cannot declare
    }
}

// Without a header, options have to give what the name does not.
void settleRaw(DenseLayout& layout, const std::string& file, WriteNotes& notes) {
    std::string options;
    const bool ordered = rawTypeBytes(layout.type) > 1;
    layout.bigEndian = ordered && namesBigEndian(file, layout);
    if (!saysLayout(file, {layout.dims, layout.type, layout.bigEndian, 0})) {
        options += " `dims` " + dimsText(layout.dims) + " `type` " + rawTypeName(layout.type);
        if (ordered) options += layout.bigEndian ? " `bigEndian=true`" : " `bigEndian=false`";
    }
    notePlace(layout, "no header", options, notes);
    layout.noteLabels("a file without a header", true, notes);
}

std::string expectedSize(const RawFile& file) {
    const RawLayout& layout = file.layout;
    if (file.volumes == 1) return layout.expectedSize();
    return std::to_string(layout.skipBytes + file.dataBytes()) + " (" +
           std::to_string(layout.skipBytes) + " skipped + " + std::to_string(file.volumes) +
           " volumes of " + dimsText(layout.dims) + " " + rawTypeName(layout.type) + ")";
}

[[noreturn]] void throwSize(const RawFile& file, const std::string& got) {
    const std::string least = file.mayGoOn ? "at least " : "";
    throw Error(ErrorCode::kInput, file.path.string(), got, least + expectedSize(file));
}

[[noreturn]] void throwSize(const RawFile& file, std::uint64_t bytes) {
    throwSize(file, countText(bytes, "byte") + (file.isPacked() ? " unpacked" : ""));
}

enum class PackedEnd { kIsChecked, kIsKnown };

// Checks what follows the volume. Excess bytes mean wrong dims; their count is for the message. A
// gzip stream proves to be sound only at its end.
void requireEnd(const RawFile& file, ByteSource& source, std::uint64_t done,
                const std::function<void()>& beat) {
    constexpr std::uint64_t kMostTail = std::uint64_t{1} << 24;
    const std::uint64_t later = source.skip(file.laterBytes(), beat);
    if (later != file.laterBytes()) throwSize(file, done + later);
    const std::uint64_t more =
        source.skip(file.mayGoOn ? kMostTail : std::numeric_limits<std::uint64_t>::max(), beat);
    if (more != 0 && !file.mayGoOn) throwSize(file, done + later + more);
}

// @param step  slices at a time
void readLayers(const RawFile& file, const std::shared_ptr<const FileBytes>& bytes, int step,
                PackedEnd end, const DenseSource::LayerUse& use, const Listener& listener) {
    // Skips to the volume; packed bytes before it have to be unpacked.
    ByteSource source(bytes, file.isPacked() ? file.packedStart : file.start(), file.packing);
    const auto beat = [&](double share) { return [&listener, share] { listener.report(share); }; };
    std::uint64_t done = file.isPacked() ? source.skip(file.start(), beat(0)) : file.start();
    const int slices = int(file.layout.dims.z);
    const std::size_t sliceBytes = std::size_t(file.layout.dims.x) *
                                   std::size_t(file.layout.dims.y) *
                                   std::size_t(rawTypeBytes(file.layout.type));
    requireMemory(file.path.string(), double(sliceBytes) * step);
    const auto layer = std::make_unique_for_overwrite<std::byte[]>(sliceBytes * std::size_t(step));
    for (int first = 0; first < slices; first += step) {
        const int count = std::min(step, slices - first);
        const std::size_t wanted = sliceBytes * std::size_t(count);
        const std::size_t got = source.read(layer.get(), wanted);
        done += got;
        if (got != wanted) throwSize(file, done);
        use(first, count, layer.get());
        listener.report(double(first + count) / slices);
    }
    // A plain file's size is already checked.
    const bool known = file.isPacked() ? end == PackedEnd::kIsKnown : file.volumes > 1;
    if (!known) requireEnd(file, source, done, beat(1));
}

}  // namespace

void notePlace(const DenseLayout& layout, const std::string& lack, std::string options,
               WriteNotes& notes) {
    const glm::dvec3 spacing = layout.spacing(), origin = layout.origin();
    if (spacing != glm::dvec3(1)) options += " `spacing` " + numberText(spacing);
    if (origin != glm::dvec3(0)) options += " `origin` " + numberText(origin);

    const glm::dmat4 readBack = glm::scale(glm::translate(glm::dmat4(1), origin), spacing);
    std::string dropped;
    if (readBack != layout.worldFromIndex) dropped += " axis directions";
    if (!layout.space.empty())
        dropped += (dropped.empty() ? " " : " and ") + layout.space + " space";
    if (layout.space.empty() && !layout.lengthUnit.empty())
        dropped += (dropped.empty() ? " " : " and ") + std::string("that lengths are in ") +
                   layout.lengthUnit;
    if (!options.empty()) notes.remark(lack + "; read it with" + options);
    if (!dropped.empty()) notes.loss(lack + ", which drops" + dropped);
}

void requireRawSize(const RawFile& file) {
    const std::uint64_t held =
        file.bytes ? file.bytes->size() : std::filesystem::file_size(file.path);
    const std::uint64_t wanted = file.layout.skipBytes + file.dataBytes();
    if (!file.isPacked()) {
        if (held < wanted || (held > wanted && !file.mayGoOn)) throwSize(file, held);
        return;
    }
    // Deflate expands at most 1032 times. A larger claim is false, not a need for memory.
    constexpr double kMostRatio = 1032;
    if (double(held) * kMostRatio < double(wanted)) {
        throwSize(file, std::to_string(held) + " bytes of gzip");
    }
}

DenseSource denseSourceOf(const RawFile& file) {
    DenseSource source;
    source.where = file.path.string();
    source.name = nameWithoutExtensions(file.path);
    source.dims = file.layout.dims;
    source.type = file.layout.type;
    source.bigEndian = file.layout.bigEndian;
    source.volumes = file.volumes;
    source.step = source.enoughSlices();
    const auto bytes = file.bytes ? file.bytes : std::make_shared<const FileBytes>(file.path);
    source.forEachLayer = [file, bytes, step = source.stepSlices(),
                           checked = std::make_shared<bool>(false)](
                              const DenseSource::LayerUse& use, const Listener& listener) {
        readLayers(file, bytes, step, *checked ? PackedEnd::kIsKnown : PackedEnd::kIsChecked, use,
                   listener);
        *checked = true;
    };
    if (!file.isPacked())
        source.rows = std::make_shared<const StoredRows>(bytes, file.start(), source.rowBytes(),
                                                         source.dims.y);
    return source;
}

namespace {

DenseSource openRaw(const std::filesystem::path& path, const InputKind&, const ReadOptions& options,
                    const Listener&) {
    const RawFormat& format = options.raw;
    RawFile file{path, resolveRawLayout(path, format)};
    requireRegularFile(path);
    // The first bytes show gzip. Raw values may begin alike, and a packed file may be damaged, so
    // name and size decide where they agree.
    const bool named = lowerExtension(path) == ".raw.gz";
    const std::uint64_t plain = file.layout.skipBytes + file.layout.dataBytes();
    const bool fits = std::filesystem::file_size(path) == plain;
    file.packing = named != fits ? (named ? Packing::kGzip : Packing::kNone) : packingOf(path);
    requireRawSize(file);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = glm::scale(glm::translate(glm::dmat4(1), format.origin),
                                       format.spacing.value_or(glm::dvec3(1)));
    return source;
}

}  // namespace

const Format& rawVolumeFormat() {
    static const Format format{
        .extensions = {".raw"},
        .saysPlace = false,
        .open = openRaw,
        .written = {{".raw", "", false, false, false, settleRaw, noHeader},
                    {".raw.gz", "", false, true, false, settleRaw, noHeader}}};
    return format;
}

}  // namespace deltasplat
