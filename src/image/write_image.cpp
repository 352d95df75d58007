// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/write_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <string_view>

#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "exr_threads.h"
#include "image/quantize.h"
#include "lower_case.h"
#include "printable.h"

namespace deltasplat {
namespace {

enum class Format { kExr, kPng };

Format formatOf(const std::filesystem::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    if (extension == ".exr") return Format::kExr;
    if (extension == ".png") return Format::kPng;
    throw Error(ErrorCode::kUsage,
                gotExpected(file.string(), "extension \"" + file.extension().string() + "\"",
                            ".exr or .png"));
}

void checkOptions(const std::filesystem::path& file, glm::ivec2 size,
                  const ImageFileOptions& options) {
    const Format format = formatOf(file);
    if (options.bits != 8 && options.bits != 16) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("`bits`", std::to_string(options.bits), "8 or 16"));
    }
    if (options.floatExr && format != Format::kExr) {
        throw Error(ErrorCode::kUsage, gotExpected("`floatExr`", file.string(), "an .exr file"));
    }
    if (format == Format::kPng && (size.x > kMaxPngSide || size.y > kMaxPngSide)) {
        throw Error(
            ErrorCode::kUsage,
            gotExpected("`image.size`", std::to_string(size.x) + "x" + std::to_string(size.y),
                        "sides of at most " + std::to_string(kMaxPngSide) + " pixels in a .png"));
    }
}

OIIO::ImageSpec makeSpec(const Image& image, OIIO::TypeDesc type, const ImageFileOptions& options) {
    OIIO::ImageSpec spec(image.size.x, image.size.y, 4, type);
    spec.channelnames = {"R", "G", "B", "A"};
    spec.alpha_channel = 3;
    for (const auto& [name, text] : options.metadata) spec.attribute("deltasplat:" + name, text);
    return spec;
}

void setMatrix(OIIO::ImageSpec& spec, const char* name, const glm::dmat4& matrix) {
    // OpenEXR multiplies row vectors and stores rows, GLM multiplies columns and stores columns:
    // the transposed matrix stored the other way round is the same sixteen numbers.
    const glm::mat4 rounded(matrix);
    spec.attribute(name, OIIO::TypeMatrix, glm::value_ptr(rounded));
}

// Encodes in memory, so that what can go wrong with the disk goes wrong in one place.
std::string encode(const std::filesystem::path& file, const char* formatName,
                   const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
    OIIO::Filesystem::IOVecOutput memory;
    limitExrThreads();
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(formatName);
    if (!output) {
        const std::string why = printable(OIIO::geterror());
        throw Error(ErrorCode::kFailed,
                    file.string() + ": cannot be encoded: " +
                        (why.empty() ? "OpenImageIO's writer cannot be started" : why));
    }
    output->threads(threadCount());
    const bool written = output->set_ioproxy(&memory) && output->open(file.string(), spec) &&
                         output->write_image(type, pixels) && output->close();
    if (!written) {
        throw Error(ErrorCode::kOutput,
                    file.string() + ": cannot be encoded: " + printable(output->geterror()));
    }
    const std::vector<unsigned char>& bytes = memory.buffer();
    return {bytes.begin(), bytes.end()};
}

std::string encodeExr(const std::filesystem::path& file, const Image& image,
                      const ImageFileOptions& options) {
    const OIIO::TypeDesc type = options.floatExr ? OIIO::TypeFloat : OIIO::TypeHalf;
    OIIO::ImageSpec spec = makeSpec(image, type, options);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    // Without a date OpenImageIO stores the clock time (as capDate).
    spec.attribute("DateTime", "");
    if (options.cameraFromWorld) setMatrix(spec, "worldToCamera", *options.cameraFromWorld);
    if (options.ndcFromWorld) setMatrix(spec, "worldToNDC", *options.ndcFromWorld);
    return encode(file, "openexr", spec, OIIO::TypeFloat,
                  finiteValues(image, options.floatExr).data());
}

template <typename Sample>
std::string encodePng(const std::filesystem::path& file, const Image& image, OIIO::TypeDesc type,
                      const ImageFileOptions& options) {
    OIIO::ImageSpec spec = makeSpec(image, type, options);
    spec.attribute("oiio:ColorSpace", "sRGB");
    // The samples are final: OpenImageIO must not divide them by alpha once more.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return encode(file, "png", spec, type,
                  straightSrgb<Sample>(image, options.dither && sizeof(Sample) == 1).data());
}

}  // namespace

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
        const std::string got =
            std::to_string(image.size.x) + "x" + std::to_string(image.size.y) + " pixels";
        throw Error(ErrorCode::kUsage, gotExpected(file.string(), got, "at least 1x1"));
    }
    if (formatOf(file) == Format::kExr) return encodeExr(file, image, options);
    return options.bits == 16 ? encodePng<std::uint16_t>(file, image, OIIO::TypeUInt16, options)
                              : encodePng<std::uint8_t>(file, image, OIIO::TypeUInt8, options);
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
