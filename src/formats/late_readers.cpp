// SPDX-License-Identifier: Apache-2.0
// Functions that a module does, and nothing besides.
#include "formats/cameras/motion.h"
#include "formats/readers.h"
#include "modules/image_module.h"

namespace deltasplat {

CameraMotion readExrCamera(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readExrCamera(file, listener);
}

DenseSource openImages(const std::filesystem::path& input, const std::string& name,
                       const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                       const Listener& listener) {
    return imageModule().openImages(input, name, files, options, listener);
}

}  // namespace deltasplat
