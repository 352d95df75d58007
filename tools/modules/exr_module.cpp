// SPDX-License-Identifier: Apache-2.0
#include "modules/exr_module.h"

#include "modules/module_version.h"

extern "C" const char deltasplat_module_version[];
extern "C" const char deltasplat_module_version[] = DELTASPLAT_MODULE_VERSION DELTASPLAT_MODULE;

extern "C" const deltasplat::ExrModule* deltasplat_module() {
    return &deltasplat::exr_module::kModule;
}
