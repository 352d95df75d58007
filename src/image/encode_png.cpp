// SPDX-License-Identifier: Apache-2.0
// Based on: W3C, "Portable Network Graphics (PNG) Specification", second edition, 2003; RFC 1950.
// Unlike libpng, packs blocks of rows in parallel, each with the preceding 32 KiB as dictionary.
#include "image/encode_png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>

#include "base/parallel.h"
#include "base/uncleared.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

using Byte = unsigned char;
using Bytes = std::vector<Byte>;

// Filtered bytes per block, and deflate's window, which each block reloads.
constexpr std::size_t kBlockBytes = std::size_t{1} << 17;
constexpr std::size_t kWindow = 32768;
constexpr std::size_t kFilteredRows = 32;
// Two thirds of the time of zlib's default; files 2 % (surfaces) to 19 % (dithered fog) larger.
constexpr int kLevel = 4;

void addNumber(std::uint32_t number, std::string& to) {
    for (int shift = 24; shift >= 0; shift -= 8) to += char(number >> shift & 0xFF);
}

void addChunk(const char* type, const std::string& data, std::string& to) {
    addNumber(std::uint32_t(data.size()), to);
    const std::size_t first = to.size();
    to.append(type, 4).append(data);
    const uLong sum = crc32_z(0, reinterpret_cast<const Byte*>(&to[first]), data.size() + 4);
    addNumber(std::uint32_t(sum), to);
}

void addHeader(const PngPicture& picture, std::string& to) {
    std::string data;
    addNumber(std::uint32_t(picture.size.x), data);
    addNumber(std::uint32_t(picture.size.y), data);
    data += char(picture.bits);
    // Red, green, blue and alpha; deflate; filters by row; not interlaced.
    data.append({6, 0, 0, 0});
    addChunk("IHDR", data, to);
}

// Describes sRGB by name, and by numbers for readers that do not know the name.
void addColorSpace(std::string& to) {
    std::string gamma;
    addNumber(45455, gamma);
    addChunk("gAMA", gamma, to);
    addChunk("sRGB", std::string(1, '\3'), to);  // absolute colorimetric
    std::string primaries;
    for (const std::uint32_t number :
         {31270u, 32900u, 64000u, 33000u, 30000u, 60000u, 15000u, 6000u})
        addNumber(number, primaries);
    addChunk("cHRM", primaries, to);
}

void addText(const std::string& keyword, const std::string& text, std::string& to) {
    const bool isAscii =
        std::all_of(text.begin(), text.end(), [](char c) { return Byte(c) < 0x80; });
    const std::string end(1, '\0');
    if (isAscii) return addChunk("tEXt", keyword + end + text, to);
    // Not compressed, no language, no translated keyword.
    addChunk("iTXt", keyword + end + std::string(2, '\0') + end + end + text, to);
}

int paeth(int left, int above, int corner) {
    const int toLeft = std::abs(above - corner);
    const int toAbove = std::abs(left - corner);
    const int toCorner = std::abs(left + above - 2 * corner);
    if (toLeft <= toAbove && toLeft <= toCorner) return left;
    return toAbove <= toCorner ? above : corner;
}

// Rows to pack: a filter's number, then differences from a prediction by left and upper neighbours.
class FilteredRows {
  public:
    explicit FilteredRows(const PngPicture& picture)
        : picture_(picture),
          pixelBytes_(std::size_t(picture.bits) / 2),
          rowBytes_(pixelBytes_ * std::size_t(picture.size.x)),
          bytes_((rowBytes_ + 1) * std::size_t(picture.size.y)) {
        const auto rows = std::size_t(picture.size.y);
        parallelFor((rows + kFilteredRows - 1) / kFilteredRows, [&](std::size_t part) {
            const std::size_t begin = part * kFilteredRows;
            const std::size_t end = std::min(begin + kFilteredRows, rows);
            Filter filter(rowBytes_, pixelBytes_);
            if (begin > 0) readRow(begin - 1, filter.row());
            for (std::size_t y = begin; y < end; ++y) {
                filter.next();
                readRow(y, filter.row());
                filter.write(&bytes_[(rowBytes_ + 1) * y]);
            }
        });
    }

    const UnclearedVector<Byte>& bytes() const { return bytes_; }

  private:
    // Applies all five filters to a row and keeps the smallest result.
    class Filter {
      public:
        Filter(std::size_t rowBytes, std::size_t pixelBytes)
            : pixel_(pixelBytes), bytes_(rowBytes), row_(pixelBytes + rowBytes), above_(row_) {
            for (Bytes& filtered : filtered_) filtered.resize(rowBytes);
        }
        Byte* row() { return &row_[pixel_]; }
        void next() { std::swap(row_, above_); }

        void write(Byte* to) {
            // Zeros precede a row.
            const Byte* const here = &row_[pixel_];
            const Byte* const left = row_.data();
            const Byte* const above = &above_[pixel_];
            const Byte* const corner = above_.data();
            for (std::size_t i = 0; i < bytes_; ++i) {
                filtered_[0][i] = here[i];
                filtered_[1][i] = Byte(here[i] - left[i]);
                filtered_[2][i] = Byte(here[i] - above[i]);
                filtered_[3][i] = Byte(here[i] - (left[i] + above[i]) / 2);
            }
            for (std::size_t i = 0; i < bytes_; ++i)
                filtered_[4][i] = Byte(here[i] - paeth(left[i], above[i], corner[i]));
            std::size_t best = 0;
            std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
            for (std::size_t f = 0; f < filtered_.size(); ++f) {
                const std::uint64_t sum = magnitude(filtered_[f]);
                if (sum >= least) continue;
                least = sum;
                best = f;
            }
            *to = Byte(best);
            std::copy(filtered_[best].begin(), filtered_[best].end(), to + 1);
        }

      private:
        static std::uint64_t magnitude(const Bytes& bytes) {
            std::uint64_t sum = 0;
            for (const Byte byte : bytes) sum += byte < 128 ? byte : 256u - byte;
            return sum;
        }

        std::size_t pixel_;
        std::size_t bytes_;
        Bytes row_;  // a pixel of zeros, then the row
        Bytes above_;
        std::array<Bytes, 5> filtered_;
    };

    // Samples are stored big-endian.
    void readRow(std::size_t y, Byte* to) const {
        const Byte* const from = static_cast<const Byte*>(picture_.samples) + picture_.rowBytes * y;
        if (picture_.bits == 8 || std::endian::native == std::endian::big) {
            std::copy(from, from + rowBytes_, to);
            return;
        }
        for (std::size_t i = 0; i < rowBytes_; i += 2) {
            to[i] = from[i + 1];
            to[i + 1] = from[i];
        }
    }

    const PngPicture& picture_;
    std::size_t pixelBytes_;
    std::size_t rowBytes_;
    UnclearedVector<Byte> bytes_;
};

struct Block {
    std::string packed;
    uLong sum = 0;
    std::size_t bytes = 0;
};

struct EndDeflate {
    void operator()(z_stream* stream) const { deflateEnd(stream); }
};

// Packs a range of the bytes so that blocks can be concatenated.
Block pack(const UnclearedVector<Byte>& all, std::size_t begin, std::size_t end) {
    z_stream stream{};
    const auto check = [](int code, int expected) {
        if (code != expected)
            throw Error(ErrorCode::kFailed, "zlib: got " + std::to_string(code) + "; expected " +
                                                std::to_string(expected));
    };
    constexpr int kRaw = -15;
    check(deflateInit2(&stream, kLevel, Z_DEFLATED, kRaw, 8, Z_FILTERED), Z_OK);
    const std::unique_ptr<z_stream, EndDeflate> open(&stream);
    const std::size_t known = std::min(begin, kWindow);
    if (known > 0) check(deflateSetDictionary(&stream, &all[begin - known], uInt(known)), Z_OK);
    Block block;
    block.bytes = end - begin;
    block.sum = adler32_z(1, &all[begin], block.bytes);
    // Includes room for the flush marker.
    block.packed.resize(deflateBound(&stream, uLong(block.bytes)) + 16);
    stream.next_in = const_cast<Byte*>(&all[begin]);
    stream.avail_in = uInt(block.bytes);
    stream.next_out = reinterpret_cast<Byte*>(block.packed.data());
    stream.avail_out = uInt(block.packed.size());
    const bool isLast = end == all.size();
    const int code = deflate(&stream, isLast ? Z_FINISH : Z_SYNC_FLUSH);
    block.packed.resize(stream.total_out);
    check(code, isLast ? Z_STREAM_END : Z_OK);
    return block;
}

void addPixels(const PngPicture& picture, std::string& to) {
    const FilteredRows rows(picture);
    const UnclearedVector<Byte>& all = rows.bytes();
    std::vector<Block> blocks((all.size() + kBlockBytes - 1) / kBlockBytes);
    parallelFor(blocks.size(), [&](std::size_t i) {
        blocks[i] = pack(all, i * kBlockBytes, std::min((i + 1) * kBlockBytes, all.size()));
    });
    uLong sum = 1;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        sum = adler32_combine(sum, blocks[i].sum, z_off_t(blocks[i].bytes));
        // zlib header: 32 KiB window, fast level.
        if (i == 0) blocks[i].packed.insert(0, "\x78\x5E");
        if (i + 1 == blocks.size()) addNumber(std::uint32_t(sum), blocks[i].packed);
        addChunk("IDAT", blocks[i].packed, to);
    }
}

}  // namespace

std::string encodePng(const PngPicture& picture) {
    std::string file = "\x89PNG\r\n\x1A\n";
    addHeader(picture, file);
    addColorSpace(file);
    for (const auto& [keyword, text] : picture.texts) addText(keyword, text, file);
    addPixels(picture, file);
    addChunk("IEND", "", file);
    return file;
}

}  // namespace deltasplat
