// SPDX-License-Identifier: Apache-2.0
// Where late_calls.S learns what to call.
#include <dlfcn.h>

#include <atomic>
#include <map>
#include <mutex>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "modules/load_modules.h"

namespace deltasplat {
namespace {

// As late_calls.S lays it out.
struct LateCall {
    std::atomic<void*> function;
    const char* name;
    const char* module;
};
static_assert(sizeof(LateCall) == 24 && std::atomic<void*>::is_always_lock_free);

void* opened(const std::string& module) {
    static std::mutex mutex;
    static std::map<std::string, void*> libraries;
    const std::lock_guard lock(mutex);
    void*& library = libraries[module];
    if (!library) library = openModule(module.c_str(), RTLD_LAZY);
    return library;
}

}  // namespace

// Called by late_calls.S; what it throws passes through to who called the function.
extern "C" void* deltasplat_bind_late_call(LateCall* call);
extern "C" void* deltasplat_bind_late_call(LateCall* call) {
    void* const function = ::dlsym(opened(call->module), call->name);
    if (!function) {
        const char* const why = ::dlerror();
        throw Error(ErrorCode::kFailed, std::string("module ") + call->module,
                    printable(why ? why : "nothing"),
                    "the library that the program was built with");
    }
    call->function.store(function, std::memory_order_release);
    return function;
}

}  // namespace deltasplat
