// SPDX-License-Identifier: Apache-2.0
#include "image/exr_header.h"

#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <mutex>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/image/exr_options.h"
#include "deltasplat/threads.h"

namespace deltasplat {

namespace {

void checkLevel(const ExrOptions& options) {
    if (!options.level) return;
    const std::string& name = options.compression;
    const std::string got = name + ":" + numberText(*options.level);
    const bool isZip = name.empty() || name == "zip" || name == "zips";
    if (!isZip && name != "dwaa" && name != "dwab")
        refuseUsage("`compression`", got, "a level with zip, zips, dwaa or dwab alone");
    if (isZip && !(*options.level >= 1 && *options.level <= 9 &&
                   *options.level == std::floor(*options.level)))
        refuseUsage("`compression`", got, "a level that is a whole number within 1..9");
    if (!(*options.level >= 0 && *options.level <= 1e6))
        refuseUsage("`compression`", got, "a level within 0..1000000");
}

std::string namesText() {
    const std::vector<std::string>& names = exrCompressions();
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : &name == &names.back() ? " or " : ", ") + name;
    return text;
}

}  // namespace

const std::vector<std::string>& exrCompressions() {
    static const std::vector<std::string> names{"none",  "rle", "zip",  "zips", "piz",
                                                "pxr24", "b44", "b44a", "dwaa", "dwab"};
    return names;
}

void checkExrOptions(const ExrOptions& options, bool isDeep) {
    const std::string& name = options.compression;
    const std::vector<std::string>& names = exrCompressions();
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
        refuseUsage("`compression`", name, namesText());
    // OpenEXR also allows none and rle, which pack worse.
    if (isDeep && !name.empty() && name != "zips")
        refuseUsage("`compression`", name + " of a deep picture", "zips");
    checkLevel(options);
    if (!(options.pixelAspect >= 1e-6 && options.pixelAspect <= 1e6))
        refuseUsage("pixel aspect", numberText(options.pixelAspect),
                    "a number within 1e-06..1e+06");
    if (options.displaySize && (options.displaySize->x < 1 || options.displaySize->y < 1))
        refuseUsage("display window", dimsText(*options.displaySize), "WxH, each at least 1");
}

namespace {

// In the order of exrCompressions().
constexpr Imf::Compression kCompressions[]{
    Imf::NO_COMPRESSION,   Imf::RLE_COMPRESSION,   Imf::ZIP_COMPRESSION, Imf::ZIPS_COMPRESSION,
    Imf::PIZ_COMPRESSION,  Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
    Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};
// OpenEXR's defaults differ between versions.
constexpr int kZipLevel = 4;
constexpr float kDwaLevel = 45;

std::mutex writersMutex;
int writers = 0;

Imath::Box2i boxOf(glm::ivec2 first, glm::ivec2 size) {
    return {{first.x, first.y}, {first.x + size.x - 1, first.y + size.y - 1}};
}

void setCompression(const ExrOptions& options, const std::string& usual, Imf::Header& header) {
    const std::string& name = options.compression.empty() ? usual : options.compression;
    const auto& names = exrCompressions();
    header.compression() =
        kCompressions[std::find(names.begin(), names.end(), name) - names.begin()];
    const bool isDwa = name.starts_with("dwa");
    header.zipCompressionLevel() = isDwa ? kZipLevel : int(options.level.value_or(kZipLevel));
    if (!isDwa) return;
    header.dwaCompressionLevel() = float(options.level.value_or(kDwaLevel));
    // Tells readers the level.
    header.insert("dwaCompressionLevel", Imf::FloatAttribute(header.dwaCompressionLevel()));
}

void setMatrix(const char* name, const std::optional<glm::dmat4>& matrix, Imf::Header& header) {
    if (!matrix) return;
    // OpenEXR (row vectors, row-major) and GLM (columns, column-major) have the same 16 numbers.
    const glm::mat4 rounded(*matrix);
    Imath::M44f rows;
    std::copy_n(glm::value_ptr(rounded), 16, rows.getValue());
    header.insert(name, Imf::M44fAttribute(rows));
}

Imf::Chromaticities chromaticitiesOf(const Chromaticities& numbers) {
    const auto at = [&](std::size_t i) { return Imath::V2f(numbers[i], numbers[i + 1]); };
    return {at(0), at(2), at(4), at(6)};
}

}  // namespace

Imf::Header exrHeader(const ImageFileOptions& options, glm::ivec2 sizePixels, const PixelBox& box,
                      const std::string& usualCompression) {
    const ExrOptions& exr = options.exr;
    Imf::Header header(boxOf({0, 0}, exr.displaySize.value_or(sizePixels)),
                       boxOf(exr.dataMin + box.min, box.size()), float(exr.pixelAspect));
    setCompression(exr, usualCompression, header);
    for (const auto& [name, text] : options.metadata)
        header.insert("deltasplat:" + name, Imf::StringAttribute(text));
    if (exr.chromaticities) Imf::addChromaticities(header, chromaticitiesOf(*exr.chromaticities));
    setMatrix("worldToCamera", options.cameraFromWorld, header);
    setMatrix("worldToNDC", options.ndcFromWorld, header);
    return header;
}

// OpenEXR's threads are process-wide, and none by default. OpenEXR 3.1 may deadlock if threads are
// removed while others write, so then the number only grows.
ExrThreads::ExrThreads() {
    const std::lock_guard lock(writersMutex);
    // Only the caller if 0.
    const int threads = threadCount() > 1 ? threadCount() : 0;
    const int before = Imf::globalThreadCount();
    if (threads > before || (threads < before && writers == 0)) Imf::setGlobalThreadCount(threads);
    ++writers;
}
ExrThreads::~ExrThreads() {
    const std::lock_guard lock(writersMutex);
    --writers;
}

void ExrMemoryStream::write(const char text[], int size) {
    const std::uint64_t end = at_ + std::uint64_t(size);
    if (at_ == bytes_.size()) {
        bytes_.append(text, std::size_t(size));
    } else {
        if (end > bytes_.size()) bytes_.resize(end);
        std::copy(text, text + size, bytes_.begin() + std::ptrdiff_t(at_));
    }
    at_ = end;
}

void ExrFileStream::write(const char text[], int size) {
    int left = problem_ == 0 ? size : 0;
    for (std::uint64_t to = at_; left > 0;) {
        const ssize_t count = ::pwrite(descriptor_, text, std::size_t(left), off_t(to));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            problem_ = count < 0 ? errno : ENOSPC;
            break;
        }
        text += count;
        to += std::uint64_t(count);
        left -= int(count);
    }
    at_ += std::uint64_t(size);
}

namespace {

template <typename IsSeen>
PixelBox boxOfPixels(const PixelBox& within, const IsSeen& isSeen) {
    std::vector<glm::ivec2> spans(std::size_t(within.size().y), glm::ivec2(0));
    parallelFor(spans.size(), [&](std::size_t row) {
        const int y = within.min.y + int(row);
        int first = within.min.x;
        while (first < within.max.x && !isSeen(first, y)) ++first;
        int last = within.max.x;
        while (last > first && !isSeen(last - 1, y)) --last;
        spans[row] = {first, last};
    });
    return boxOfRows(within.min.y, spans);
}

}  // namespace

PixelBox boxOfRows(int first, std::span<const glm::ivec2> spans) {
    PixelBox box;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        if (spans[i].x >= spans[i].y) continue;
        const int y = first + int(i);
        const PixelBox row{{spans[i].x, y}, {spans[i].y, y + 1}};
        box = box.empty() ? row
                          : PixelBox{{std::min(box.min.x, row.min.x), box.min.y},
                                     {std::max(box.max.x, row.max.x), row.max.y}};
    }
    return box;
}

PixelBox seenBox(const Image& image, const PixelBox& within,
                 std::span<const ImageChannel> channels) {
    return boxOfPixels(within, [&](int x, int y) {
        const float* rgba = image.pixel(x, y);
        const std::size_t i = std::size_t(rgba - image.rgba.data()) / 4;
        return std::any_of(rgba, rgba + 4, [](float value) { return value != 0; }) ||
               std::any_of(channels.begin(), channels.end(), [&](const ImageChannel& channel) {
                   return channel.values[i] != channel.nothing;
               });
    });
}

PixelBox seenBox(const DeepImage& image, const PixelBox& within) {
    return boxOfPixels(within, [&](int x, int y) { return !image.pixel(x, y).empty(); });
}

}  // namespace deltasplat
