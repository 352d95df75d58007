// SPDX-License-Identifier: Apache-2.0
#include "modules/load_early.h"

#include <system_error>

#include "base/text.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/threads.h"
#include "modules/image_module.h"

namespace deltasplat {

namespace {

// @param load  may throw
std::jthread beside(void (*load)()) {
    // Under a limit what is taken when must not depend on threads.
    if (threadCount() < 2 || memoryLimit() != 0) return {};
    try {
        return std::jthread([load] {
            try {
                load();
            } catch (...) {
                // Whoever needs it is told.
            }
        });
    } catch (const std::system_error&) {
        return {};
    }
}

}  // namespace

std::jthread loadEarly(const std::filesystem::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    if (extension.starts_with(".tif") || extension == ".jpg" || extension == ".jpeg")
        return beside([] { imageModule(); });
    return {};
}

}  // namespace deltasplat
