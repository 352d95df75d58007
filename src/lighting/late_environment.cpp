// SPDX-License-Identifier: Apache-2.0
// Functions that a module does, and nothing besides.
#include "deltasplat/optics/environment.h"
#include "modules/image_module.h"

namespace deltasplat {

Environment readEnvironment(const std::filesystem::path& file, const Listener& listener) {
    return imageModule().readEnvironment(file, listener);
}

}  // namespace deltasplat
