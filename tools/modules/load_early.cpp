// SPDX-License-Identifier: Apache-2.0
#include "modules/load_early.h"

#include <system_error>

#include "deltasplat/threads.h"
#include "lower_case.h"
#include "modules/exr_module.h"
#include "modules/image_module.h"

namespace deltasplat {

std::jthread loadEarly(const std::filesystem::path& picture) {
    const std::string extension = lowerCase(picture.extension().string());
    const bool isExr = extension == ".exr";
    const bool isLoaded =
        isExr || extension.starts_with(".tif") || extension == ".jpg" || extension == ".jpeg";
    if (!isLoaded || threadCount() < 2) return {};
    try {
        return std::jthread([isExr] {
            try {
                isExr ? void(exrModule()) : void(imageModule());
            } catch (...) {
                // Whoever needs it is told.
            }
        });
    } catch (const std::system_error&) {
        return {};
    }
}

}  // namespace deltasplat
