// SPDX-License-Identifier: Apache-2.0
// Multi-page TIFF and image stacks, read with OpenImageIO: a slice per page or file, row 0 is y 0.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "formats/dense/dense_source.h"
#include "formats/dense/rescale.h"
#include "formats/input_files.h"
#include "formats/readers.h"
#include "image/srgb.h"
#include "modules/image_module.h"
#include "oiio/image_file.h"
#include "oiio/tiff_volume.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

struct ImageType {
    RawType raw;
    TypeDesc::BASETYPE oiio;  // requested from OpenImageIO
};

std::optional<ImageType> imageType(const TypeDesc& type) {
    switch (type.basetype) {
        case TypeDesc::UINT8:
            return ImageType{RawType::kUint8, TypeDesc::UINT8};
        case TypeDesc::INT8:
            return ImageType{RawType::kInt8, TypeDesc::INT8};
        case TypeDesc::UINT16:
            return ImageType{RawType::kUint16, TypeDesc::UINT16};
        case TypeDesc::INT16:
            return ImageType{RawType::kInt16, TypeDesc::INT16};
        case TypeDesc::UINT32:
            return ImageType{RawType::kUint32, TypeDesc::UINT32};
        case TypeDesc::INT32:
            return ImageType{RawType::kInt32, TypeDesc::INT32};
        case TypeDesc::HALF:
        case TypeDesc::FLOAT:
            return ImageType{RawType::kFloat32, TypeDesc::FLOAT};
        case TypeDesc::DOUBLE:
            return ImageType{RawType::kFloat64, TypeDesc::DOUBLE};
        default:
            return std::nullopt;
    }
}

struct Stack {
    std::vector<std::filesystem::path> files;
    ImagePages pages;   // of a single file
    TiffVolume volume;  // pages of a single file, or metadata of the first of several
    Samples samplesRead = Samples::kStored;   // interpretation of a palette
    std::shared_ptr<const FileBytes> behind;  // the file, if planes follow its only page
    int width = 0;
    int height = 0;
    int channels = 1;  // to read: 1, or 3 that are mixed to one
    int samples = 1;   // per pixel
    TypeDesc stored;
    ImageType type{RawType::kUint8, TypeDesc::UINT8};

    int slices() const { return int(files.size() == 1 ? volume.planes.size() : files.size()); }
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    std::size_t sliceBytes() const { return pixels() * std::size_t(rawTypeBytes(type.raw)); }
};

void requireAlike(const Stack& stack, const std::filesystem::path& file, std::int64_t page,
                  const ImageSpec& spec, const ImageSpec& first) {
    requireSane(file, spec);
    if (spec.width == first.width && spec.height == first.height && spec.format == first.format &&
        spec.nchannels == first.nchannels) {
        return;
    }
    const std::string where = stack.files.size() == 1 ? " on page " + std::to_string(page + 1) : "";
    refuseFile(file, sizeText(spec) + where, sizeText(first) + ", as in the first slice");
}

void warnOfLosses(const std::filesystem::path& file, const ImageSpec& spec, bool isPalette,
                  const Listener& listener) {
    const std::string where = file.string() + ": ";
    if (hasColors(spec) && isPalette) {
        listener.warn(where +
                      "colours of a palette are read as their luminance; "
                      "`paletteNumbers=true` reads its numbers");
    } else if (hasColors(spec)) {
        listener.warn(where + "colours are read as their luminance");
    } else if (spec.nchannels > 1) {
        listener.warn(where + "only the first of " + std::to_string(spec.nchannels) +
                      " channels is read");
    }
}

template <typename T>
void toLuminance(const std::byte* colors, std::size_t pixels, std::byte* to) {
    const std::size_t run = std::size_t{1} << 16;
    parallelFor((pixels + run - 1) / run, [&](std::size_t part) {
        for (std::size_t i = part * run; i < std::min(pixels, (part + 1) * run); ++i) {
            T rgb[3];
            std::memcpy(rgb, colors + i * sizeof rgb, sizeof rgb);
            const double sum = glm::dot(glm::dvec3(rgb[0], rgb[1], rgb[2]), kLuminance);
            const T grey = std::is_integral_v<T> ? T(std::floor(sum + 0.5)) : T(sum);
            std::memcpy(to + i * sizeof grey, &grey, sizeof grey);
        }
    });
}

void mixColors(const Stack& stack, const std::byte* colors, std::byte* to) {
    switch (stack.type.raw) {
        case RawType::kUint8:
            return toLuminance<std::uint8_t>(colors, stack.pixels(), to);
        case RawType::kInt8:
            return toLuminance<std::int8_t>(colors, stack.pixels(), to);
        case RawType::kUint16:
            return toLuminance<std::uint16_t>(colors, stack.pixels(), to);
        case RawType::kInt16:
            return toLuminance<std::int16_t>(colors, stack.pixels(), to);
        case RawType::kUint32:
            return toLuminance<std::uint32_t>(colors, stack.pixels(), to);
        case RawType::kInt32:
            return toLuminance<std::int32_t>(colors, stack.pixels(), to);
        case RawType::kFloat32:
            return toLuminance<float>(colors, stack.pixels(), to);
        default:
            return toLuminance<double>(colors, stack.pixels(), to);
    }
}

// Returns the only plane of a file in a stack.
// @throw Error(kInput) if the file has several
std::int64_t onlyPage(const std::filesystem::path& file, const ImagePages& pages,
                      const Listener& listener, TiffVolume& volume) {
    std::size_t count = std::size_t(pages.count());
    if (pages.tiff()) {
        volume = findTiffVolume(file, *pages.tiff(), false, 0, listener);
        count = volume.planes.size() * std::size_t(volume.volumes);
    }
    if (count == 1) return pages.tiff() ? volume.planes[0] : 0;
    refuseFile(file, std::to_string(count) + " pages", "one in each file of a stack");
}

void swapBytes(std::size_t width, std::span<std::byte> bytes) {
    for (std::size_t at = 0; at + width <= bytes.size(); at += width)
        std::reverse(&bytes[at], &bytes[at] + width);
}

class SliceReader {
  public:
    explicit SliceReader(const Stack& stack) : stack_(stack) {
        if (stack.channels > 1) {
            colors_ = std::make_unique<std::byte[]>(stack.sliceBytes() * 3);
        }
    }
    void read(int slice, std::byte* to) {
        std::byte* const pixels = colors_ ? colors_.get() : to;
        stack_.behind ? readBehind(slice, pixels) : readImage(slice, pixels);
        if (colors_) mixColors(stack_, colors_.get(), to);
    }

  private:
    void readImage(int slice, std::byte* to) const {
        const bool isOnly = stack_.files.size() == 1;
        const std::filesystem::path& file = stack_.files[isOnly ? 0 : std::size_t(slice)];
        const ImagePages own = isOnly ? ImagePages() : ImagePages(file);
        TiffVolume unused;
        const std::int64_t page =
            isOnly ? stack_.volume.planes[std::size_t(slice)] : onlyPage(file, own, {}, unused);
        ImageFile image(file, isOnly ? stack_.pages : own, int(page), stack_.samplesRead);
        const ImageSpec& spec = image.spec();
        if (spec.width != stack_.width || spec.height != stack_.height ||
            spec.format != stack_.stored || spec.nchannels < stack_.channels) {
            refuseFile(file, "an image that changes while it is read", "one that stays as it is");
        }
        image.read(stack_.channels, stack_.type.oiio, to);
    }

    // Reads a plane without a page of its own.
    void readBehind(int slice, std::byte* to) {
        const TiffPage& page = stack_.pages.tiff()->pages[0];
        stored_.resize(std::size_t(page.pixelBytes));
        const auto plane = std::uint64_t(stack_.volume.planes[std::size_t(slice)]);
        const std::uint64_t place = page.pixels + plane * page.pixelBytes;
        if (stack_.behind->readInParts(place, stored_.data(), stored_.size()) != stored_.size())
            stack_.behind->throwChanged();
        const std::size_t width = stack_.stored.size();
        const bool isBig = std::endian::native == std::endian::big;
        if (stack_.pages.tiff()->bigEndian != isBig) swapBytes(width, stored_);
        const std::size_t from = width * std::size_t(stack_.samples);
        const std::size_t used = std::size_t(stack_.channels);
        const std::size_t into = used * TypeDesc(stack_.type.oiio).size();
        for (std::size_t i = 0; i < stack_.pixels(); ++i)
            OIIO::convert_pixel_values(stack_.stored, &stored_[i * from], stack_.type.oiio,
                                       to + i * into, int(used));
    }

    const Stack& stack_;
    std::unique_ptr<std::byte[]> colors_;
    std::vector<std::byte> stored_;
};

void readLayers(const Stack& stack, const std::string& where, const DenseSource::LayerUse& use,
                const Listener& listener) {
    const int most = std::min(stack.slices(), DenseSource::kLayerSlices);
    requireMemory(where, double(stack.sliceBytes()) * (most + 3));
    SliceReader reader(stack);
    const auto bytes = std::make_unique<std::byte[]>(stack.sliceBytes() * std::size_t(most));
    for (int first = 0; first < stack.slices(); first += DenseSource::kLayerSlices) {
        const int count = std::min(DenseSource::kLayerSlices, stack.slices() - first);
        for (int i = 0; i < count; ++i) {
            reader.read(first + i, bytes.get() + stack.sliceBytes() * std::size_t(i));
        }
        use(first, count, bytes.get());
        listener.report(double(first + count) / stack.slices());
    }
}

// Returns a single file's pages that are slices.
TiffVolume planesOf(const std::filesystem::path& file, const ImagePages& pages,
                    const ReadOptions& options, const Listener& listener) {
    if (pages.tiff()) return findTiffVolume(file, *pages.tiff(), true, options.volume, listener);
    chooseVolume(file.string(), "its pages", 1, options.volume);
    TiffVolume volume;
    for (int page = 0; page < pages.count(); ++page) volume.planes.push_back(page);
    return volume;
}

// Whether to read palette indices instead of colours.
bool readsNumbers(const std::filesystem::path& file, bool isPalette, const TiffVolume& volume,
                  const ReadOptions& options, const Listener& listener) {
    if (!isPalette || options.paletteNumbers) return isPalette && *options.paletteNumbers;
    if (volume.isPaletteShown)
        listener.warn(file.string() +
                      ": its palette is how ImageJ shows values, which are read as stored");
    return volume.isPaletteShown;
}

// Checks that planes after the only page have the layout that the page declares.
void requirePlanes(const Stack& stack, const ImageSpec& spec) {
    const TiffPage& page = stack.pages.tiff()->pages[0];
    const double bytes = double(stack.pixels()) * spec.nchannels * double(spec.format.size());
    if (double(page.pixelBytes) == bytes && spec.channelformats.empty()) return;
    refuseFile(stack.files[0], sizeText(spec) + " for pages behind one another",
               "whole bytes, of no palette");
}

// Reads every header before any pixels.
Stack surveyStack(const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                  const Listener& listener) {
    Stack stack;
    stack.files = files;
    ImageSpec first;
    bool isWhiteZero = false, isPalette = false;
    for (const std::filesystem::path& file : files) {
        ImagePages pages(file);
        const bool isFirst = stack.width == 0;
        TiffVolume volume;
        if (files.size() == 1) {
            volume = planesOf(file, pages, options, listener);
        } else {
            const std::int64_t page =
                onlyPage(file, pages, isFirst ? listener : Listener(), volume);
            volume.planes = {page};
        }
        if (isFirst) {
            isPalette = pages.isPalette(int(volume.areBehind ? 0 : volume.planes[0]));
            if (readsNumbers(file, isPalette, volume, options, listener))
                stack.samplesRead = Samples::kNumbers;
        } else if (volume.rescale.slope != stack.volume.rescale.slope ||
                   volume.rescale.intercept != stack.volume.rescale.intercept) {
            refuseFile(file,
                       "values that are calibrated otherwise than those of " +
                           files[0].filename().string(),
                       "one calibration");
        }
        for (const std::int64_t plane :
             volume.areBehind ? std::vector<std::int64_t>{0} : volume.planes) {
            const auto page = int(plane);
            const ImageSpec spec = ImageFile(file, pages, page, stack.samplesRead).spec();
            if (stack.width == 0) {
                first = spec;
                stack.width = spec.width;
                stack.height = spec.height;
            }
            requireAlike(stack, file, page, spec, first);
            if (pages.isPalette(page) != isPalette)
                refuseFile(file, isPalette ? "no palette" : "a palette",
                           "one as in the first slice, or none");
            if (!isWhiteZero && pages.isWhiteZero(page)) {
                isWhiteZero = true;
                listener.warn(file.string() + ": 0 is white in it; values are read as stored");
            }
            listener.report(0);
        }
        if (isFirst) stack.volume = std::move(volume);
        stack.pages = std::move(pages);
    }
    const std::optional<ImageType> type = imageType(first.format);
    if (!type) refuseFile(files.front(), sizeText(first), "whole or real numbers");
    stack.type = *type;
    stack.stored = first.format;
    stack.channels = hasColors(first) ? 3 : 1;
    stack.samples = first.nchannels;
    if (stack.volume.areBehind) {
        requirePlanes(stack, first);
        stack.behind = std::make_shared<const FileBytes>(files[0]);
    }
    // Palette indices may appear as three grey channels.
    if (stack.samplesRead != Samples::kNumbers)
        warnOfLosses(files.front(), first, isPalette, listener);
    return stack;
}

// Returns a type that holds the rescaled values as integers, if any.
std::optional<RawType> wholeType(RawType type, const Rescale& rescale) {
    switch (type) {
        case RawType::kUint8:
            return rescaledWholeType(0, 255, rescale);
        case RawType::kInt8:
            return rescaledWholeType(-128, 127, rescale);
        case RawType::kUint16:
            return rescaledWholeType(0, 65535, rescale);
        case RawType::kInt16:
            return rescaledWholeType(-32768, 32767, rescale);
        default:
            return {};
    }
}

}  // namespace

DenseSource image_module::openImages(const std::filesystem::path& input, const std::string& name,
                                     const std::vector<std::filesystem::path>& files,
                                     const ReadOptions& options, const Listener& listener) {
    requireGeometry(options.raw);
    auto stack = std::make_shared<const Stack>(surveyStack(files, options, listener));
    const TiffVolume& said = stack->volume;
    DenseSource source;
    source.where = input.string();
    source.name = name;
    source.dims = {stack->width, stack->height, stack->slices()};
    source.type = stack->type.raw;
    source.bigEndian = std::endian::native == std::endian::big;
    source.volumes = said.volumes;
    const glm::dvec3 spacing = options.raw.spacing.value_or(said.spacing.value_or(glm::dvec3(1)));
    if (!options.raw.spacing && said.spacing) source.lengthUnit = said.lengthUnit;
    source.worldFromIndex = glm::scale(glm::translate(glm::dmat4(1), options.raw.origin), spacing);
    requirePlacement(source.where, "a spacing of pixels and slices", source.worldFromIndex);
    source.forEachLayer = [stack, where = source.where](const DenseSource::LayerUse& use,
                                                        const Listener& layers) {
        readLayers(*stack, where, use, layers);
    };
    if (stack->channels > 1) return source;
    const std::optional<RawType> whole = wholeType(source.type, said.rescale);
    return rescaled(std::move(source), said.rescale, whole);
}

}  // namespace deltasplat
