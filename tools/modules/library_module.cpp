// SPDX-License-Identifier: Apache-2.0
// A module that brings a library along, which it is linked with; the program calls the library's
// own functions (late_calls.S).
#include "modules/module_version.h"

extern "C" const char deltasplat_module_version[];
extern "C" const char deltasplat_module_version[] = DELTASPLAT_MODULE_VERSION DELTASPLAT_MODULE;
