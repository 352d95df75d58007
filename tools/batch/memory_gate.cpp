// SPDX-License-Identifier: Apache-2.0
#include "batch/memory_gate.h"

#include <algorithm>

namespace deltasplat {

MemoryGate::Pass::Pass(MemoryGate& gate, std::uint64_t bytes)
    : gate_(gate), bytes_(std::min(bytes, gate.most_)) {
    std::unique_lock lock(gate_.mutex_);
    const std::uint64_t number = gate_.next_++;
    gate_.changed_.wait(lock, [&] {
        return gate_.served_ == number &&
               (gate_.taken_ == 0 || gate_.taken_ + bytes_ <= gate_.most_);
    });
    ++gate_.served_;
    gate_.taken_ += bytes_;
    gate_.changed_.notify_all();
}

MemoryGate::Pass::~Pass() {
    const std::lock_guard lock(gate_.mutex_);
    gate_.taken_ -= bytes_;
    gate_.changed_.notify_all();
}

double MemoryGate::Pass::share() const {
    return gate_.most_ > 0 ? double(bytes_) / double(gate_.most_) : 1;
}

}  // namespace deltasplat
