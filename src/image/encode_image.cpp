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

void addMetadata(const ImageFileOptions& options, OIIO::ImageSpec& spec) {
    for (const auto& [name, text] : options.metadata) spec.attribute("deltasplat:" + name, text);
}

void addExrAttributes(const ImageFileOptions& options, OIIO::ImageSpec& spec) {
    addMetadata(options, spec);
    spec.attribute("oiio:ColorSpace", "Linear");
    // Without a date OpenImageIO stores the clock time (as capDate).
    spec.attribute("DateTime", "");
    if (options.pixelAspect != 1)
        spec.attribute("PixelAspectRatio", float(options.pixelAspect));
    if (options.cameraFromWorld) setMatrix(spec, "worldToCamera", *options.cameraFromWorld);
    if (options.ndcFromWorld) setMatrix(spec, "worldToNDC", *options.ndcFromWorld);
}

std::string encodeInMemory(const std::filesystem::path& file, const char* formatName,
                           const OIIO::ImageSpec& spec,
                           const std::function<bool(OIIO::ImageOutput&)>& writePixels) {
    limitExrThreads();
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(formatName);
    if (!output) {
        const std::string why = printable(OIIO::geterror());
        throw Error(ErrorCode::kFailed,
                    file.string() + ": cannot be encoded: " +
                        (why.empty() ? "OpenImageIO's writer cannot be started" : why));
    }
    output->threads(threadCount());
    const auto write = [&](const std::string& name) {
        if (output->open(name, spec) && writePixels(*output) && output->close()) return;
        throw Error(ErrorCode::kOutput,
                    file.string() + ": cannot be encoded: " + printable(output->geterror()));
    };
    // Deep pictures go to the file that is named, whatever OpenImageIO 2.4 is told.
    if (spec.deep) {
        const MemoryFile memory;
        write(memory.name());
        return memory.bytes();
    }
    OIIO::Filesystem::IOVecOutput memory;
    if (!output->set_ioproxy(&memory))
        throw Error(ErrorCode::kFailed, file.string() + ": cannot be encoded in memory");
    write(file.string());
    const std::vector<unsigned char>& bytes = memory.buffer();
    return {bytes.begin(), bytes.end()};
}

}  // namespace deltasplat
