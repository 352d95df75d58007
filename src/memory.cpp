// SPDX-License-Identifier: Apache-2.0
#include "memory.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "deltasplat/error.h"
#include "deltasplat/memory_limit.h"

namespace deltasplat {
namespace {

// Reads one number from a file of the kernel; the largest number if there is none ("max", no such
// file).
std::uint64_t readNumber(const char* file) {
    std::ifstream in(file);
    std::uint64_t number = 0;
    return in >> number ? number : std::numeric_limits<std::uint64_t>::max();
}

std::uint64_t limit = 0;  // as setMemoryLimit says

// What the process holds now: the second number of its statm, in pages.
std::uint64_t residentBytes() {
    std::ifstream in("/proc/self/statm");
    std::uint64_t total = 0, resident = 0;
    in >> total >> resident;
    return resident * std::uint64_t(sysconf(_SC_PAGESIZE));
}

std::uint64_t limitAvailable() {
    if (limit == 0) return std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t taken = residentBytes();
    return limit > taken ? limit - taken : 0;
}

std::uint64_t systemAvailable() {
    std::ifstream in("/proc/meminfo");
    for (std::string line; std::getline(in, line);) {
        unsigned long long kib = 0;
        if (std::sscanf(line.c_str(), "MemAvailable: %llu kB", &kib) == 1) return kib * 1024;
    }
    return std::numeric_limits<std::uint64_t>::max();
}

// Asking the system takes longer than some pictures: it is asked again when so much has been
// granted since.
constexpr std::uint64_t kLittle = 64 << 20;
std::atomic<std::uint64_t> grantedUnasked = 0;

bool isLittle(double bytes) {
    if (bytes > double(kLittle)) return false;
    const auto whole = std::uint64_t(bytes);
    if (grantedUnasked.fetch_add(whole) + whole <= kLittle) return true;
    grantedUnasked = 0;
    return false;
}

}  // namespace

void setMemoryLimit(std::uint64_t bytes) {
    limit = bytes;
}

std::uint64_t memoryLimit() {
    return limit;
}

std::uint64_t availableMemory() {
    // What a cgroup has in use counts its page cache, so only its limit is a fact.
    return std::min({limitAvailable(), systemAvailable(), readNumber("/sys/fs/cgroup/memory.max"),
                     readNumber("/sys/fs/cgroup/memory/memory.limit_in_bytes")});
}

std::string humanBytes(double bytes) {
    static const char* const kUnits[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    int unit = 0;
    while (bytes >= 1024 && unit < 6) {
        bytes /= 1024;
        ++unit;
    }
    char text[64];
    std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", bytes, kUnits[unit]);
    return text;
}

void requireMemory(const std::string& what, double bytes) {
    const double left = double(limitAvailable());
    if (bytes <= left && isLittle(bytes)) return;
    const double available = std::min(left, double(availableMemory()));
    if (bytes <= available) return;
    throw Error(ErrorCode::kUsage,
                what + ": needs " + humanBytes(bytes) + " of memory; expected at most " +
                    humanBytes(available) + ", which " +
                    (available == left ? "--max-memory leaves" : "is available"));
}

}  // namespace deltasplat
