// SPDX-License-Identifier: Apache-2.0
#include "oiio/encode_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "image/encode_numbers.h"
#include "image/quantize.h"
#include "modules/image_module.h"

namespace deltasplat {

namespace {

std::unique_ptr<OIIO::ImageOutput> newOutput(const std::filesystem::path& file,
                                             const char* formatName) {
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(formatName);
    if (!output) {
        const std::string why = printable(OIIO::geterror());
        throw Error(ErrorCode::kFailed,
                    file.string() + ": cannot be encoded: " +
                        (why.empty() ? "OpenImageIO's writer cannot be started" : why));
    }
    output->threads(threadCount());
    return output;
}

}  // namespace

std::string encodeInMemory(const std::filesystem::path& file, const char* formatName,
                           const OIIO::ImageSpec& spec,
                           const std::function<bool(OIIO::ImageOutput&)>& writePixels) {
    const std::unique_ptr<OIIO::ImageOutput> output = newOutput(file, formatName);
    OIIO::Filesystem::IOVecOutput memory;
    if (!output->set_ioproxy(&memory))
        throw Error(ErrorCode::kFailed, file.string() + ": cannot be encoded in memory");
    if (!output->open(file.string(), spec) || !writePixels(*output) || !output->close()) {
        throw Error(ErrorCode::kOutput,
                    file.string() + ": cannot be encoded: " + printable(output->geterror()));
    }
    const std::vector<unsigned char>& bytes = memory.buffer();
    return {bytes.begin(), bytes.end()};
}

namespace {

// Longest image description that fits into a .jpg segment beside the rest.
constexpr std::size_t kMaxJpegText = 30000;
constexpr const char* kJpegCompression = "jpeg:95";

PixelBox regionOf(const ImageFileOptions& options, glm::ivec2 size) {
    return options.region.value_or(PixelBox{{0, 0}, size});
}

// For formats without custom metadata names.
std::string description(const ImageFileOptions& options) {
    std::string lines;
    for (const auto& [name, text] : options.metadata) {
        if (!lines.empty()) lines += '\n';
        lines.append("deltasplat:").append(name).append(": ").append(text);
    }
    return lines;
}

// OpenImageIO crashes on an empty description.
void addDescription(const std::string& text, OIIO::ImageSpec& spec) {
    if (!text.empty()) spec.attribute("ImageDescription", text);
}

// Encodes the part of a picture whose size `spec` gives.
// @param values  the whole picture, `[height][width][spec.nchannels]`
template <typename Value>
std::string encode(const std::filesystem::path& file, const char* formatName,
                   const OIIO::ImageSpec& spec, const UnclearedVector<Value>& values, int width,
                   glm::ivec2 first) {
    const auto channels = std::size_t(spec.nchannels);
    const std::size_t pixel = std::size_t(first.y) * std::size_t(width) + std::size_t(first.x);
    const auto stride = OIIO::stride_t(channels * sizeof(Value));
    return encodeInMemory(file, formatName, spec, [&](OIIO::ImageOutput& output) {
        return output.write_image(OIIO::BaseTypeFromC<Value>::value, &values[channels * pixel],
                                  stride, stride * width);
    });
}

template <typename Sample>
std::string encodeStraight(const std::filesystem::path& file, const char* formatName,
                           const Image& image, OIIO::ImageSpec spec,
                           const ImageFileOptions& options) {
    // The samples are straight already: OpenImageIO must not divide by alpha again.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return encode(file, formatName, spec,
                  straightSrgb<Sample>(image, options.dither && sizeof(Sample) == 1), image.size.x,
                  regionOf(options, image.size).min);
}

std::string encodeStraight(const std::filesystem::path& file, const char* formatName,
                           const Image& image, const OIIO::ImageSpec& spec,
                           const ImageFileOptions& options) {
    return options.bits == 16
               ? encodeStraight<std::uint16_t>(file, formatName, image, spec, options)
               : encodeStraight<std::uint8_t>(file, formatName, image, spec, options);
}

OIIO::TypeDesc sampleType(const ImageFileOptions& options) {
    return options.bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8;
}

std::string encodeTiff(const std::filesystem::path& file, const Image& image,
                       const ImageFileOptions& options) {
    const glm::ivec2 size = regionOf(options, image.size).size();
    OIIO::ImageSpec spec(size.x, size.y, 4, sampleType(options));
    spec.channelnames = {"R", "G", "B", "A"};
    spec.alpha_channel = 3;
    spec.attribute("compression", "zip");
    addDescription(description(options), spec);
    // Without a date OpenImageIO stores the current time. A colour space goes into a second
    // directory, with a wrong offset in OpenImageIO 2.4; readers assume sRGB anyway.
    spec.attribute("DateTime", "");
    return encodeStraight(file, "tiff", image, spec, options);
}

std::string encodeNumberTiff(const std::filesystem::path& file, const Image& image,
                             const ImageFileOptions& options) {
    const glm::ivec2 size = regionOf(options, image.size).size();
    OIIO::ImageSpec spec(size.x, size.y, 1, OIIO::TypeFloat);
    spec.channelnames = {"Y"};
    spec.attribute("compression", "zip");
    addDescription(description(options), spec);
    spec.attribute("DateTime", "");  // as in encodeTiff
    const std::vector<float> numbers = numbersOf(image, options);
    return encodeInMemory(file, "tiff", spec, [&](OIIO::ImageOutput& output) {
        return output.write_image(OIIO::TypeFloat, numbers.data());
    });
}

std::string encodeJpeg(const std::filesystem::path& file, const Image& image,
                       const ImageFileOptions& options) {
    const PixelBox part = regionOf(options, image.size);
    OIIO::ImageSpec spec(part.size().x, part.size().y, 3, OIIO::TypeUInt8);
    spec.attribute("compression", kJpegCompression);
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("oiio:ColorSpace", "sRGB");
    addDescription(description(options).substr(0, kMaxJpegText), spec);
    return encode(file, "jpeg", spec, opaqueSrgb(image, options.dither), image.size.x, part.min);
}

}  // namespace

std::string image_module::encodeImage(const std::filesystem::path& file, const Image& image,
                                      const ImageFileOptions& options) {
    if (imageFormatOf(file) == ImageFormat::kJpeg) return encodeJpeg(file, image, options);
    return options.numbers ? encodeNumberTiff(file, image, options)
                           : encodeTiff(file, image, options);
}

}  // namespace deltasplat
