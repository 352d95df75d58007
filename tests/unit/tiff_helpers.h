// SPDX-License-Identifier: Apache-2.0
// TIFF files byte by byte.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "unit/ingest_helpers.h"

namespace deltasplat::testing {

/// A page of a TIFF of our own making: one strip.
struct TiffPageBytes {
    int width = 4, height = 3, bits = 8, samples = 1;
    int photometric = 1;  // black is 0
    int kind = 0;         // 1: a thumbnail
    std::string pixels;
    std::string description;
    std::uint32_t pixelsPerUnit[2] = {0, 0};  // over 10; 0: not said
    int resolutionUnit = 1;
    std::vector<std::uint16_t> palette;  // all reds, greens, blues
    /// More tags, of 32-bit numbers.
    std::map<int, std::vector<std::uint32_t>> more;
};

/// Returns a file that has all pixels first, then `behind`, then what tells of them.
/// @param place  of pixels that are not in it
inline std::string tiffBytes(const std::vector<TiffPageBytes>& pages, bool bigEndian = true,
                             const std::string& behind = "", std::uint32_t place = 0) {
    const auto shorts = [&](const std::vector<std::uint16_t>& values) {
        return bytesOf(values, bigEndian);
    };
    const auto longs = [&](const std::vector<std::uint32_t>& values) {
        return bytesOf(values, bigEndian);
    };
    std::string file(8, '\0');
    std::vector<std::uint32_t> places;
    for (const TiffPageBytes& page : pages) {
        places.push_back(place > 0 ? place : std::uint32_t(file.size()));
        if (place == 0) file += page.pixels;
    }
    file += behind;
    file += std::string(file.size() % 2, '\0');
    std::uint32_t nextField = 4;
    for (std::size_t i = 0; i < pages.size(); ++i) {
        const TiffPageBytes& page = pages[i];
        // Type, count and bytes of each.
        struct Value {
            int type;
            std::uint32_t count;
            std::string bytes;
        };
        std::map<int, Value> tags;
        const auto number = [&](int tag, std::uint32_t value) {
            tags[tag] = {4, 1, longs({value})};
        };
        number(254, std::uint32_t(page.kind));
        number(256, std::uint32_t(page.width));
        number(257, std::uint32_t(page.height));
        tags[258] = {3, std::uint32_t(page.samples),
                     shorts(std::vector<std::uint16_t>(std::size_t(page.samples),
                                                       std::uint16_t(page.bits)))};
        number(259, 1);
        tags[262] = {3, 1, shorts({std::uint16_t(page.photometric)})};
        number(273, places[i]);
        number(277, std::uint32_t(page.samples));
        number(278, std::uint32_t(page.height));
        number(279, std::uint32_t(page.pixels.size()));
        if (!page.description.empty()) {
            tags[270] = {2, std::uint32_t(page.description.size() + 1),
                         page.description + std::string(1, '\0')};
        }
        for (int axis = 0; axis < 2; ++axis)
            if (page.pixelsPerUnit[axis] > 0)
                tags[282 + axis] = {5, 1, longs({page.pixelsPerUnit[axis], 10})};
        tags[296] = {3, 1, shorts({std::uint16_t(page.resolutionUnit)})};
        if (!page.palette.empty())
            tags[320] = {3, std::uint32_t(page.palette.size()), shorts(page.palette)};
        for (const auto& [tag, values] : page.more)
            tags[tag] = {4, std::uint32_t(values.size()), longs(values)};
        std::string table = shorts({std::uint16_t(tags.size())});
        for (auto& [tag, value] : tags) {
            table += shorts({std::uint16_t(tag), std::uint16_t(value.type)}) + longs({value.count});
            if (value.bytes.size() <= 4) {
                table += value.bytes + std::string(4 - value.bytes.size(), '\0');
            } else {
                table += longs({std::uint32_t(file.size())});
                file += value.bytes + std::string(value.bytes.size() % 2, '\0');
            }
        }
        file.replace(nextField, 4, longs({std::uint32_t(file.size())}));
        file += table;
        nextField = std::uint32_t(file.size());
        file += std::string(4, '\0');
    }
    return file.replace(0, 4, bigEndian ? std::string("MM\0*", 4) : std::string("II*\0", 4));
}

}  // namespace deltasplat::testing
