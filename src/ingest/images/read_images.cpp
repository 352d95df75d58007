// SPDX-License-Identifier: Apache-2.0
// Multi-page TIFF and stacks of images, by OpenImageIO: one page or file is one slice, row 0 is y
// 0.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>

#include "deltasplat/error.h"
#include "ingest/dense/dense_source.h"
#include "ingest/files/file_name.h"
#include "ingest/files/refuse_file.h"
#include "ingest/images/image_file.h"
#include "ingest/readers.h"
#include "luminance.h"
#include "memory.h"
#include "modules/image_module.h"
#include "parallel.h"

namespace deltasplat {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

struct ImageType {
    RawType raw;
    TypeDesc::BASETYPE oiio;  // what OpenImageIO is asked for
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

// What all slices have to have in common, and where they are.
struct Stack {
    std::vector<std::filesystem::path> files;
    ImagePages pages;  // of the only file
    int width = 0;
    int height = 0;
    int channels = 1;  // that are read: 1, or 3 which become one
    TypeDesc stored;
    ImageType type{RawType::kUint8, TypeDesc::UINT8};

    int slices() const { return files.size() == 1 ? pages.count() : int(files.size()); }
    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    std::size_t sliceBytes() const { return pixels() * std::size_t(rawTypeBytes(type.raw)); }
};

void requireAlike(const Stack& stack, const std::filesystem::path& file, int page,
                  const ImageSpec& spec, const ImageSpec& first) {
    requireSane(file, spec);
    if (spec.width == first.width && spec.height == first.height && spec.format == first.format &&
        spec.nchannels == first.nchannels) {
        return;
    }
    const std::string where = stack.files.size() == 1 ? " on page " + std::to_string(page + 1) : "";
    refuseFile(file, sizeText(spec) + where, sizeText(first) + ", as in the first slice");
}

void warnOfLosses(const std::filesystem::path& file, const ImageSpec& spec,
                  const Listener& listener) {
    const std::string where = file.string() + ": ";
    if (hasColors(spec)) {
        listener.warn(where + "colours are read as their luminance");
    } else if (spec.nchannels > 1) {
        listener.warn(where + "only the first of " + std::to_string(spec.nchannels) +
                      " channels is read");
    }
    const int bits = spec.get_int_attribute("oiio:BitsPerSample", 0);
    if (bits > 0 && bits < int(spec.format.size() * 8)) {
        listener.warn(where + "values of " + std::to_string(bits) + " bits are spread over " +
                      std::to_string(spec.format.size() * 8));
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

// Reads slices one after the other.
class SliceReader {
  public:
    explicit SliceReader(const Stack& stack) : stack_(stack) {
        if (stack.channels > 1) {
            colors_ = std::make_unique<std::byte[]>(stack.sliceBytes() * 3);
        }
    }
    void read(int slice, std::byte* to) {
        const bool pages = stack_.files.size() == 1;
        const std::filesystem::path& file = stack_.files[pages ? 0 : std::size_t(slice)];
        ImageFile image(file, pages ? stack_.pages : ImagePages(file), pages ? slice : 0);
        const ImageSpec& spec = image.spec();
        if (spec.width != stack_.width || spec.height != stack_.height ||
            spec.format != stack_.stored || spec.nchannels < stack_.channels) {
            refuseFile(file, "an image that changes while it is read", "one that stays as it is");
        }
        image.read(stack_.channels, stack_.type.oiio, colors_ ? colors_.get() : to);
        if (colors_) mixColors(stack_, colors_.get(), to);
    }

  private:
    const Stack& stack_;
    std::unique_ptr<std::byte[]> colors_;
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

// Looks at every header before anything is read.
Stack surveyStack(const std::vector<std::filesystem::path>& files, const Listener& listener) {
    Stack stack;
    stack.files = files;
    ImageSpec first;
    bool isWhiteZero = false;
    for (const std::filesystem::path& file : files) {
        ImagePages pages(file);
        if (files.size() > 1 && pages.count() != 1) {
            refuseFile(file, std::to_string(pages.count()) + " pages",
                       "one in each file of a stack");
        }
        for (int page = 0; page < pages.count(); ++page) {
            const ImageSpec spec = ImageFile(file, pages, page).spec();
            if (stack.width == 0) {
                first = spec;
                stack.width = spec.width;
                stack.height = spec.height;
            }
            requireAlike(stack, file, page, spec, first);
            if (!isWhiteZero && pages.isWhiteZero(page)) {
                isWhiteZero = true;
                listener.warn(file.string() + ": 0 is white in it; values are read as stored");
            }
            listener.report(0);
        }
        stack.pages = std::move(pages);
    }
    const std::optional<ImageType> type = imageType(first.format);
    if (!type) refuseFile(files.front(), sizeText(first), "whole or real numbers");
    stack.type = *type;
    stack.stored = first.format;
    stack.channels = hasColors(first) ? 3 : 1;
    warnOfLosses(files.front(), first, listener);
    return stack;
}

}  // namespace

DenseSource image_module::openImages(const std::filesystem::path& input, const std::string& name,
                                     const std::vector<std::filesystem::path>& files,
                                     const RawFormat& format, const Listener& listener) {
    requireGeometry(format);
    auto stack = std::make_shared<const Stack>(surveyStack(files, listener));
    DenseSource source;
    source.where = input.string();
    source.name = name;
    source.dims = {stack->width, stack->height, stack->slices()};
    source.type = stack->type.raw;
    source.bigEndian = std::endian::native == std::endian::big;
    source.worldFromIndex =
        glm::scale(glm::translate(glm::dmat4(1), format.origin), format.spacing);
    source.forEachLayer = [stack, where = source.where](const DenseSource::LayerUse& use,
                                                        const Listener& layers) {
        readLayers(*stack, where, use, layers);
    };
    return source;
}

}  // namespace deltasplat
