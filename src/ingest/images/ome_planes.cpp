// SPDX-License-Identifier: Apache-2.0
// Based on: The Open Microscopy Environment, "OME-TIFF specification" and the schema of June 2016.
#include "ingest/images/ome_planes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "deltasplat/error.h"
#include "ingest/images/xml_tags.h"
#include "length_unit.h"
#include "number_text.h"
#include "printable.h"

namespace deltasplat {
namespace {

using Attributes = std::map<std::string, std::string>;

std::string textOf(const Attributes& attributes, const char* name, const std::string& missing) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? missing : found->second;
}

template <typename T>
std::optional<T> numberOf(const Attributes& attributes, const char* name) {
    const std::string text = textOf(attributes, name, "");
    T number{};
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || result.ec != std::errc{} || result.ptr != text.data() + text.size())
        return {};
    return number;
}

// Planes of which a block says where they are.
struct Block {
    std::optional<std::int64_t> page, count;
    std::array<std::int64_t, 3> first{};  // z, c, t
    std::string file;
};

struct Pixels {
    Attributes attributes;
    std::vector<Block> blocks;
    std::int64_t samples = 0;  // of a channel; 0: not said
};

// Elements come as they stand in the text: what a picture has behind it.
std::vector<Pixels> pixelsIn(const std::string& text) {
    std::vector<Pixels> all;
    XmlTags tags(text);
    while (const std::optional<XmlTag> tag = tags.next()) {
        const Attributes& attributes = tag->attributes;
        if (tag->name == "Pixels") {
            all.push_back({attributes, {}, 0});
        } else if (all.empty()) {
            continue;
        } else if (tag->name == "Channel" && all.back().samples == 0) {
            all.back().samples = numberOf<std::int64_t>(attributes, "SamplesPerPixel").value_or(0);
        } else if (tag->name == "TiffData") {
            Block block{numberOf<std::int64_t>(attributes, "IFD"),
                        numberOf<std::int64_t>(attributes, "PlaneCount"),
                        {},
                        {}};
            const std::array<const char*, 3> names{"FirstZ", "FirstC", "FirstT"};
            for (std::size_t i = 0; i < names.size(); ++i)
                block.first[i] = numberOf<std::int64_t>(attributes, names[i]).value_or(0);
            all.back().blocks.push_back(block);
        } else if (tag->name == "UUID" && !all.back().blocks.empty()) {
            all.back().blocks.back().file = textOf(attributes, "FileName", "");
        }
    }
    return all;
}

// The name that planes have which are in a file: its own, or that it had.
std::string nameIn(const std::vector<Pixels>& all, const std::string& name) {
    std::set<std::string> names;
    for (const Pixels& pixels : all)
        for (const Block& block : pixels.blocks)
            if (!block.file.empty()) names.insert(block.file);
    return names.size() == 1 ? *names.begin() : name;
}

// Which of z, c and t counts fastest, next and last.
std::array<std::size_t, 3> orderOf(const Attributes& attributes) {
    const std::string text = textOf(attributes, "DimensionOrder", "XYZCT");
    const std::string letters = "ZCT";
    std::array<std::size_t, 3> order{0, 1, 2};
    if (text.size() != 5) return order;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t axis = letters.find(text[i + 2]);
        if (axis == std::string::npos) return {0, 1, 2};
        order[i] = axis;
    }
    return order;
}

void setSpacing(const Attributes& attributes, OmePicture& picture) {
    const std::array<const char*, 3> names{"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    std::array<std::string, 3> units;
    for (int axis = 0; axis < 3; ++axis) {
        const char* const name = names[std::size_t(axis)];
        const double size = numberOf<double>(attributes, name).value_or(0);
        if (!(size > 0) || !std::isfinite(size)) continue;
        picture.spacing[axis] = size;
        std::string& unit = units[std::size_t(axis)];
        unit = lengthUnitNamed(textOf(attributes, (name + std::string("Unit")).c_str(), "um"));
        if (picture.lengthUnit.empty()) picture.lengthUnit = unit;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const std::string& unit = units[std::size_t(axis)];
        if (unit.empty() || unit == picture.lengthUnit) continue;
        picture.spacing[axis] *= millimetresIn(unit) / millimetresIn(picture.lengthUnit);
    }
}

// @param own  the name of planes that are in the file
void setPages(const Pixels& pixels, const std::string& own, OmePicture& picture) {
    const std::array<std::int64_t, 3> sizes{picture.slices, picture.channels, picture.times};
    const std::array<std::size_t, 3> order = orderOf(pixels.attributes);
    std::vector<Block> blocks = pixels.blocks;
    if (blocks.empty()) blocks.emplace_back();
    for (const Block& block : blocks) {
        std::array<std::int64_t, 3> at = block.first;
        const auto count =
            block.count.value_or(block.page ? 1 : std::int64_t(picture.pages.size()));
        for (std::int64_t i = 0; i < count; ++i) {
            bool isInside = true;
            for (std::size_t axis = 0; axis < 3; ++axis)
                isInside = isInside && at[axis] >= 0 && at[axis] < sizes[axis];
            if (!isInside) break;
            const bool isHere = block.file.empty() || block.file == own;
            if (!isHere) picture.otherFile = block.file;
            picture.pages[std::size_t(at[0] + sizes[0] * (at[1] + sizes[1] * at[2]))] =
                isHere ? block.page.value_or(0) + i : -1;
            for (std::size_t n = 0; n < 3; ++n) {
                if (++at[order[n]] < sizes[order[n]] || n == 2) break;
                at[order[n]] = 0;
            }
        }
    }
}

}  // namespace

std::vector<OmePicture> readOme(const std::filesystem::path& file, const std::string& text,
                                int samples) {
    constexpr std::int64_t kMostPlanes = std::int64_t{1} << 22;
    const std::string where = file.string();
    const std::vector<Pixels> all = pixelsIn(text);
    const std::string own = nameIn(all, file.filename().string());
    std::vector<OmePicture> pictures;
    for (const Pixels& pixels : all) {
        OmePicture picture;
        const auto size = [&](const char* name) {
            if (!pixels.attributes.contains(name)) return std::int64_t{1};
            const auto number = numberOf<std::int64_t>(pixels.attributes, name);
            if (number && *number >= 1 && *number <= kMostPlanes) return *number;
            throw Error(ErrorCode::kInput,
                        gotExpected(where, name + (" " + printable(pixels.attributes.at(name))),
                                    "a number of planes"));
        };
        picture.slices = size("SizeZ");
        picture.channels = size("SizeC");
        picture.times = size("SizeT");
        // Samples of a pixel are channels that share a plane.
        const std::int64_t shared = pixels.samples > 0 ? pixels.samples : samples;
        if (shared > 1 && picture.channels % shared == 0) picture.channels /= shared;
        const double planes =
            double(picture.slices) * double(picture.channels) * double(picture.times);
        if (planes > double(kMostPlanes))
            throw Error(ErrorCode::kInput, gotExpected(where, numberText(planes) + " planes",
                                                       "at most " + std::to_string(kMostPlanes)));
        picture.pages.assign(std::size_t(planes), -1);
        setSpacing(pixels.attributes, picture);
        setPages(pixels, own, picture);
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace deltasplat
