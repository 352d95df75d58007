// SPDX-License-Identifier: Apache-2.0
#include "modules/medical_module.h"

extern "C" const deltasplat::MedicalModule* deltasplat_module() {
    return &deltasplat::medical_module::kModule;
}
