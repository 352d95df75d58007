// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/text.h"
#include "files/file_name.h"
#include "formats/dense/dense_source.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/raw/raw_file.h"
#include "formats/raw/raw_format.h"
#include "formats/text/text_header.h"
#include "volume/volume_checks.h"

namespace deltasplat {
namespace {

// Whether gzip covers the header and all that follows.
bool isPackedAsWhole(const TextVolume& volume) {
    return volume.dataFile == volume.header && packingOf(volume.header) == Packing::kGzip;
}

// Whether data declared as packed begin like packed data. Plain data may do so by chance; unpacking
// then fails, and nothing is misread.
bool beginsPacked(const std::filesystem::path& file, std::uint64_t start) {
    if (packingOf(file, start) != Packing::kNone) return true;
    std::array<unsigned char, 2> begin{};
    FileBytes(file).read(start, begin.data(), begin.size());
    // RFC 1950, 2.2: deflate, a window of at most 32 KiB, a checksum divisible by 31.
    return (begin[0] & 15) == 8 && begin[0] >> 4 <= 7 && (begin[0] << 8 | begin[1]) % 31 == 0;
}

std::uint64_t wantedBytes(const TextVolume& volume) {
    return std::uint64_t(volume.volumes) * volume.layout.dataBytes();
}

std::string dataText(const TextVolume& volume) {
    return volume.sizesText() + " " + rawTypeName(volume.layout.type);
}

RawFile rawFileOf(const TextVolume& volume) {
    RawFile file{volume.dataFile, volume.layout};
    file.volumes = volume.volumes;
    file.mayGoOn = true;
    const std::uint64_t wanted = wantedBytes(volume);
    if (isPackedAsWhole(volume)) {
        if (volume.atEnd) {
            refuseFile(volume.header, "data that end with a packed file",
                       "a place for their begin");
        }
        if (volume.packed) {
            // Packed twice: data packed once fit into memory if the volume does.
            file.bytes = FileBytes::unpacked(volume.header);
            file.packing = volume.packing;
            file.packedStart = volume.dataStart;
            file.layout.skipBytes = volume.skipBytes;
            file.mayGoOn = false;
        } else {
            file.packing = Packing::kGzip;
            file.layout.skipBytes = volume.dataStart + volume.skipBytes;
        }
        return file;
    }
    const std::uint64_t held = std::filesystem::file_size(volume.dataFile);
    const std::uint64_t rest = held - std::min(held, volume.dataStart);
    // Data falsely declared packed have exactly plain values' size; falsely plain ones do not.
    const bool isPlain = volume.packed && rest == wanted + volume.skipBytes &&
                         !beginsPacked(volume.dataFile, volume.dataStart);
    const bool isGzip = !volume.packed && !volume.atEnd && volume.dataFile != volume.header &&
                        rest != wanted + volume.skipBytes &&
                        packingOf(volume.dataFile, volume.dataStart) == Packing::kGzip;
    if ((volume.packed && !isPlain) || isGzip) {
        file.packing = isGzip ? Packing::kGzip : volume.packing;
        file.packedStart = volume.dataStart;
        file.layout.skipBytes = volume.skipBytes;
        file.mayGoOn = false;
    } else {
        file.layout.skipBytes =
            volume.atEnd ? held - std::min(held, wanted) : volume.dataStart + volume.skipBytes;
    }
    const bool plain = file.packing == Packing::kNone;
    constexpr double kMostRatio = 1032;  // of deflate
    const bool holds = plain ? held >= file.layout.skipBytes + wanted
                             : (double(rest) + 1) * kMostRatio >= double(wanted);
    if (!holds) {
        refuseFile(
            volume.dataFile,
            std::to_string(plain && !volume.atEnd ? held - std::min(held, file.layout.skipBytes)
                                                  : rest) +
                " bytes of data",
            (plain ? "enough for " : "enough gzip for ") + dataText(volume));
    }
    return file;
}

class TextValues {
  public:
    explicit TextValues(const TextVolume& volume)
        : volume_(volume),
          source_(volume.dataFile,
                  isPackedAsWhole(volume) ? Packing::kGzip : packingOf(volume.dataFile)) {
        source_.skip(volume.dataStart + volume.skipBytes, [] {});
    }

    /// Writes the next values in native byte order (hex: the file's order).
    void read(std::size_t count, std::byte* to) {
        const auto bytes = std::size_t(rawTypeBytes(volume_.layout.type));
        if (volume_.encoding == TextVolume::Encoding::kHex) {
            for (std::size_t i = 0; i < count * bytes; ++i) to[i] = hexByte();
            return;
        }
        withRawType(volume_.layout.type, [&](auto zero) {
            for (std::size_t i = 0; i < count; ++i) {
                const auto value = number<decltype(zero)>();
                std::memcpy(to + i * bytes, &value, sizeof value);
            }
        });
    }

  private:
    int get() {
        if (used_ == held_) {
            held_ = source_.read(buffer_.data(), buffer_.size());
            used_ = 0;
        }
        return held_ == 0 ? -1 : static_cast<unsigned char>(buffer_[used_++]);
    }
    [[noreturn]] void refuse(const std::string& got) const {
        refuseFile(volume_.dataFile, got, "enough numbers for " + dataText(volume_));
    }
    int hexDigit() {
        int c = get();
        while (c == ' ' || (c >= '\t' && c <= '\r')) c = get();
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        refuse(c < 0 ? "too few hex digits"
                     : "\"" + printable(std::string(1, char(c))) + "\" among hex digits");
    }
    std::byte hexByte() {
        const int high = hexDigit();
        return std::byte(high << 4 | hexDigit());
    }
    std::string word() {
        constexpr std::size_t kMost = 400;
        const auto parts = [](int c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); };
        std::string word;
        int c = get();
        while (parts(c)) c = get();
        for (; c >= 0 && !parts(c) && word.size() <= kMost; c = get()) word += char(c);
        if (word.empty()) refuse("too few numbers");
        if (word.size() > kMost)
            refuse("a number of more than " + std::to_string(kMost) + " characters");
        return word;
    }
    template <typename T>
    T number() {
        const std::string text = word();
        const char* const begin = text.data() + (text.front() == '+' ? 1 : 0);
        const char* const end = text.data() + text.size();
        T value{};
        auto result = std::from_chars(begin, end, value);
        if constexpr (std::is_floating_point_v<T>) {
            // A number too close to 0 for its type becomes 0, as in other readers.
            if (result.ec == std::errc::result_out_of_range && result.ptr == end) {
                long double wide = 1;
                const bool isKnown = std::from_chars(begin, end, wide).ec == std::errc{};
                const bool isTiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
                if (isKnown ? std::fabs(wide) < 1 : isTiny) return T(isKnown ? wide : 0);
            }
        }
        // Integers may be written as reals: "3.0".
        if constexpr (std::is_integral_v<T>) {
            double real = 0;
            const auto whole = std::from_chars(begin, end, real);
            if (result.ptr != end && whole.ec == std::errc{} && whole.ptr == end &&
                real == std::floor(real) && std::fabs(real) < 0x1p53 &&
                real >= double(std::numeric_limits<T>::min()) &&
                real <= double(std::numeric_limits<T>::max())) {
                return T(real);
            }
        }
        if (result.ec != std::errc{} || result.ptr != end) {
            refuseFile(volume_.dataFile, "\"" + printable(text.substr(0, 40)) + "\" among numbers",
                       std::string("values of type ") + rawTypeName(volume_.layout.type));
        }
        return value;
    }

    const TextVolume& volume_;
    ByteSource source_;
    std::array<char, 1 << 16> buffer_{};
    std::size_t held_ = 0, used_ = 0;
};

// @param passed  number of preceding volumes
DenseSource sourceOfText(const TextVolume& volume, const RawLayout& layout, std::int64_t passed) {
    DenseSource source;
    source.dims = layout.dims;
    source.type = layout.type;
    const bool hex = volume.encoding == TextVolume::Encoding::kHex;
    source.bigEndian = hex ? volume.layout.bigEndian : std::endian::native == std::endian::big;
    // A number takes at least a digit and a separator.
    const double least =
        double(wantedBytes(volume)) / (hex ? 0.5 : double(rawTypeBytes(layout.type)) / 2);
    const double held = double(std::filesystem::file_size(volume.dataFile));
    constexpr double kMostRatio = 1032;
    if ((held + 1) * (packingOf(volume.dataFile) == Packing::kNone ? 1 : kMostRatio) < least) {
        refuseFile(volume.dataFile, numberText(held) + " bytes of data",
                   "enough for " + dataText(volume));
    }
    source.forEachLayer = [volume, layout, passed](const DenseSource::LayerUse& use,
                                                   const Listener& listener) {
        TextValues values(volume);
        const auto pixels = std::size_t(layout.dims.x) * std::size_t(layout.dims.y);
        const int slices = int(layout.dims.z);
        const int most = std::min(slices, DenseSource::kLayerSlices);
        const std::size_t bytes =
            pixels * std::size_t(most) * std::size_t(rawTypeBytes(layout.type));
        requireMemory(volume.header.string(), double(bytes));
        const auto layer = std::make_unique_for_overwrite<std::byte[]>(bytes);
        for (std::int64_t slice = 0; slice < passed * slices; ++slice) {
            values.read(pixels, layer.get());
            listener.report(0);
        }
        for (int first = 0; first < slices; first += most) {
            const int count = std::min(most, slices - first);
            values.read(pixels * std::size_t(count), layer.get());
            use(first, count, layer.get());
            listener.report(double(first + count) / slices);
        }
    };
    return source;
}

// Turns `parts` adjacent values per voxel into one.
// @param one  writes a voxel's value from its parts
template <typename One>
DenseSource joined(DenseSource source, std::int64_t parts, RawType type, const One& one) {
    DenseSource result = source;
    result.dims.x /= parts;
    result.type = type;
    result.rows = nullptr;
    const auto from = std::size_t(rawTypeBytes(source.type)) * std::size_t(parts);
    const auto to = std::size_t(rawTypeBytes(type));
    const std::size_t pixels = std::size_t(result.dims.x) * std::size_t(result.dims.y);
    result.forEachLayer = [source = std::move(source), from, to, pixels, one](
                              const DenseSource::LayerUse& use, const Listener& listener) {
        const std::size_t bytes = pixels * std::size_t(source.stepSlices()) * to;
        requireMemory(source.where, double(bytes));
        const auto values = std::make_unique_for_overwrite<std::byte[]>(bytes);
        source.forEachLayer(
            [&](int first, int slices, const std::byte* stored) {
                for (std::size_t i = 0; i < pixels * std::size_t(slices); ++i)
                    one(stored + i * from, values.get() + i * to);
                use(first, slices, values.get());
            },
            listener);
    };
    return result;
}

DenseSource partOf(DenseSource source, std::int64_t parts, std::int64_t part) {
    const RawType type = source.type;
    const auto bytes = std::size_t(rawTypeBytes(type));
    return joined(std::move(source), parts, type,
                  [bytes, place = bytes * std::size_t(part)](const std::byte* from, std::byte* to) {
                      std::memcpy(to, from + place, bytes);
                  });
}

// Per layer and value: the height in the stack, and the label.
using Layers = std::map<std::int64_t, std::map<std::int64_t, std::pair<std::size_t, std::int64_t>>>;

// Keeps one label per voxel: the topmost segment's.
DenseSource flattened(DenseSource source, const TextVolume& volume) {
    Layers layers;
    std::int64_t most = 0;
    for (std::size_t i = 0; i < volume.segments.size(); ++i) {
        const Segment& segment = volume.segments[i];
        layers[segment.layer][segment.stored] = {i + 1, segment.label.value};
        most = std::max(most, segment.label.value);
    }
    const RawType type = most < 0x100        ? RawType::kUint8
                         : most < 0x10000    ? RawType::kUint16
                         : most < 0x7fffffff ? RawType::kInt32
                                             : RawType::kInt64;
    const RawType stored = source.type;
    const bool swap = mustSwap(source.bigEndian);
    const auto bytes = std::size_t(rawTypeBytes(stored));
    const auto nameless = std::make_shared<std::uint64_t>(0);
    const auto one = [layers = std::move(layers), type, stored, swap, bytes, nameless](
                         const std::byte* from, std::byte* to) {
        std::pair<std::size_t, std::int64_t> top{0, 0};
        for (const auto& [number, labels] : layers) {
            const std::byte* const layer = from + bytes * std::size_t(number);
            const double value = withRawType(
                stored, [&](auto zero) { return double(loadValue<decltype(zero)>(layer, swap)); });
            if (!(std::fabs(value) < 0x1p53) || value == 0) continue;
            const auto found = labels.find(std::int64_t(value));
            if (found != labels.end() && double(found->first) == value)
                top = std::max(top, found->second);
            else
                ++*nameless;
        }
        withRawType(type, [&](auto zero) {
            const auto value = decltype(zero)(top.second);
            std::memcpy(to, &value, sizeof value);
        });
    };
    DenseSource result = joined(std::move(source), volume.volumes, type, one);
    result.bigEndian = std::endian::native == std::endian::big;
    // Warns once, although values may be read repeatedly.
    const auto said = std::make_shared<bool>(false);
    result.forEachLayer = [all = std::move(result.forEachLayer), nameless, said,
                           where = volume.header.string()](const DenseSource::LayerUse& use,
                                                           const Listener& listener) {
        *nameless = 0;
        all(use, listener);
        if (*nameless > 0 && !std::exchange(*said, true))
            listener.warn(where + ": " +
                          countText(*nameless, "value of layers has no segment, and counts",
                                    "values of layers have no segment, and count") +
                          " as nothing");
    };
    return result;
}

std::shared_ptr<const LabelList> labelsOf(const std::vector<Segment>& segments,
                                          std::optional<std::int64_t> layer) {
    auto list = std::make_shared<LabelList>();
    for (const Segment& segment : segments) {
        if (layer && segment.layer != *layer) continue;
        list->entries.push_back(segment.label);
        if (layer) list->entries.back().value = segment.stored;
    }
    return list;
}

void warnOfLayers(const TextVolume& volume, const Listener& listener) {
    std::string line = volume.header.string() + ": " + std::to_string(volume.volumes) +
                       " layers of segments are read as one, with later segments on top";
    if (volume.renumbered) {
        line += ", numbered from 1 to " + std::to_string(volume.segments.size()) +
                " as layers share numbers";
    }
    listener.warn(line + " (one layer: `volume` 0 to " + std::to_string(volume.volumes - 1) + ")");
}

DenseSource openTextVolume(const TextVolume& volume, const ReadOptions& options,
                           const Listener& listener) {
    const bool flat = volume.interleaved && !volume.segments.empty() && !options.volume;
    const std::int64_t chosen =
        flat ? 0
             : chooseVolume(volume.header.string(), "sizes " + volume.sizesText(), volume.volumes,
                            options.volume);
    if (flat) warnOfLayers(volume, listener);
    RawLayout layout = volume.layout;
    if (volume.interleaved) layout.dims.x *= volume.volumes;
    DenseSource source;
    if (volume.encoding == TextVolume::Encoding::kBytes) {
        RawFile file = rawFileOf(volume);
        if (volume.interleaved) {
            file.layout.dims.x = layout.dims.x;
            file.volumes = 1;
        }
        file.volume = volume.interleaved ? 0 : chosen;
        source = denseSourceOf(file);
    } else {
        source = sourceOfText(volume, layout, volume.interleaved ? 0 : chosen);
    }
    source.where = volume.header.string();
    source.name = nameWithoutExtensions(volume.header);
    source.worldFromIndex = volume.worldFromIndex;
    source.space = volume.space;
    source.lengthUnit = volume.lengthUnit;
    source.labels = volume.labels;
    if (volume.interleaved && volume.volumes > 1)
        source = flat ? flattened(std::move(source), volume)
                      : partOf(std::move(source), volume.volumes, chosen);
    if (!volume.segments.empty())
        source.labels = labelsOf(volume.segments, flat ? std::nullopt : std::optional(chosen));
    source.volumes = flat ? 1 : volume.volumes;
    return rescaled(std::move(source), volume.rescale);
}

DenseSource openNrrd(const std::filesystem::path& file, const InputKind&,
                     const ReadOptions& options, const Listener& listener) {
    return openTextVolume(readNrrdVolume(file, listener), options, listener);
}

DenseSource openMetaImage(const std::filesystem::path& file, const InputKind&,
                          const ReadOptions& options, const Listener& listener) {
    return openTextVolume(readMetaVolume(file, listener), options, listener);
}

// Returns the header's file and its separate data file, if any.
std::vector<std::filesystem::path> withData(const std::filesystem::path& header,
                                            const std::string& dataFile) {
    if (dataFile.empty()) return {header};
    return {header, header.parent_path() / dataFile};
}

std::vector<std::filesystem::path> nrrdFiles(const std::filesystem::path& header) {
    const TextHeader text = readNrrdHeader(header);
    const std::string* const name = text.find("datafile");
    return withData(header, name == nullptr ? "" : *name);
}

std::vector<std::filesystem::path> metaImageFiles(const std::filesystem::path& header) {
    const std::string name = readMetaHeader(header).fields.back().value;
    return withData(header, lowerCase(name) == "local" ? "" : name);
}

}  // namespace

const Format& nrrdFormat() {
    static const Format format{
        .extensions = {".nrrd", ".nhdr"},
        .mayHoldSeveral = true,
        .open = openNrrd,
        .files = nrrdFiles,
        .written = {{".nrrd", "", false, true, true, settleNrrd, nrrdHeader},
                    {".nhdr", ".raw.gz", false, true, true, settleNrrd, nrrdHeader}}};
    return format;
}

const Format& metaImageFormat() {
    static const Format format{
        .extensions = {".mhd", ".mha"},
        .mayHoldSeveral = true,
        .open = openMetaImage,
        .files = metaImageFiles,
        .written = {{".mhd", ".raw", false, false, true, settleMetaImage, metaImageHeader},
                    {".mha", "", false, false, true, settleMetaImage, metaImageHeader}}};
    return format;
}

}  // namespace deltasplat
