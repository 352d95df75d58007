// SPDX-License-Identifier: Apache-2.0
// Where late_calls.S learns what to call.
#include "modules/late_openvdb.h"

#include <dlfcn.h>

#include <atomic>

#include "deltasplat/error.h"
#include "modules/load_modules.h"
#include "printable.h"

namespace deltasplat {
namespace {

// As late_calls.S lays it out.
struct LateCall {
    std::atomic<void*> function;
    const char* name;
};
static_assert(sizeof(LateCall) == 16 && std::atomic<void*>::is_always_lock_free);

void* openVdb() {
    static void* const library = openModule("openvdb");
    return library;
}

}  // namespace

void loadOpenVdb() {
    openVdb();
}

// Called by late_calls.S; what it throws passes through to who called the function.
extern "C" void* deltasplat_bind_late_call(LateCall* call);
extern "C" void* deltasplat_bind_late_call(LateCall* call) {
    void* const function = ::dlsym(openVdb(), call->name);
    if (!function) {
        const char* const why = ::dlerror();
        throw Error(ErrorCode::kFailed,
                    gotExpected("module openvdb", printable(why ? why : "nothing"),
                                "the OpenVDB library that the program was built with"));
    }
    call->function.store(function, std::memory_order_relaxed);
    return function;
}

}  // namespace deltasplat
