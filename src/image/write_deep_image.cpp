// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/write_deep_image.h"

#include <string>

#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "dims_text.h"
#include "image/exr_files.h"
#include "memory.h"

namespace deltasplat {
namespace {

// The encoded samples, and their copy as the string of them grows: each takes no more than the
// samples do.
constexpr double kEncodedCopies = 2;

void requireExr(const std::filesystem::path& file) {
    if (imageFormatOf(file) == ImageFormat::kExr) return;
    throw Error(ErrorCode::kUsage, gotExpected(file.string(), "a deep picture", "an .exr file"));
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
        throw Error(ErrorCode::kUsage,
                    gotExpected(file.string(), dimsText(image.size) + " pixels", "at least 1x1"));
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

}  // namespace deltasplat
