// SPDX-License-Identifier: Apache-2.0
#include "image/encode_image.h"

#include <OpenImageIO/filesystem.h>

#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "exr_threads.h"
#include "image/memory_file.h"
#include "number_text.h"
#include "printable.h"

namespace deltasplat {
namespace {

void setMatrix(OIIO::ImageSpec& spec, const char* name, const glm::dmat4& matrix) {
    // OpenEXR multiplies row vectors and stores rows, GLM multiplies columns and stores columns:
    // the transposed matrix stored the other way round is the same sixteen numbers.
    const glm::mat4 rounded(matrix);
    spec.attribute(name, OIIO::TypeMatrix, glm::value_ptr(rounded));
}

}  // namespace

OIIO::ImageSpec rgbaSpec(glm::ivec2 size, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(size.x, size.y, 4, type);
    spec.channelnames = {"R", "G", "B", "A"};
    spec.alpha_channel = 3;
    return spec;
}

OIIO::ImageSpec exrSpec(glm::ivec2 size, const ImageFileOptions& options) {
    OIIO::ImageSpec spec = rgbaSpec(size, options.floatExr ? OIIO::TypeFloat : OIIO::TypeHalf);
    addExrAttributes(options, spec);
    return spec;
}

void addMetadata(const ImageFileOptions& options, OIIO::ImageSpec& spec) {
    for (const auto& [name, text] : options.metadata) spec.attribute("deltasplat:" + name, text);
}

void addExrAttributes(const ImageFileOptions& options, OIIO::ImageSpec& spec) {
    addMetadata(options, spec);
    const ExrOptions& exr = options.exr;
    // Of what deep pictures may have, zips packs best.
    std::string compression = !exr.compression.empty() ? exr.compression
                              : spec.deep              ? "zips"
                                                       : "zip";
    if (exr.level) compression += ":" + numberText(*exr.level);
    spec.attribute("compression", compression);
    spec.attribute("PixelAspectRatio", float(exr.pixelAspect));
    if (exr.chromaticities)
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8),
                       exr.chromaticities->data());
    spec.attribute("oiio:ColorSpace", "Linear");
    // Without a date OpenImageIO stores the clock time (as capDate).
    spec.attribute("DateTime", "");
    if (options.cameraFromWorld) setMatrix(spec, "worldToCamera", *options.cameraFromWorld);
    if (options.ndcFromWorld) setMatrix(spec, "worldToNDC", *options.ndcFromWorld);
}

void setWindows(const ExrOptions& options, glm::ivec2 sizePixels, glm::ivec2 first,
                OIIO::ImageSpec& spec) {
    const glm::ivec2 place = options.dataMin + first;
    const glm::ivec2 display = options.displaySize.value_or(sizePixels);
    spec.x = place.x;
    spec.y = place.y;
    spec.full_x = 0;
    spec.full_y = 0;
    spec.full_width = display.x;
    spec.full_height = display.y;
}

namespace {

std::unique_ptr<OIIO::ImageOutput> newOutput(const std::filesystem::path& file,
                                             const char* formatName) {
    limitExrThreads();
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

[[noreturn]] void fail(const std::filesystem::path& file, const OIIO::ImageOutput& output) {
    throw Error(ErrorCode::kOutput,
                file.string() + ": cannot be encoded: " + printable(output.geterror()));
}

// Of files that OpenImageIO 2.4 writes by their names alone, whatever it is told.
// @param write  writes all of the file of this name, or returns false
template <typename Write>
std::string encodeByName(const std::filesystem::path& file, OIIO::ImageOutput& output,
                         const Write& write) {
    const MemoryFile memory;
    if (!write(memory.name()) || !output.close()) fail(file, output);
    return memory.bytes();
}

}  // namespace

std::string encodeInMemory(const std::filesystem::path& file, const char* formatName,
                           const OIIO::ImageSpec& spec,
                           const std::function<bool(OIIO::ImageOutput&)>& writePixels) {
    const std::unique_ptr<OIIO::ImageOutput> output = newOutput(file, formatName);
    const auto write = [&](const std::string& name) {
        return output->open(name, spec) && writePixels(*output);
    };
    if (spec.deep) return encodeByName(file, *output, write);
    OIIO::Filesystem::IOVecOutput memory;
    if (!output->set_ioproxy(&memory))
        throw Error(ErrorCode::kFailed, file.string() + ": cannot be encoded in memory");
    if (!write(file.string()) || !output->close()) fail(file, *output);
    const std::vector<unsigned char>& bytes = memory.buffer();
    return {bytes.begin(), bytes.end()};
}

std::string encodeParts(const std::filesystem::path& file,
                        const std::vector<OIIO::ImageSpec>& specs,
                        const std::function<bool(OIIO::ImageOutput&, std::size_t)>& writePart) {
    const std::unique_ptr<OIIO::ImageOutput> output = newOutput(file, "openexr");
    return encodeByName(file, *output, [&](const std::string& name) {
        if (!output->open(name, int(specs.size()), specs.data())) return false;
        for (std::size_t i = 0; i < specs.size(); ++i) {
            const bool isOpen =
                i == 0 || output->open(name, specs[i], OIIO::ImageOutput::AppendSubimage);
            if (!isOpen || !writePart(*output, i)) return false;
        }
        return true;
    });
}

}  // namespace deltasplat
