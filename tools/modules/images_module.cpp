// SPDX-License-Identifier: Apache-2.0
#include "modules/image_module.h"

extern "C" const deltasplat::ImageModule* deltasplat_module() {
    return &deltasplat::image_module::kModule;
}
