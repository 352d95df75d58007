// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Loads `name`.so, which lies where modules do; its symbols can be asked for by dlsym.
/// @param binding  RTLD_NOW, or RTLD_LAZY where libraries have thousands of functions
/// @throw Error(kFailed) if it is missing, of another version than the program, or another module
void* openModule(const char* name, int binding);

}  // namespace deltasplat
