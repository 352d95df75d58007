// SPDX-License-Identifier: Apache-2.0

#include "modules/image_module.h"

namespace deltasplat {

const ImageModule& imageModule() {
    return image_module::kModule;
}

}  // namespace deltasplat
