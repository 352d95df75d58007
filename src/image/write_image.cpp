// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/write_image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "dims_text.h"
#include "image/encode_image.h"
#include "image/quantize.h"
#include "lower_case.h"

namespace deltasplat {
namespace {

// The most bytes of an image description that fit into a segment of a .jpg, besides all else.
constexpr std::size_t kMaxJpegText = 30000;
constexpr const char* kJpegCompression = "jpeg:95";

int maxSide(ImageFormat format) {
    if (format == ImageFormat::kExr) return std::numeric_limits<int>::max();
    return format == ImageFormat::kJpeg ? kMaxJpegSide : kMaxPngSide;
}

void checkOptions(const std::filesystem::path& file, glm::ivec2 size,
                  const ImageFileOptions& options) {
    const ImageFormat format = imageFormatOf(file);
    const bool isJpeg = format == ImageFormat::kJpeg;
    if (options.bits != 8 && (options.bits != 16 || isJpeg)) {
        throw Error(ErrorCode::kUsage, gotExpected("`bits`", std::to_string(options.bits),
                                                   isJpeg ? "8 in a .jpg" : "8 or 16"));
    }
    if (!options.channels.empty() && format != ImageFormat::kExr) {
        throw Error(ErrorCode::kUsage, gotExpected("`channels`", file.string(), "an .exr file"));
    }
    for (const ImageChannel& channel : options.channels) {
        const std::size_t pixels = std::size_t(size.x) * std::size_t(size.y);
        if (channel.values.size() == pixels) continue;
        throw Error(ErrorCode::kUsage,
                    gotExpected("`channels` " + channel.name,
                                std::to_string(channel.values.size()) + " values",
                                std::to_string(pixels) + ", one for each pixel"));
    }
    if (options.floatExr && format != ImageFormat::kExr) {
        throw Error(ErrorCode::kUsage, gotExpected("`floatExr`", file.string(), "an .exr file"));
    }
    const int most = maxSide(format);
    if (size.x > most || size.y > most) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`image.size`", dimsText(size),
                                "sides of at most " + std::to_string(most) + " pixels in a " +
                                    lowerCase(file.extension().string())));
    }
}

OIIO::ImageSpec rgbaSpec(const Image& image, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(image.size.x, image.size.y, 4, type);
    spec.channelnames = {"R", "G", "B", "A"};
    spec.alpha_channel = 3;
    return spec;
}

// For formats that have no names of one's own.
std::string description(const ImageFileOptions& options) {
    std::string lines;
    for (const auto& [name, text] : options.metadata) {
        if (!lines.empty()) lines += '\n';
        lines.append("deltasplat:").append(name).append(": ").append(text);
    }
    return lines;
}

// OpenImageIO does not live through an empty one.
void addDescription(const std::string& text, OIIO::ImageSpec& spec) {
    if (!text.empty()) spec.attribute("ImageDescription", text);
}

std::string encode(const std::filesystem::path& file, const char* formatName,
                   const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
    return encodeInMemory(file, formatName, spec, [&](OIIO::ImageOutput& output) {
        return output.write_image(type, pixels);
    });
}

void addChannels(const std::vector<ImageChannel>& channels, OIIO::TypeDesc type,
                 OIIO::ImageSpec& spec) {
    spec.channelformats.assign(4, type);
    for (const ImageChannel& channel : channels) {
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(OIIO::TypeFloat);
        if (channel.name == "Z") spec.z_channel = spec.nchannels;
        ++spec.nchannels;
    }
}

// Returns all channels of each pixel after the other.
std::vector<float> besideChannels(const std::vector<float>& rgba,
                                  const std::vector<ImageChannel>& channels) {
    const std::size_t pixels = rgba.size() / 4;
    std::vector<float> all;
    all.reserve(pixels * (4 + channels.size()));
    for (std::size_t i = 0; i < pixels; ++i) {
        all.insert(all.end(), &rgba[4 * i], &rgba[4 * i] + 4);
        for (const ImageChannel& channel : channels) all.push_back(finiteValue(channel.values[i]));
    }
    return all;
}

std::string encodeExr(const std::filesystem::path& file, const Image& image,
                      const ImageFileOptions& options) {
    const OIIO::TypeDesc type = options.floatExr ? OIIO::TypeFloat : OIIO::TypeHalf;
    OIIO::ImageSpec spec = rgbaSpec(image, type);
    spec.attribute("compression", "zip");
    addExrAttributes(options, spec);
    std::vector<float> values = finiteValues(image, options.floatExr);
    if (!options.channels.empty()) {
        addChannels(options.channels, type, spec);
        values = besideChannels(values, options.channels);
    }
    return encode(file, "openexr", spec, OIIO::TypeFloat, values.data());
}

template <typename Sample>
std::string encodeStraight(const std::filesystem::path& file, const char* formatName,
                           const Image& image, OIIO::ImageSpec spec,
                           const ImageFileOptions& options) {
    // The samples are final: OpenImageIO must not divide them by alpha once more.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return encode(file, formatName, spec, spec.format,
                  straightSrgb<Sample>(image, options.dither && sizeof(Sample) == 1).data());
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

std::string encodePng(const std::filesystem::path& file, const Image& image,
                      const ImageFileOptions& options) {
    OIIO::ImageSpec spec = rgbaSpec(image, sampleType(options));
    addMetadata(options, spec);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encodeStraight(file, "png", image, spec, options);
}

std::string encodeTiff(const std::filesystem::path& file, const Image& image,
                       const ImageFileOptions& options) {
    OIIO::ImageSpec spec = rgbaSpec(image, sampleType(options));
    spec.attribute("compression", "zip");
    addDescription(description(options), spec);
    // Without a date OpenImageIO stores the clock time. A colour space it would put into a second
    // directory, whose place OpenImageIO 2.4 stores as the first one's: sRGB is what is assumed.
    spec.attribute("DateTime", "");
    return encodeStraight(file, "tiff", image, spec, options);
}

std::string encodeJpeg(const std::filesystem::path& file, const Image& image,
                       const ImageFileOptions& options) {
    OIIO::ImageSpec spec(image.size.x, image.size.y, 3, OIIO::TypeUInt8);
    spec.attribute("compression", kJpegCompression);
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("oiio:ColorSpace", "sRGB");
    addDescription(description(options).substr(0, kMaxJpegText), spec);
    return encode(file, "jpeg", spec, spec.format, opaqueSrgb(image, options.dither).data());
}

}  // namespace

ImageFormat imageFormatOf(const std::filesystem::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    if (extension == ".exr") return ImageFormat::kExr;
    if (extension == ".png") return ImageFormat::kPng;
    if (extension == ".tif" || extension == ".tiff") return ImageFormat::kTiff;
    if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::kJpeg;
    throw Error(ErrorCode::kUsage,
                gotExpected(file.string(), "extension \"" + file.extension().string() + "\"",
                            ".exr, .png, .tif or .jpg"));
}

void checkImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                    const ImageFileOptions& options) {
    checkOptions(file, sizePixels, options);
    const AtomicFile probe(file);
}

std::string encodeImage(const std::filesystem::path& file, const Image& image,
                        const ImageFileOptions& options) {
    const DefaultFloats floats;
    checkOptions(file, image.size, options);
    if (image.size.x < 1 || image.size.y < 1) {
        const std::string got = dimsText(image.size) + " pixels";
        throw Error(ErrorCode::kUsage, gotExpected(file.string(), got, "at least 1x1"));
    }
    switch (imageFormatOf(file)) {
        case ImageFormat::kExr:
            return encodeExr(file, image, options);
        case ImageFormat::kPng:
            return encodePng(file, image, options);
        case ImageFormat::kTiff:
            return encodeTiff(file, image, options);
        case ImageFormat::kJpeg:
            break;
    }
    return encodeJpeg(file, image, options);
}

void writeImage(const std::filesystem::path& file, const Image& image,
                const ImageFileOptions& options) {
    writeFileAtomically(file, encodeImage(file, image, options));
}

void compositeOver(Image& image, const glm::vec4& background) {
    const DefaultFloats floats;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        float* rgba = &image.rgba[i];
        const float behind = (1 - rgba[3]) * background.a;
        for (int channel = 0; channel < 3; ++channel) rgba[channel] += behind * background[channel];
        rgba[3] += behind;
    }
}

}  // namespace deltasplat
