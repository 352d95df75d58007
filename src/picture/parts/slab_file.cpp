// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/slab_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <new>

#include "base/bits.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

constexpr std::string_view kName = "deltasplat slabs ";
constexpr std::string_view kVersion = "4\n";
constexpr std::string_view kEnd = "end\n";
constexpr const char* kExpected = "a whole part of a picture's slabs";

using Bytes = std::vector<unsigned char>;
using Words = std::vector<std::uint32_t>;

std::uint32_t checksum(const void* bytes, std::size_t size) {
    return std::uint32_t(::crc32_z(0, static_cast<const Bytef*>(bytes), size));
}

// Rows of a layer, counted from its first row.
struct Band {
    int first;
    int last;
};

int bandCount(const PlaneBox& box, int channels) {
    const int rows = bandRows(box, channels);
    return box.empty() ? 0 : (box.size().y + rows - 1) / rows;
}

Band bandOf(const PlaneBox& box, int channels, int band) {
    const int rows = bandRows(box, channels);
    return {band * rows, std::min((band + 1) * rows, box.size().y)};
}

Words wordsOf(const Layer& layer, const Band& band) {
    Words words;
    for (int row = band.first; row < band.last; ++row) {
        glm::ivec2 span = layer.spans[std::size_t(row)];
        if (span.x >= span.y) span = glm::ivec2(0);
        words.push_back(std::uint32_t(span.x));
        words.push_back(std::uint32_t(span.y));
    }
    for (int row = band.first; row < band.last; ++row) {
        const glm::ivec2 span = layer.spans[std::size_t(row)];
        if (span.x >= span.y) continue;
        const float* const values = layer.pixel(layer.box.min + glm::ivec2(span.x, row));
        const auto count = std::size_t(layer.channels) * std::size_t(span.y - span.x);
        for (std::size_t i = 0; i < count; ++i)
            words.push_back(std::bit_cast<std::uint32_t>(values[i]));
    }
    return words;
}

// Grouping bytes of equal significance improves compression.
Bytes shuffled(const Words& words) {
    Bytes bytes(sizeof(std::uint32_t) * words.size());
    for (std::size_t plane = 0; plane < sizeof(std::uint32_t); ++plane)
        for (std::size_t i = 0; i < words.size(); ++i)
            bytes[plane * words.size() + i] = (unsigned char)(words[i] >> (8 * plane));
    return bytes;
}

Words unshuffled(const Bytes& bytes) {
    Words words(bytes.size() / sizeof(std::uint32_t));
    for (std::size_t plane = 0; plane < sizeof(std::uint32_t); ++plane)
        for (std::size_t i = 0; i < words.size(); ++i)
            words[i] |= std::uint32_t(bytes[plane * words.size() + i]) << (8 * plane);
    return words;
}

Bytes packed(const Words& words) {
    const Bytes bytes = shuffled(words);
    uLongf size = ::compressBound(uLong(bytes.size()));
    Bytes result(size);
    if (::compress2(result.data(), &size, bytes.data(), uLong(bytes.size()), Z_BEST_SPEED) != Z_OK)
        throw std::bad_alloc();
    result.resize(size);
    return result;
}

// @return empty if the bytes are damaged
Words unpacked(const Bytes& from, std::size_t count) {
    Bytes bytes(sizeof(std::uint32_t) * count);
    uLongf size = uLongf(bytes.size());
    const int result = ::uncompress(bytes.data(), &size, from.data(), uLong(from.size()));
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK || size != bytes.size()) return {};
    return unshuffled(bytes);
}

// @return whether the number of words fits the rows
bool mergeBand(const Words& words, const PlaneBox& box, const Band& band, Layer& merged) {
    const auto rows = std::size_t(band.last - band.first);
    if (words.size() < 2 * rows) return false;
    const auto spanOf = [&](std::size_t row) {
        return glm::ivec2(int(words[2 * row]), int(words[2 * row + 1]));
    };
    std::size_t floats = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        const glm::ivec2 span = spanOf(row);
        if (span.x < 0 || span.y < span.x || span.y > box.size().x) return false;
        floats += std::size_t(merged.channels) * std::size_t(span.y - span.x);
    }
    if (words.size() != 2 * rows + floats) return false;
    std::vector<float> values;
    std::size_t next = 2 * rows;
    for (std::size_t row = 0; row < rows; ++row) {
        const glm::ivec2 span = spanOf(row);
        values.resize(std::size_t(merged.channels) * std::size_t(span.y - span.x));
        for (float& value : values) value = std::bit_cast<float>(words[next++]);
        mergeRowBehind(merged, {values.data(), box.min.x + span.x, {0, span.y - span.x}},
                       box.min.y + band.first + int(row));
    }
    return true;
}

}  // namespace

int bandRows(const PlaneBox& box, int channels) {
    constexpr int kWords = 1 << 18;
    return std::max(1, int(kWords / std::max(1.0, double(channels) * box.size().x)));
}

SlabFileWriter::SlabFileWriter(const std::filesystem::path& file, std::string_view header)
    : file_(file) {
    file_.write(kName.data(), kName.size());
    file_.write(kVersion.data(), kVersion.size());
    writeNumbers({{std::uint32_t(header.size()), checksum(header.data(), header.size())}});
    file_.write(header.data(), header.size());
}

void SlabFileWriter::writeNumbers(std::span<const std::uint32_t> numbers) {
    for (const std::uint32_t number : numbers) {
        std::array<std::byte, sizeof number> bytes{};
        storeLittle(number, bytes.data());
        file_.write(bytes.data(), bytes.size());
    }
}

void SlabFileWriter::write(const Layer& layer) {
    struct Packed {
        std::size_t words = 0;
        Bytes bytes;
    };
    std::vector<Packed> bands(std::size_t(bandCount(layer.box, layer.channels)));
    parallelFor(bands.size(), [&](std::size_t i) {
        const Words words = wordsOf(layer, bandOf(layer.box, layer.channels, int(i)));
        bands[i] = {words.size(), packed(words)};
    });
    for (const Packed& band : bands) {
        const std::size_t size = band.bytes.size();
        writeNumbers(
            {{std::uint32_t(band.words), std::uint32_t(size), checksum(band.bytes.data(), size)}});
        file_.write(band.bytes.data(), size);
    }
}

void SlabFileWriter::finish() {
    file_.write(kEnd.data(), kEnd.size());
    file_.commit();
}

SlabFileReader::SlabFileReader(const std::filesystem::path& file)
    : file_(std::make_unique<const FileBytes>(file)) {
    std::array<char, kName.size() + kVersion.size()> line{};
    const std::size_t size = file_->read(0, line.data(), line.size());
    const std::string_view read(line.data(), size);
    if (read.substr(0, kName.size()) != kName) refuse("another kind of file", kExpected);
    if (read.substr(kName.size()) != kVersion) {
        refuse("a part that another version has written", "one of this version");
    }
    place_ = read.size();
    const std::uint32_t bytes = readNumber();
    const std::uint32_t sum = readNumber();
    if (bytes > file_->size() - place_) refuse("a file cut short", kExpected);
    header_.resize(bytes);
    readBytes(header_.data(), bytes);
    if (checksum(header_.data(), bytes) != sum) refuse("a damaged header", kExpected);
}

void SlabFileReader::refuse(const std::string& got, const std::string& expected) const {
    throw Error(ErrorCode::kInput, file_->path().string(), got, expected);
}

void SlabFileReader::readBytes(void* to, std::size_t bytes) {
    if (file_->read(place_, to, bytes) != bytes) refuse("a file cut short", kExpected);
    place_ += bytes;
}

std::uint32_t SlabFileReader::readNumber() {
    std::array<unsigned char, sizeof(std::uint32_t)> bytes{};
    readBytes(bytes.data(), bytes.size());
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) number |= std::uint32_t(bytes[i]) << (8 * i);
    return number;
}

void SlabFileReader::mergeNext(const PlaneBox& box, Layer& merged) {
    struct Packed {
        std::size_t words = 0;
        std::uint32_t sum = 0;
        Bytes bytes;
    };
    const int channels = merged.channels;
    // Bands are read in batches and unpacked on all threads.
    constexpr int kAtOnce = 64;
    const int count = bandCount(box, channels);
    for (int first = 0; first < count; first += kAtOnce) {
        std::vector<Packed> bands(std::size_t(std::min(kAtOnce, count - first)));
        for (std::size_t i = 0; i < bands.size(); ++i) {
            const Band band = bandOf(box, channels, first + int(i));
            const double most = (2.0 + double(channels) * box.size().x) * (band.last - band.first);
            bands[i].words = readNumber();
            const std::uint32_t bytes = readNumber();
            bands[i].sum = readNumber();
            if (double(bands[i].words) > most) refuse("damaged layers", kExpected);
            if (bytes > file_->size() - place_) refuse("a file cut short", kExpected);
            bands[i].bytes.resize(bytes);
            readBytes(bands[i].bytes.data(), bytes);
        }
        parallelFor(bands.size(), [&](std::size_t i) {
            const Bytes& bytes = bands[i].bytes;
            const bool isWhole = checksum(bytes.data(), bytes.size()) == bands[i].sum &&
                                 mergeBand(unpacked(bytes, bands[i].words), box,
                                           bandOf(box, channels, first + int(i)), merged);
            if (!isWhole) refuse("damaged layers", kExpected);
        });
    }
}

void SlabFileReader::finish() {
    std::array<char, kEnd.size()> end{};
    readBytes(end.data(), end.size());
    if (std::string_view(end.data(), end.size()) != kEnd || place_ != file_->size())
        refuse("more than its layers", kExpected);
}

}  // namespace deltasplat
