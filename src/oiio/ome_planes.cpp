// SPDX-License-Identifier: Apache-2.0
// Based on: The Open Microscopy Environment, "OME-TIFF specification" and the schema of June 2016.
// Based on: Extensible Markup Language 1.0 (W3C, fifth edition), sections 2.5 to 3.1 and 4.6.
#include "oiio/ome_planes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

/// The start tag of an element: `<ome:Pixels SizeX="4">`.
struct XmlTag {
    std::string name;  ///< without the namespace prefix
    std::map<std::string, std::string> attributes;
};

/// Returns the start tags of an XML text in order; skips text, end tags, comments, declarations.
class XmlTags {
  public:
    /// @param text  must outlive this
    explicit XmlTags(std::string_view text) : text_(text) {}

    /// Returns nothing at the end, or where the text stops being XML.
    std::optional<XmlTag> next();

  private:
    std::string_view takeUntil(std::string_view characters);
    void skipSpace();

    std::string_view text_;
};

namespace {

constexpr std::string_view kSpace = " \t\r\n";

std::string utf8Of(std::uint32_t code) {
    if (code < 0x80) return {char(code)};
    if (code < 0x800) return {char(0xc0 | code >> 6), char(0x80 | (code & 0x3f))};
    if (code < 0x10000) {
        return {char(0xe0 | code >> 12), char(0x80 | (code >> 6 & 0x3f)),
                char(0x80 | (code & 0x3f))};
    }
    return {char(0xf0 | (code >> 18 & 7)), char(0x80 | (code >> 12 & 0x3f)),
            char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
}

// Returns the character of an XML reference, given the text between & and ;.
std::optional<std::string> characterNamed(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, const char*>, 5> kNames{
        {{"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}}};
    for (const auto& [known, text] : kNames)
        if (name == known) return text;
    if (name.size() < 2 || name[0] != '#') return {};
    const bool isHex = name[1] == 'x';
    std::uint32_t code = 0;
    const char* const end = name.data() + name.size();
    const auto result = std::from_chars(name.data() + (isHex ? 2 : 1), end, code, isHex ? 16 : 10);
    if (result.ec != std::errc{} || result.ptr != end || code > 0x10ffff) return {};
    return utf8Of(code);
}

std::string plainText(std::string_view text) {
    constexpr std::size_t kLongest = 12;  // longest reference, with & and ;
    std::string plain;
    while (!text.empty()) {
        const std::size_t end =
            text[0] == '&' ? text.substr(0, kLongest).find(';') : std::string_view::npos;
        const auto character = end == std::string_view::npos
                                   ? std::optional<std::string>()
                                   : characterNamed(text.substr(1, end - 1));
        plain += character.value_or(std::string(1, text[0]));
        text.remove_prefix(character ? end + 1 : 1);
    }
    return plain;
}

std::string_view withoutPrefix(std::string_view name) {
    return name.substr(name.find(':') + 1);
}

}  // namespace

std::string_view XmlTags::takeUntil(std::string_view characters) {
    const std::string_view taken = text_.substr(0, text_.find_first_of(characters));
    text_.remove_prefix(taken.size());
    return taken;
}

void XmlTags::skipSpace() {
    text_.remove_prefix(std::min(text_.find_first_not_of(kSpace), text_.size()));
}

std::optional<XmlTag> XmlTags::next() {
    while (true) {
        takeUntil("<");
        if (text_.starts_with("<!--")) {
            text_.remove_prefix(std::min(text_.find("-->", 4), text_.size()));
            continue;
        }
        if (text_.size() < 2) return {};
        text_.remove_prefix(1);
        if (text_[0] != '!' && text_[0] != '?' && text_[0] != '/') break;
    }
    XmlTag tag;
    tag.name = withoutPrefix(takeUntil(" \t\r\n/>"));
    while (true) {
        skipSpace();
        if (text_.empty()) return {};
        if (text_[0] == '/' || text_[0] == '>') return tag;
        const std::string_view name = takeUntil(" \t\r\n=/>");
        skipSpace();
        if (name.empty() || text_.size() < 2 || text_[0] != '=') return {};
        text_.remove_prefix(1);
        skipSpace();
        if (text_.empty() || (text_[0] != '"' && text_[0] != '\'')) return {};
        const std::string_view quote = text_.substr(0, 1);
        text_.remove_prefix(1);
        tag.attributes[std::string(withoutPrefix(name))] = plainText(takeUntil(quote));
        if (text_.empty()) return {};
        text_.remove_prefix(1);
    }
}

}  // namespace

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

// Planes that one TiffData block places.
struct Block {
    std::optional<std::int64_t> page, count;
    std::array<std::int64_t, 3> first{};  // z, c, t
    std::string file;
};

struct Pixels {
    Attributes attributes;
    std::vector<Block> blocks;
    std::int64_t samples = 0;  // per channel; 0: unknown
};

// Tags come in document order: a picture's parts follow its own tag.
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

// Returns the name that blocks use for this file: its current or a former one.
std::string nameIn(const std::vector<Pixels>& all, const std::string& name) {
    std::set<std::string> names;
    for (const Pixels& pixels : all)
        for (const Block& block : pixels.blocks)
            if (!block.file.empty()) names.insert(block.file);
    return names.size() == 1 ? *names.begin() : name;
}

// Returns which of z, c and t is fastest, next and slowest.
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

// Planes in page order. The last block that names a plane counts. Blocks are taken backwards and
// skip named planes, so repetitive text costs time linear in its length and the number of planes.
class NamedPlanes {
  public:
    explicit NamedPlanes(std::size_t planes) : next_(planes + 1) {
        std::iota(next_.begin(), next_.end(), std::size_t{0});
    }

    // @return the first unnamed plane from `plane` on, or the number of planes
    std::size_t firstUnnamed(std::size_t plane) {
        std::size_t first = plane;
        while (next_[first] != first) first = next_[first];
        while (next_[plane] != first) plane = std::exchange(next_[plane], first);
        return first;
    }
    void setNamed(std::size_t plane) { next_[plane] = plane + 1; }

  private:
    std::vector<std::size_t> next_;
};

// @param own  blocks' name for this file
void setPages(const Pixels& pixels, const std::string& own, OmePicture& picture) {
    const std::array<std::int64_t, 3> sizes{picture.slices, picture.channels, picture.times};
    const std::array<std::int64_t, 3> strides{1, sizes[0], sizes[0] * sizes[1]};
    const std::array<std::size_t, 3> order = orderOf(pixels.attributes);
    constexpr std::int64_t kFarthest = std::int64_t{1} << 62;  // sums stay below 2^63
    const std::size_t planes = picture.pages.size();
    NamedPlanes named(planes);
    const std::vector<Block> all(1);
    const std::vector<Block>& blocks = pixels.blocks.empty() ? all : pixels.blocks;
    for (std::size_t later = 0; later < blocks.size(); ++later) {
        const Block* const block = &blocks[blocks.size() - 1 - later];
        std::int64_t start = 0, stride = 1;
        bool isInside = true;
        for (const std::size_t axis : order) {
            isInside = isInside && block->first[axis] >= 0 && block->first[axis] < sizes[axis];
            start += isInside ? block->first[axis] * stride : 0;
            stride *= sizes[axis];
        }
        if (!isInside) continue;
        const auto first = std::size_t(start);
        const auto count = block->count.value_or(block->page ? 1 : std::int64_t(planes));
        const std::size_t end =
            first + std::size_t(std::clamp<std::int64_t>(count, 0, std::int64_t(planes - first)));
        const bool isHere = block->file.empty() || block->file == own;
        for (std::size_t i = named.firstUnnamed(first); i < end; i = named.firstUnnamed(i)) {
            named.setNamed(i);
            if (!isHere) {
                picture.otherFile = block->file;
                continue;
            }
            auto left = std::int64_t(i);
            std::int64_t place = 0;
            for (const std::size_t axis : order) {
                place += left % sizes[axis] * strides[axis];
                left /= sizes[axis];
            }
            picture.pages[std::size_t(place)] =
                std::min(block->page.value_or(0), kFarthest) + std::int64_t(i - first);
        }
    }
}

}  // namespace

std::vector<OmePicture> readOme(const std::filesystem::path& file, const std::string& text,
                                int samples) {
    constexpr std::int64_t kMostPlanes = std::int64_t{1} << 22;
    constexpr double kPerByte = 20;  // bytes of memory per byte of text, for the shortest tags
    const std::string where = file.string();
    requireClaimedMemory(where, kPerByte * double(text.size()));
    const std::vector<Pixels> all = pixelsIn(text);
    const std::string own = nameIn(all, file.filename().string());
    std::vector<OmePicture> pictures;
    double planes = 0;  // of all pictures
    for (const Pixels& pixels : all) {
        OmePicture picture;
        const auto size = [&](const char* name) {
            if (!pixels.attributes.contains(name)) return std::int64_t{1};
            const auto number = numberOf<std::int64_t>(pixels.attributes, name);
            if (number && *number >= 1 && *number <= kMostPlanes) return *number;
            throw Error(ErrorCode::kInput, where,
                        name + (" " + printable(pixels.attributes.at(name))), "a number of planes");
        };
        picture.slices = size("SizeZ");
        picture.channels = size("SizeC");
        picture.times = size("SizeT");
        // Samples of a pixel are channels that share a plane.
        const std::int64_t shared = pixels.samples > 0 ? pixels.samples : samples;
        if (shared > 1 && picture.channels % shared == 0) picture.channels /= shared;
        const double ofPicture =
            double(picture.slices) * double(picture.channels) * double(picture.times);
        planes += ofPicture;
        if (planes > double(kMostPlanes))
            throw Error(ErrorCode::kInput, where, numberText(planes) + " planes",
                        "at most " + std::to_string(kMostPlanes));
        picture.pages.assign(std::size_t(ofPicture), -1);
        setSpacing(pixels.attributes, picture);
        setPages(pixels, own, picture);
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace deltasplat
