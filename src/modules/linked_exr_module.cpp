// SPDX-License-Identifier: Apache-2.0
#include "modules/exr_module.h"

namespace deltasplat {

const ExrModule& exrModule() {
    return exr_module::kModule;
}

}  // namespace deltasplat
