// SPDX-License-Identifier: Apache-2.0
// Siemens' mosaics. What they say of themselves stands in private elements: how many slices there
// are in (0019,xx0A), and all in a table of texts (0029,xx10).
#include "formats/dicom/dicom_mosaic.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "deltasplat/error.h"
#include "files/file_name.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kImageType = 0x00080008;

// A creator of private elements names the block that they stand in.
std::uint32_t blockOf(const DicomElements& elements, std::uint32_t group,
                      const std::string& creator) {
    for (std::uint32_t block = 0x10; block <= 0xff; ++block) {
        if (elements.text(group << 16 | block) == creator) return group << 16 | block << 8;
    }
    return 0;
}

std::uint32_t littleEndian(const std::string& bytes, std::size_t place) {
    std::uint32_t number = 0;
    for (std::size_t i = 4; i-- > 0;)
        number = number << 8 | static_cast<unsigned char>(bytes[place + i]);
    return number;
}

// Entries have a name of 64 bytes, five numbers, of which the fourth counts items, and items of
// four numbers, of which the second is a length, and a text that fills words of four bytes. The
// first version of tables has no mark, and has lengths as first numbers, to which the number of the
// first entry's items is added.
std::map<std::string, std::vector<std::string>> entriesOf(const std::string& bytes) {
    std::map<std::string, std::vector<std::string>> entries;
    constexpr std::uint32_t kMark = 77, kMostOfFirst = 128;
    const bool isFirst = !bytes.starts_with("SV10");
    std::size_t place = isFirst ? 0 : 8;
    if (bytes.size() < 16) return entries;
    const std::uint32_t count = littleEndian(bytes, place);
    if (isFirst && (count > kMostOfFirst || littleEndian(bytes, 4) != kMark)) return entries;
    place += 8;
    std::uint32_t added = 0;
    for (std::uint32_t i = 0; i < count && bytes.size() - place >= 84; ++i) {
        const std::string name = bytes.substr(place, 64).c_str();
        const std::uint32_t items = littleEndian(bytes, place + 76);
        if (isFirst && i == 0) added = items;
        place += 84;
        for (std::uint32_t item = 0; item < items && bytes.size() - place >= 16; ++item) {
            const std::size_t length = littleEndian(bytes, place + (isFirst ? 0 : 4)) - added;
            place += 16;
            if (length > bytes.size() - place) return entries;
            if (length > 0) entries[name].emplace_back(bytes.substr(place, length).c_str());
            place = std::min(bytes.size(), place + (length + 3) / 4 * 4);
        }
    }
    return entries;
}

std::vector<double> numbersOf(const std::vector<std::string>& texts) {
    std::vector<double> numbers;
    for (const std::string& text : texts) {
        const std::size_t begin = text.find_first_not_of(' ');
        double number = 0;
        if (begin == std::string::npos) return {};
        const auto result = std::from_chars(text.data() + begin, text.data() + text.size(), number);
        if (result.ec != std::errc{} || !std::isfinite(number)) return {};
        numbers.push_back(number);
    }
    return numbers;
}

// What a mosaic says of itself.
struct Layout {
    int slices = 0;
    std::vector<double> normal;  // the way from slice to slice; empty if it is not said
};

Layout layoutOf(const DicomElements& elements) {
    Layout layout;
    if (const std::uint32_t block = blockOf(elements, 0x0029, "SIEMENS CSA HEADER")) {
        const auto table = elements.values.find(block | 0x10);
        if (table != elements.values.end()) {
            auto entries = entriesOf(table->second);
            const std::vector<double> count = numbersOf(entries["NumberOfImagesInMosaic"]);
            if (count.size() == 1 && count[0] >= 1 && count[0] <= 65535)
                layout.slices = int(count[0]);
            layout.normal = numbersOf(entries["SliceNormalVector"]);
        }
    }
    if (const std::uint32_t block = blockOf(elements, 0x0019, "SIEMENS MR HEADER"))
        layout.slices = elements.number(block | 0x0a, layout.slices);
    return layout;
}

}  // namespace

bool isMosaic(const DicomElements& elements) {
    std::istringstream kinds(elements.text(kImageType));
    for (std::string kind; std::getline(kinds, kind, '\\');) {
        if (kind == "MOSAIC" || kind == "MOSAIC ") return true;
    }
    return false;
}

std::vector<DicomSlice> slicesOfMosaic(const DicomElements& elements, const DicomSlice& picture,
                                       DicomNotes& notes) {
    const Layout layout = layoutOf(elements);
    if (layout.slices < 1) {
        refuseFile(picture.file, "a mosaic (ImageType MOSAIC) that does not say of how many slices",
                   "NumberOfImagesInMosaic of a \"SIEMENS MR HEADER\" or \"SIEMENS CSA HEADER\"");
    }
    const int side = int(std::ceil(std::sqrt(layout.slices)));
    if (picture.columns % side != 0 || picture.rows % side != 0) {
        refuseFile(picture.file,
                   "a mosaic of " + std::to_string(layout.slices) + " slices in " +
                       std::to_string(picture.columns) + "x" + std::to_string(picture.rows),
                   "tiles of one size, " + std::to_string(side) + " in a row");
    }
    glm::dvec3 step = picture.normal() * picture.thickness;
    if (layout.normal.size() == 3) {
        const glm::dvec3 way(layout.normal[0], layout.normal[1], layout.normal[2]);
        if (glm::dot(way, step) < 0) step = -step;
    } else {
        notes.add(
            "a mosaic that does not say which way its slices follow; the normal of rows and "
            "columns is taken");
    }
    DicomSlice tile = picture;
    tile.columns = picture.columns / side;
    tile.rows = picture.rows / side;
    // The place is that of a slice as large as the mosaic, in the middle of which the slice lies.
    tile.position += picture.alongRow * ((picture.columns - tile.columns) / 2.0) +
                     picture.alongColumn * ((picture.rows - tile.rows) / 2.0);
    std::vector<DicomSlice> slices;
    for (int i = 0; i < layout.slices; ++i) {
        slices.push_back(tile);
        slices.back().left = i % side * tile.columns;
        slices.back().top = i / side * tile.rows;
        slices.back().frame = i + 1;
        slices.back().position += double(i) * step;
    }
    return slices;
}

}  // namespace deltasplat
