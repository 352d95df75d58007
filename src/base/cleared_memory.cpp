// SPDX-License-Identifier: Apache-2.0
#include "base/cleared_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <atomic>
#include <mutex>

namespace deltasplat {
namespace {

#ifdef __GLIBC__
// What malloc writes to memory that it gives away is the complement of this; 0: nothing.
void fillBy(int byte) {
    mallopt(M_PERTURB, byte);
}
#else
void fillBy(int) {}
#endif

// What the environment asked for, as those do who look for unwritten memory.
int usualByte() {
    const char* const text = std::getenv("MALLOC_PERTURB_");
    return text == nullptr ? 0 : std::atoi(text);
}

std::mutex& guard() {
    static std::mutex mutex;
    return mutex;
}
std::atomic<int> lives = 0;

}  // namespace

ClearedMemory::ClearedMemory() {
    const std::lock_guard lock(guard());
    if (lives++ == 0) fillBy(0xff);
}

ClearedMemory::~ClearedMemory() {
    const std::lock_guard lock(guard());
    if (--lives == 0) fillBy(usualByte());
}

bool ClearedMemory::isWritten() {
    return lives > 0 || usualByte() != 0;
}

}  // namespace deltasplat
