// SPDX-License-Identifier: Apache-2.0
// Based on: numpy.lib.format, "NPY format" (numpy.org/doc), versions 1.0 to 3.0: eight bytes, a
// length, and a Python literal. Version 1.0 is written.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "formats/dense/dense_source.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/raw/raw_file.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

namespace {

// The checked header of a NumPy file.
struct NpyHeader {
    RawLayout layout;          // one volume, after skipBytes; halves are uint16
    bool half = false;         // the values are halves
    std::int64_t volumes = 1;  // product of all axes but the three fastest
    std::string shape;         // for messages: "(5, 64, 64, 36)"
};

struct Fields {
    std::optional<std::string> type;
    std::optional<bool> fortranOrder;
    std::optional<std::vector<std::int64_t>> shape;
};

// Parses a text such as {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), }.
class Parser {
  public:
    explicit Parser(const std::string& text) : text_(text) {}

    /// Returns nothing for other text.
    std::optional<Fields> run() {
        Fields fields;
        if (!take("{")) return {};
        while (!take("}")) {
            const std::optional<std::string> key = word();
            if (!key || !take(":")) return {};
            if (*key == "descr" && !fields.type) {
                if (!(fields.type = word())) return {};
            } else if (*key == "fortran_order" && !fields.fortranOrder) {
                fields.fortranOrder = take("True");
                if (!*fields.fortranOrder && !take("False")) return {};
            } else if (*key == "shape" && !fields.shape) {
                if (!(fields.shape = numbers())) return {};
            } else {
                return {};
            }
            if (!take(",") && !ahead("}")) return {};
        }
        const bool whole = fields.type && fields.fortranOrder && fields.shape;
        // Blanks pad the header.
        const bool ended = text_.find_first_not_of(" \t\r\n", at_) == std::string::npos;
        return whole && ended ? std::optional(fields) : std::nullopt;
    }

  private:
    bool ahead(const std::string& sign) {
        at_ = std::min(text_.find_first_not_of(" \n", at_), text_.size());
        return text_.compare(at_, sign.size(), sign) == 0;
    }
    bool take(const std::string& sign) {
        if (!ahead(sign)) return false;
        at_ += sign.size();
        return true;
    }
    std::optional<std::string> word() {
        const std::string quote = ahead("\"") ? "\"" : "'";
        if (!take(quote)) return {};
        const std::size_t end = text_.find(quote, at_);
        if (end == std::string::npos) return {};
        const std::string content = text_.substr(at_, end - at_);
        at_ = end + 1;
        return content;
    }
    std::optional<std::vector<std::int64_t>> numbers() {
        std::vector<std::int64_t> values;
        if (!take("(")) return {};
        while (!take(")")) {
            ahead("");
            std::int64_t value = 0;
            const char* const end = text_.data() + text_.size();
            const auto result = std::from_chars(text_.data() + at_, end, value);
            if (result.ec != std::errc{}) return {};
            at_ = std::size_t(result.ptr - text_.data());
            values.push_back(value);
            take("L");  // Python 2's suffix
            if (!take(",") && !ahead(")")) return {};
        }
        return values;
    }

    const std::string& text_;
    std::size_t at_ = 0;
};

// Returns the header's text and the offset of the values.
std::pair<std::string, std::uint64_t> readText(const std::filesystem::path& file) {
    constexpr std::size_t kMost = std::size_t{1} << 20;
    ByteSource bytes(file, packingOf(file));
    unsigned char head[12] = {};
    const std::size_t got = bytes.read(head, 10);
    const int version = head[6];
    if (got < 10 || std::memcmp(head, "\x93NUMPY", 6) != 0 || version < 1 || version > 3) {
        refuseFile(file, "no NumPy header", "a .npy file of version 1 to 3");
    }
    const bool first = version == 1;
    const std::size_t start = first ? 10 : 12;
    if (!first && bytes.read(head + 10, 2) != 2) {
        refuseFile(file, "a header that is cut short", "a whole one");
    }
    std::size_t length = std::size_t(head[8]) | std::size_t(head[9]) << 8;
    if (!first) length |= std::size_t(head[10]) << 16 | std::size_t(head[11]) << 24;
    std::string text(std::min(length, kMost), '\0');
    if (length > kMost || bytes.read(text.data(), length) != length) {
        refuseFile(file, "a header that is cut short", "a whole one");
    }
    return {text, start + length};
}

void setType(const std::filesystem::path& file, const std::string& name, NpyHeader& header) {
    struct Known {
        const char* name;
        RawType type;
    };
    constexpr Known kKnown[] = {
        {"u1", RawType::kUint8},  {"b1", RawType::kUint8},   {"i1", RawType::kInt8},
        {"u2", RawType::kUint16}, {"i2", RawType::kInt16},   {"u4", RawType::kUint32},
        {"i4", RawType::kInt32},  {"u8", RawType::kUint64},  {"i8", RawType::kInt64},
        {"f2", RawType::kUint16}, {"f4", RawType::kFloat32}, {"f8", RawType::kFloat64}};
    const bool ordered = !name.empty() && std::strchr("<>|=", name[0]) != nullptr;
    const std::string kind = ordered ? name.substr(1) : name;
    const auto* const found = std::find_if(std::begin(kKnown), std::end(kKnown),
                                           [&](const Known& known) { return kind == known.name; });
    if (found == std::end(kKnown)) {
        refuseFile(file, "values of type " + printable(name), "whole or real numbers");
    }
    header.layout.type = found->type;
    header.layout.bigEndian = name[0] == '>';
    header.half = kind == "f2";
}

void setShape(const std::filesystem::path& file, const Fields& fields, NpyHeader& header) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    std::vector<std::int64_t> axes = *fields.shape;
    double bytes = rawTypeBytes(header.layout.type);
    for (const std::int64_t size : axes) {
        header.shape += (header.shape.empty() ? "(" : ", ") + std::to_string(size);
        bytes *= double(size);
    }
    header.shape += header.shape.empty() ? "()" : ")";
    const bool sound = std::all_of(axes.begin(), axes.end(),
                                   [](std::int64_t size) { return size >= 1 && size <= kMost; });
    if (!sound) refuseFile(file, "shape " + header.shape, "each 1.." + std::to_string(kMost));
    if (bytes > 0x1p62) {
        refuseFile(file, "shape " + header.shape, "at most 4611686018427387904 bytes");
    }
    // From the fastest axis, x, to the slowest.
    if (!*fields.fortranOrder) std::reverse(axes.begin(), axes.end());
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (i < 3) {
            header.layout.dims[int(i)] = axes[i];
        } else {
            header.volumes *= axes[i];
        }
    }
}

NpyHeader readHeader(const std::filesystem::path& file) {
    const auto [text, start] = readText(file);
    const std::optional<Fields> fields = Parser(text).run();
    if (!fields) {
        refuseFile(file, "the header " + printable(text.substr(0, 60)),
                   "a dictionary of descr, fortran_order and shape");
    }
    NpyHeader header;
    setType(file, *fields->type, header);
    setShape(file, *fields, header);
    header.layout.skipBytes = start;
    return header;
}

// IEEE binary16: a sign, five bits of exponent, ten of fraction.
float floatOfHalf(std::uint16_t bits) {
    const int exponent = bits >> 10 & 0x1f;
    const int fraction = bits & 0x3ff;
    float size = std::ldexp(float(fraction + 0x400), exponent - 25);
    if (exponent == 0) size = std::ldexp(float(fraction), -24);
    if (exponent == 31) {
        size = fraction == 0 ? std::numeric_limits<float>::infinity()
                             : std::numeric_limits<float>::quiet_NaN();
    }
    return (bits & 0x8000) != 0 ? -size : size;
}

DenseSource fromHalves(DenseSource source) {
    DenseSource result = source;
    result.type = RawType::kFloat32;
    result.bigEndian = std::endian::native == std::endian::big;
    result.rows = nullptr;
    result.forEachLayer = [source = std::move(source)](const DenseSource::LayerUse& use,
                                                       const Listener& listener) {
        const std::size_t pixels = std::size_t(source.dims.x) * std::size_t(source.dims.y);
        const auto most = std::size_t(source.stepSlices());
        requireMemory(source.where, double(pixels) * double(most) * sizeof(float));
        const auto values = std::make_unique<float[]>(pixels * most);
        source.forEachLayer(
            [&](int first, int slices, const std::byte* stored) {
                for (std::size_t i = 0; i < pixels * std::size_t(slices); ++i) {
                    values[i] = floatOfHalf(
                        loadValue<std::uint16_t>(stored + 2 * i, mustSwap(source.bigEndian)));
                }
                use(first, slices, reinterpret_cast<const std::byte*>(values.get()));
            },
            listener);
    };
    return result;
}

DenseSource openNpy(const std::filesystem::path& path, const InputKind&, const ReadOptions& options,
                    const Listener&) {
    const RawFormat& format = options.raw;
    const NpyHeader header = readHeader(path);
    requireGeometry(format);
    RawFile file{path, header.layout, packingOf(path)};
    file.volumes = header.volumes;
    requireRawSize(file);
    file.volume =
        chooseVolume(path.string(), "shape " + header.shape, header.volumes, options.volume);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = glm::scale(glm::translate(glm::dmat4(1), format.origin),
                                       format.spacing.value_or(glm::dvec3(1)));
    return header.half ? fromHalves(std::move(source)) : source;
}

// NumPy's letter for the kind of number, with its bytes.
std::string typeText(RawType type) {
    const int bytes = rawTypeBytes(type);
    const std::string name = rawTypeName(type);
    const std::string order = bytes == 1 ? "|" : "<";
    return order + name.substr(0, 1) + std::to_string(bytes);
}

// Declares an array a[z][y][x]; the last index is the fastest.
std::string npyHeader(const DenseLayout& layout, const std::string&) {
    constexpr std::size_t kUnit = 64, kStart = 10;
    std::string text = "{'descr': '" + typeText(layout.type) +
                       "', 'fortran_order': False, 'shape': (" + std::to_string(layout.dims.z) +
                       ", " + std::to_string(layout.dims.y) + ", " + std::to_string(layout.dims.x) +
                       "), }";
    const std::size_t whole = (kStart + text.size() + 1 + kUnit - 1) / kUnit * kUnit;
    text.resize(whole - kStart - 1, ' ');
    text += '\n';
    return std::string("\x93NUMPY\x01\x00", 8) + char(text.size() & 0xff) + char(text.size() >> 8) +
           text;
}

void settleNpy(DenseLayout& layout, const std::string&, WriteNotes& notes) {
    notePlace(layout, "no place in its header", "", notes);
    layout.noteLabels("NumPy's format", true, notes);
}

}  // namespace

const Format& npyFormat() {
    static const Format format{.extensions = {".npy"},
                               .saysPlace = false,
                               .mayHoldSeveral = true,
                               .open = openNpy,
                               .written = {{".npy", "", false, false, true, settleNpy, npyHeader}}};
    return format;
}

}  // namespace deltasplat
