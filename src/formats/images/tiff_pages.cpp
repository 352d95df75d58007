// SPDX-License-Identifier: Apache-2.0
// Based on: TIFF 6.0 (Aldus, 1992), sections 2, 8 and 15; libtiff's BigTIFF with wider numbers.
#include "formats/images/tiff_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "base/memory.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "formats/images/image_claims.h"

namespace deltasplat {
namespace {

constexpr int kKind = 254, kOldKind = 255, kWidth = 256, kHeight = 257, kBits = 258,
              kCompression = 259, kPhotometric = 262, kDescription = 270, kStripPlaces = 273,
              kSamples = 277, kStripRows = 278, kStripBytes = 279, kAcross = 282, kDown = 283,
              kPlanar = 284, kResolutionUnit = 296, kTileWidth = 322, kTileHeight = 323,
              kTilePlaces = 324, kTileBytes = 325, kDepth = 32997, kMetaMorph = 33629;
constexpr std::uint64_t kUnpacked = 1, kSeparate = 2, kWhiteIsZero = 0, kBlackIsZero = 1,
                        kPalette = 3, kYcbcr = 6;
constexpr std::uint64_t kReducedOrMask = 1 | 4, kOldReduced = 2;
constexpr int kText = 2, kShort = 3, kRatio = 5;
// Longer than any description of a volume.
constexpr std::uint64_t kMostText = std::uint64_t{1} << 28;

// OpenImageIO's names of compressions; others need no name here.
const char* packingName(std::uint64_t compression) {
    switch (compression) {
        case kUnpacked:
            return "none";
        case 2:
        case 3:
        case 4:
            return "ccitt";
        case 50000:
            return "zstd";
        default:
            return "";
    }
}

// Bytes per value of each type; 0 for undefined types.
constexpr std::array<std::uint64_t, 19> kTypeBytes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4,
                                                   8, 4, 8, 4, 0, 0, 8, 8, 8};

struct Entry {
    int type = 0;
    std::uint64_t count = 0;
    std::uint64_t place = 0;  // offset of its values
};
using Table = std::map<int, Entry>;

class Walk {
  public:
    explicit Walk(const std::filesystem::path& file) : where_(file.string()), file_(file) {}

    TiffPages run() {
        std::uint64_t next = readHead();
        std::set<std::uint64_t> seen;
        while (next != 0 || pages_.pages.empty()) {
            if (!seen.insert(next).second) refuse("pages that follow each other in a ring");
            next = walkPage(next);
        }
        return std::move(pages_);
    }

  private:
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, where_, got, expected);
    }
    [[noreturn]] void refuse(const std::string& got) const { refuse(got, "a whole TIFF"); }
    std::string page() const { return "page " + std::to_string(pages_.pages.size() + 1); }

    void requireInside(std::uint64_t place, std::uint64_t bytes) const {
        if (place <= file_.size() && bytes <= file_.size() - place) return;
        refuse(page() + " that goes on behind the " + std::to_string(file_.size()) +
               " bytes of the file");
    }
    std::string bytesAt(std::uint64_t place, std::uint64_t bytes) const {
        requireInside(place, bytes);
        std::string text(std::size_t(bytes), '\0');
        if (file_.read(place, text.data(), text.size()) != text.size()) refuse("a read error");
        return text;
    }

    std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t width) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t digit = at + (pages_.bigEndian ? i : width - 1 - i);
            value = value << 8 | static_cast<unsigned char>(bytes[digit]);
        }
        return value;
    }
    std::uint64_t offset(const std::string& bytes, std::size_t at) const {
        return number(bytes, at, std::size_t(pages_.offsetBytes));
    }

    std::uint64_t readHead() {
        const std::string head = bytesAt(0, std::min<std::uint64_t>(16, file_.size()));
        pages_.bigEndian = head.starts_with("MM");
        const bool ordered = head.size() >= 8 && (pages_.bigEndian || head.starts_with("II"));
        const std::uint64_t version = ordered ? number(head, 2, 2) : 0;
        if (version == 42) return number(head, 4, 4);
        if (version != 43 || head.size() < 16 || number(head, 4, 2) != 8) {
            refuse("no TIFF header", "a TIFF file");
        }
        pages_.offsetBytes = 8;
        pages_.firstField = 8;
        return number(head, 8, 8);
    }

    // Returns the offset of the next page, or 0.
    std::uint64_t walkPage(std::uint64_t place) {
        const std::size_t width = std::size_t(pages_.offsetBytes);
        const std::size_t countBytes = width == 8 ? 8 : 2;
        const std::size_t entryBytes = 4 + 2 * width;
        const std::uint64_t count = number(bytesAt(place, countBytes), 0, countBytes);
        if (count == 0 || count > 0xffff) refuse(page() + " without a table");
        const std::size_t last = std::size_t(count) * entryBytes;
        const std::string bytes = bytesAt(place + countBytes, last + width);
        Table table;
        for (std::size_t at = 0; at < last; at += entryBytes) {
            table.emplace(int(number(bytes, at, 2)),
                          readEntry(bytes, at, place + countBytes + at + 4 + width));
        }
        requirePixels(table);
        if (pages_.pages.empty()) describe(table);
        const std::uint64_t photometric = valueOf(table, kPhotometric, kBlackIsZero);
        TiffPage page;
        page.table = place;
        page.nextField = place + countBytes + last;
        page.whiteIsZero = photometric == kWhiteIsZero;
        page.isReduced = (valueOf(table, kKind, 0) & kReducedOrMask) != 0 ||
                         valueOf(table, kOldKind, 0) == kOldReduced;
        if (photometric == kPalette && table.at(kPhotometric).type == kShort)
            page.paletteField = table.at(kPhotometric).place;
        findPixels(table, page);
        pages_.pages.push_back(page);
        return offset(bytes, last);
    }

    // Short values are stored in the entry itself, at `field`.
    Entry readEntry(const std::string& bytes, std::size_t at, std::uint64_t field) const {
        const std::size_t width = std::size_t(pages_.offsetBytes);
        Entry entry;
        entry.type = int(number(bytes, at + 2, 2));
        entry.count = offset(bytes, at + 4);
        // Unknown types have no readable values.
        if (entry.type >= int(kTypeBytes.size())) entry.type = 0;
        const std::uint64_t valueBytes = kTypeBytes[std::size_t(entry.type)];
        if (valueBytes == 0) return entry;
        if (entry.count > file_.size()) requireInside(0, entry.count);
        const std::uint64_t length = entry.count * valueBytes;
        entry.place = length <= width ? field : offset(bytes, at + 4 + width);
        requireInside(entry.place, length);
        return entry;
    }

    // Returns an entry's integers; none if it has no integers.
    std::vector<std::uint64_t> valuesOf(const Table& table, int tag) const {
        std::vector<std::uint64_t> values;
        const auto found = table.find(tag);
        if (found == table.end()) return values;
        const Entry& entry = found->second;
        const bool whole =
            entry.type == 1 || entry.type == 3 || entry.type == 4 || entry.type == 16;
        if (!whole) return values;
        const std::size_t width = std::size_t(kTypeBytes[std::size_t(entry.type)]);
        const std::string bytes = bytesAt(entry.place, entry.count * width);
        for (std::size_t at = 0; at < bytes.size(); at += width) {
            values.push_back(number(bytes, at, width));
        }
        return values;
    }
    std::uint64_t valueOf(const Table& table, int tag, std::uint64_t missing) const {
        const std::vector<std::uint64_t> values = valuesOf(table, tag);
        return values.empty() ? missing : values[0];
    }
    std::uint64_t lengthOf(const Table& table, int tag, const char* name) const {
        const std::uint64_t value = valueOf(table, tag, 0);
        if (value == 0 || value > 0x7fffffff) refuse(page() + " without " + name);
        return value;
    }

    // Rationals are two numbers.
    double ratioOf(const Table& table, int tag) const {
        const auto found = table.find(tag);
        if (found == table.end() || found->second.type != kRatio || found->second.count < 1)
            return 0;
        const std::string bytes = bytesAt(found->second.place, 8);
        const auto below = double(number(bytes, 4, 4));
        return below > 0 ? double(number(bytes, 0, 4)) / below : 0;
    }

    // Keeps the first page's metadata, which describes all pages.
    void describe(const Table& table) {
        const auto text = table.find(kDescription);
        if (text != table.end() && text->second.type == kText && text->second.count <= kMostText) {
            pages_.description = bytesAt(text->second.place, text->second.count);
            pages_.description.resize(std::strlen(pages_.description.c_str()));
        }
        pages_.samples = int(std::min<std::uint64_t>(valueOf(table, kSamples, 1), 0xffff));
        pages_.pixelsPerUnit = {ratioOf(table, kAcross), ratioOf(table, kDown)};
        pages_.resolutionUnit = int(std::min<std::uint64_t>(valueOf(table, kResolutionUnit, 2), 9));
        const auto planes = table.find(kMetaMorph);
        if (planes != table.end()) pages_.metaMorphPlanes = planes->second.count;
    }

    // Finds pixels that are stored as in memory.
    void findPixels(const Table& table, TiffPage& page) const {
        const std::vector<std::uint64_t> bits = valuesOf(table, kBits);
        const bool isWhole = !bits.empty() && bits[0] % 8 == 0 && bits[0] > 0 &&
                             std::equal(bits.begin() + 1, bits.end(), bits.begin());
        const std::uint64_t samples = valueOf(table, kSamples, 1);
        const bool isTogether = samples == 1 || valueOf(table, kPlanar, 1) != kSeparate;
        const std::vector<std::uint64_t> places = valuesOf(table, kStripPlaces);
        const std::vector<std::uint64_t> lengths = valuesOf(table, kStripBytes);
        if (!isWhole || !isTogether || table.contains(kTileWidth) || places.empty() ||
            valueOf(table, kCompression, kUnpacked) != kUnpacked ||
            (lengths.size() != places.size() && places.size() > 1))
            return;
        for (std::size_t i = 1; i < places.size(); ++i)
            if (places[i] != places[i - 1] + lengths[i - 1]) return;
        page.pixels = places[0];
        std::uint64_t end = page.table > page.pixels ? page.table : file_.size();
        for (const auto& [tag, entry] : table)
            if (entry.place > page.pixels) end = std::min(end, entry.place);
        page.roomBytes = end - page.pixels;
        page.pixelBytes =
            valueOf(table, kWidth, 0) * valueOf(table, kHeight, 0) * samples * (bits[0] / 8);
    }

    // Checks strips or tiles; strips count as tiles of full width.
    void requirePixels(const Table& table) const {
        const std::uint64_t width = lengthOf(table, kWidth, "a width");
        const std::uint64_t height = lengthOf(table, kHeight, "a height");
        // OpenImageIO would only read the first slice.
        if (const std::uint64_t depth = valueOf(table, kDepth, 1); depth > 1)
            refuse(page() + " of " + std::to_string(depth) + " slices (ImageDepth)",
                   "a page for each slice");
        const bool tiles = table.contains(kTileWidth);
        const std::uint64_t columns = tiles ? lengthOf(table, kTileWidth, "tiles") : width;
        const std::uint64_t rows = tiles ? lengthOf(table, kTileHeight, "tiles")
                                         : std::min(height, valueOf(table, kStripRows, height));
        if (rows == 0) refuse(page() + " with strips of no rows");
        const std::uint64_t samples = valueOf(table, kSamples, 1);
        const bool separate = valueOf(table, kPlanar, 1) == kSeparate;
        const double across = std::ceil(double(width) / double(columns));
        const double down = std::ceil(double(height) / double(rows));
        const double wanted = across * down * (separate ? double(samples) : 1);
        const std::vector<std::uint64_t> places =
            valuesOf(table, tiles ? kTilePlaces : kStripPlaces);
        if (double(places.size()) < wanted) {
            refuse(
                page() + " with " + std::to_string(places.size()) + (tiles ? " tiles" : " strips"),
                "enough for " + std::to_string(width) + "x" + std::to_string(height));
        }

        // Only unpacked data without subsampled colours have a known length.
        const bool plain = valueOf(table, kCompression, kUnpacked) == kUnpacked &&
                           valueOf(table, kPhotometric, kBlackIsZero) != kYcbcr;
        const double rowBits =
            double(columns) * double(valueOf(table, kBits, 1)) * (separate ? 1 : double(samples));
        const double rowBytes = plain ? std::ceil(rowBits / 8) : 0;
        const double ratio = mostRatio(packingName(valueOf(table, kCompression, kUnpacked)));
        double mostBytes = 0;
        const std::vector<std::uint64_t> lengths =
            valuesOf(table, tiles ? kTileBytes : kStripBytes);
        for (std::size_t i = 0; i < std::size_t(wanted); ++i) {
            const std::uint64_t row = i % std::size_t(across * down) / std::size_t(across) * rows;
            const double least = rowBytes * double(tiles ? rows : std::min(rows, height - row));
            const auto length = i < lengths.size() ? std::optional(lengths[i]) : std::nullopt;
            requirePart(tiles ? "a tile" : "a strip", places[i], length, least);
            const std::uint64_t lines = tiles ? rows : std::min(rows, height - row);
            const std::uint64_t packed = length.value_or(file_.size());
            const double unpacked = std::ceil(rowBits / 8) * double(lines);
            mostBytes = std::max(mostBytes, unpacked);
            if (rowBytes == 0 && !isEnough(double(packed), ratio, unpacked)) {
                refuse(page() + " with " + (tiles ? "a tile" : "a strip") + " of " +
                           std::to_string(packed) + " bytes",
                       "enough for " + std::to_string(columns) + "x" + std::to_string(lines) +
                           " pixels");
            }
        }
        if (tiles) requireClaimedMemory(where_, mostBytes);
    }

    // If the length is missing, libtiff works it out.
    void requirePart(const char* what, std::uint64_t place, std::optional<std::uint64_t> length,
                     double least) const {
        least = std::min(std::max(least, 1.0), 0x1p62);
        const std::uint64_t bytes = length.value_or(std::uint64_t(least));
        if (double(bytes) < least) {
            refuse(page() + " with " + what + " of " + std::to_string(bytes) + " bytes",
                   "at least " + std::to_string(std::uint64_t(least)));
        }
        requireInside(place, bytes);
    }

    std::string where_;
    FileBytes file_;
    TiffPages pages_;
};

}  // namespace

TiffPages walkTiff(const std::filesystem::path& file) {
    return Walk(file).run();
}

}  // namespace deltasplat
