// SPDX-License-Identifier: Apache-2.0
#include "image/whole_image.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <exception>
#include <vector>

#include "deltasplat/error.h"
#include "exr_threads.h"
#include "ingest/guards/silent_stderr.h"
#include "ingest/images/image_claims.h"
#include "ingest/images/image_file.h"
#include "modules/image_module.h"

namespace deltasplat {
namespace {

bool isReadable(const std::filesystem::path& file, OIIO::ImageInput& input) {
    const OIIO::ImageSpec spec = input.spec();
    if (spec.deep) {
        OIIO::DeepData pixels;
        return input.read_native_deep_image(0, 0, pixels);
    }
    requireSane(file, spec);
    std::vector<char> pixels(spec.image_bytes(true));
    return input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeUnknown, pixels.data());
}

}  // namespace

bool image_module::isWholeImage(const std::filesystem::path& file) {
    bool isWhole = false;
    const SilentStderr silent;
    try {
        limitExrThreads(requireClaims(file));
        const auto input = OIIO::ImageInput::open(file.string());
        isWhole = input && isReadable(file, *input) && !input->has_error();
        if (input) (void)input->geterror();
    } catch (const std::exception&) {
        isWhole = false;
    }
    // What is not asked for is printed when the thread ends.
    (void)OIIO::geterror();
    return isWhole;
}

}  // namespace deltasplat
