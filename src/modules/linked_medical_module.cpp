// SPDX-License-Identifier: Apache-2.0
#include "modules/medical_module.h"

namespace deltasplat {

const MedicalModule& medicalModule() {
    return medical_module::kModule;
}

}  // namespace deltasplat
