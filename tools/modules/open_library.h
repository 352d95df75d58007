// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

namespace deltasplat {

#ifdef DELTASPLAT_LATE_OPENVDB
/// Does what dlopen does. An exception that a library throws while it is loaded, as where a thread
/// of its own cannot be started, ends the program with what it says (process/terminate.h): nothing
/// of a library that is half made is taken apart, for that has hung.
extern "C" void* deltasplat_dlopen(const char* file, int mode);  // late_calls.S
inline void* openLibrary(const char* file, int mode) {
    return deltasplat_dlopen(file, mode);
}
#else
inline void* openLibrary(const char* file, int mode) {
    return ::dlopen(file, mode);
}
#endif

}  // namespace deltasplat
