// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Loads `name`.so, which lies where modules do; its symbols can be asked for by dlsym.
/// @throw Error(kFailed) if it is missing, or of another version than the program
void* openModule(const char* name);

}  // namespace deltasplat
