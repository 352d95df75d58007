// SPDX-License-Identifier: Apache-2.0
#include "process/leave_to_system.h"

#include <mutex>
#include <utility>
#include <vector>

namespace deltasplat {

void leaveToSystem(std::shared_ptr<const void> kept) {
    static std::mutex mutex;
    static auto* const all = new std::vector<std::shared_ptr<const void>>;
    const std::lock_guard lock(mutex);
    all->push_back(std::move(kept));
}

}  // namespace deltasplat
