// SPDX-License-Identifier: Apache-2.0

#include <cstdint>
#include <limits>
#include <string>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/image/write_deep_image.h"
#include "deltasplat/image/write_image.h"
#include "image/encode_exr.h"
#include "image/encode_numbers.h"
#include "image/encode_png.h"
#include "image/quantize.h"
#include "modules/image_module.h"

namespace deltasplat {

namespace {

// The encoded samples, and a copy while their string grows: each at most as large as the samples.
constexpr double kEncodedCopies = 2;

void requireExr(const std::filesystem::path& file) {
    if (imageFormatOf(file) == ImageFormat::kExr) return;
    throw Error(ErrorCode::kUsage, file.string(), "a deep picture", "an .exr file");
}

}  // namespace

void checkDeepImageFile(const std::filesystem::path& file, glm::ivec2 sizePixels,
                        const ImageFileOptions& options) {
    requireExr(file);
    checkExrOptions(options.exr, true);
    checkImageFile(file, sizePixels, options);
}

std::string encodeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                            const ImageFileOptions& options) {
    const DefaultFloats floats;
    requireExr(file);
    checkExrOptions(options.exr, true);
    if (image.size.x < 1 || image.size.y < 1) {
        throw Error(ErrorCode::kUsage, file.string(), dimsText(image.size) + " pixels",
                    "at least 1x1");
    }
    const double sampleBytes = options.floatExr ? 24 : 16;
    requireMemory(file.string() + ", " + std::to_string(image.samples()) + " samples",
                  kEncodedCopies * sampleBytes * double(image.samples()));
    return encodeDeepExr(file, image, options);
}

void writeDeepImage(const std::filesystem::path& file, const DeepImage& image,
                    const ImageFileOptions& options) {
    writeFileAtomically(file, encodeDeepImage(file, image, options));
}

namespace {

int maxSide(ImageFormat format) {
    if (format == ImageFormat::kExr || isOfNumbers(format)) return std::numeric_limits<int>::max();
    return format == ImageFormat::kJpeg ? kMaxJpegSide : kMaxPngSide;
}

void checkRegion(const ImageFileOptions& options, glm::ivec2 size) {
    if (!options.region) return;
    const PixelBox& part = *options.region;
    if (!part.empty() && part.min.x >= 0 && part.min.y >= 0 && part.max.x <= size.x &&
        part.max.y <= size.y)
        return;
    throw Error(ErrorCode::kUsage, "`region`",
                dimsText(part.size()) + " pixels from " + std::to_string(part.min.x) + "," +
                    std::to_string(part.min.y) + " on",
                "all of them among the picture's " + dimsText(size));
}

void checkOptions(const std::filesystem::path& file, glm::ivec2 size,
                  const ImageFileOptions& options) {
    const ImageFormat format = imageFormatOf(file);
    const bool isJpeg = format == ImageFormat::kJpeg;
    if (options.bits != 8 && (options.bits != 16 || isJpeg)) {
        throw Error(ErrorCode::kUsage, "`bits`", std::to_string(options.bits),
                    isJpeg ? "8 in a .jpg" : "8 or 16");
    }
    if (!options.channels.empty() && format != ImageFormat::kExr) {
        throw Error(ErrorCode::kUsage, "`channels`", file.string(), "an .exr file");
    }
    for (const ImageChannel& channel : options.channels) {
        const std::size_t pixels = std::size_t(size.x) * std::size_t(size.y);
        if (channel.values.size() == pixels) continue;
        throw Error(ErrorCode::kUsage, "`channels` " + channel.name,
                    std::to_string(channel.values.size()) + " values",
                    std::to_string(pixels) + ", one for each pixel");
    }
    checkRegion(options, size);
    if (isOfNumbers(format) && !options.numbers) {
        throw Error(ErrorCode::kUsage, file.string(), "a picture of colours",
                    "one of numbers, or .exr, .png, .tif or .jpg");
    }
    const bool holdsNumbers =
        options.numbers && (isOfNumbers(format) || format == ImageFormat::kTiff);
    if (options.floatExr && format != ImageFormat::kExr && !holdsNumbers) {
        throw Error(ErrorCode::kUsage, "`floatExr`", file.string(), "an .exr file");
    }
    if (format == ImageFormat::kExr) checkExrOptions(options.exr, false);
    const int most = maxSide(format);
    if (size.x > most || size.y > most) {
        throw Error(ErrorCode::kUsage, "`image.size`", dimsText(size),
                    "sides of at most " + std::to_string(most) + " pixels in a " +
                        lowerCase(file.extension().string()));
    }
}

template <typename Sample>
std::string encodePng(const Image& image, const ImageFileOptions& options) {
    const UnclearedVector<Sample> samples =
        straightSrgb<Sample>(image, options.dither && sizeof(Sample) == 1);
    const PixelBox part = options.region.value_or(PixelBox{{0, 0}, image.size});
    const auto width = std::size_t(image.size.x);
    PngPicture picture{part.size(),
                       8 * int(sizeof(Sample)),
                       &samples[4 * (std::size_t(part.min.y) * width + std::size_t(part.min.x))],
                       4 * sizeof(Sample) * width,
                       {}};
    for (const auto& [name, text] : options.metadata)
        picture.texts.emplace_back("deltasplat:" + name, text);
    return encodePng(picture);
}

}  // namespace

ImageFormat imageFormatOf(const std::filesystem::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    if (extension == ".exr") return ImageFormat::kExr;
    if (extension == ".png") return ImageFormat::kPng;
    if (extension == ".tif" || extension == ".tiff") return ImageFormat::kTiff;
    if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::kJpeg;
    if (extension == ".npy") return ImageFormat::kNpy;
    if (extension == ".nrrd") return ImageFormat::kNrrd;
    if (extension == ".mha") return ImageFormat::kMetaImage;
    throw Error(ErrorCode::kUsage, file.string(), "extension \"" + file.extension().string() + "\"",
                ".exr, .png, .tif or .jpg (numbers: .npy, .nrrd or .mha)");
}

bool isOfNumbers(ImageFormat format) {
    return format == ImageFormat::kNpy || format == ImageFormat::kNrrd ||
           format == ImageFormat::kMetaImage;
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
        throw Error(ErrorCode::kUsage, file.string(), got, "at least 1x1");
    }
    const ImageFormat format = imageFormatOf(file);
    if (format == ImageFormat::kExr) return encodeExr(file, image, options);
    if (isOfNumbers(format)) return encodeNumbers(file, image, options);
    // PNG needs no module, and all threads pack it.
    if (format == ImageFormat::kPng) {
        return options.bits == 16 ? encodePng<std::uint16_t>(image, options)
                                  : encodePng<std::uint8_t>(image, options);
    }
    return imageModule().encodeImage(file, image, options);
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
