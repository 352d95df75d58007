// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

#include "base/cgroup.h"
#include "deltasplat/error.h"
#include "deltasplat/memory_limit.h"

namespace deltasplat {

namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

std::atomic<std::uint64_t> limit = 0;  // as setMemoryLimit says

struct OwnMemory {
    std::uint64_t addresses = 0;  // bytes
    std::uint64_t resident = 0;   // bytes
};

// What the process holds now: the first two numbers of its statm, in pages.
OwnMemory ownMemory() {
    std::ifstream in("/proc/self/statm");
    OwnMemory own;
    in >> own.addresses >> own.resident;
    const auto page = std::uint64_t(sysconf(_SC_PAGESIZE));
    return {own.addresses * page, own.resident * page};
}

std::uint64_t limitAvailable() {
    const std::uint64_t most = limit;
    if (most == 0) return kNoLimit;
    const std::uint64_t taken = ownMemory().resident;
    return most > taken ? most - taken : 0;
}

// What `ulimit -v` leaves.
std::uint64_t addressesAvailable() {
    rlimit most{};
    if (::getrlimit(RLIMIT_AS, &most) != 0 || most.rlim_cur == RLIM_INFINITY) return kNoLimit;
    const std::uint64_t taken = ownMemory().addresses;
    return most.rlim_cur > taken ? most.rlim_cur - taken : 0;
}

std::uint64_t unusedMemory() {
    std::ifstream in("/proc/meminfo");
    for (std::string line; std::getline(in, line);) {
        unsigned long long kib = 0;
        if (std::sscanf(line.c_str(), "MemAvailable: %llu kB", &kib) == 1) return kib * 1024;
    }
    return kNoLimit;
}

std::uint64_t systemAvailable() {
    return std::min({addressesAvailable(), unusedMemory(), cgroupAvailable("/")});
}

// Asking the system takes longer than some pictures: it is asked again when a small share of what
// there was has been granted since, or each time where little was left.
constexpr std::uint64_t kLittle = 64 << 20;
constexpr double kShare = 32;
constexpr std::uint64_t kMost = 512 << 20;
std::atomic<std::uint64_t> mayBeGranted = kLittle;
std::atomic<std::uint64_t> grantedUnasked = 0;

bool isLittle(double bytes) {
    if (bytes > double(mayBeGranted)) return false;
    const auto whole = std::uint64_t(bytes);
    return grantedUnasked.fetch_add(whole) + whole <= mayBeGranted;
}

void noteAvailable(double bytes) {
    const auto share = std::uint64_t(std::min(bytes / kShare, double(kMost)));
    mayBeGranted = bytes < double(kLittle) ? 0 : std::max(kLittle, share);
    grantedUnasked = 0;
}

void require(ErrorCode code, const std::string& what, double bytes) {
    const double left = double(limitAvailable());
    if (bytes <= left && isLittle(bytes)) return;
    const double available = std::min(left, double(systemAvailable()));
    noteAvailable(std::max(0.0, available - bytes));
    if (bytes <= available) return;
    throw Error(code, what + ": needs " + humanBytes(bytes) + " of memory; expected at most " +
                          humanBytes(available) + ", which " +
                          (available == left ? "`memoryLimit` leaves (the program takes " +
                                                   humanBytes(double(ownMemory().resident)) + ")"
                                             : "is available"));
}

}  // namespace

void setMemoryLimit(std::uint64_t bytes) {
    limit = bytes;
}

std::uint64_t memoryLimit() {
    return limit;
}

std::uint64_t availableMemory() {
    return std::min(limitAvailable(), systemAvailable());
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
    require(ErrorCode::kFailed, what, bytes);
}

void requireClaimedMemory(const std::string& what, double bytes) {
    require(ErrorCode::kInput, what, bytes);
}

#ifdef __GLIBC__
void expectPieces(std::size_t bytes) {
    // Where it does not fit into what is left of the 64 MiB that are mapped at a time, nothing is
    // gained: small beside those.
    constexpr std::size_t kStep = std::size_t{1} << 20;
    thread_local std::size_t left = 0;
    if (bytes <= left) {
        left -= bytes;
        return;
    }
    left = kStep > bytes ? kStep - bytes : 0;
    // What is given back stays the heap's, for it is less than what goes back to the system. (Where
    // the piece was mapped by itself, glibc maps none of its size any more once it is back.) No
    // compiler may leave this out.
    void* volatile step = std::malloc(kStep);
    std::free(step);
}
#else
void expectPieces(std::size_t) {}
#endif

}  // namespace deltasplat
