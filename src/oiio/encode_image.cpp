// SPDX-License-Identifier: Apache-2.0
#include "oiio/encode_image.h"

#include <OpenImageIO/filesystem.h>

#include <memory>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"

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

}  // namespace deltasplat
