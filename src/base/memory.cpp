// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

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

// Based on: Linux manual pages cgroups(7), proc_pid_cgroup(5), proc_pid_mountinfo(5);
// Documentation/admin-guide/cgroup-v1/memory.rst and cgroup-v2.rst and
// Documentation/scheduler/sched-bwc.rst of the kernel.
namespace {

namespace fs = std::filesystem;

// How the two versions call the same things.
struct Version {
    const char* fileSystem;
    const char* limit;
    const char* usage;
    const char* statPrefix;  // of what counts the groups within as well
};
constexpr Version kVersion1{"cgroup", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_"};
constexpr Version kVersion2{"cgroup2", "memory.max", "memory.current", ""};

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// Reads a file's one number; nothing if there is none ("max", no such file).
std::optional<std::uint64_t> readNumber(const fs::path& file) {
    std::ifstream in(file);
    std::uint64_t number = 0;
    return in >> number ? std::optional(number) : std::nullopt;
}

// What of a group's memory is page cache.
std::uint64_t pageCache(const fs::path& group, const std::string& prefix) {
    std::ifstream in(group / "memory.stat");
    std::uint64_t sum = 0, bytes = 0;
    for (std::string key; in >> key >> bytes;) {
        if (key == prefix + "active_file" || key == prefix + "inactive_file") sum += bytes;
    }
    return sum;
}

std::uint64_t leftInGroup(const fs::path& group, const Version& version) {
    const std::optional<std::uint64_t> limit = readNumber(group / version.limit);
    if (!limit) return kNoLimit;
    const std::uint64_t usage = readNumber(group / version.usage).value_or(0);
    const std::uint64_t fixed = usage - std::min(usage, pageCache(group, version.statPrefix));
    return *limit - std::min(*limit, fixed);
}

// Processors of a group's time, or as many as there can be.
int processorsOf(const fs::path& group, const Version& version) {
    constexpr int kMost = std::numeric_limits<int>::max();
    std::optional<std::uint64_t> quota, period;
    if (&version == &kVersion1) {
        // Without a limit the quota is -1.
        std::ifstream in(group / "cpu.cfs_quota_us");
        std::int64_t number = 0;
        if (in >> number && number > 0) quota = std::uint64_t(number);
        period = readNumber(group / "cpu.cfs_period_us");
    } else {
        // "200000 100000", or "max 100000".
        std::ifstream in(group / "cpu.max");
        std::uint64_t first = 0, second = 0;
        if (in >> first >> second) quota = first, period = second;
    }
    if (!quota || !period || *period == 0) return kMost;
    const std::uint64_t whole = *quota / *period + (*quota % *period != 0 ? 1 : 0);
    return int(std::clamp<std::uint64_t>(whole, 1, kMost));
}

// Returns the path of the process within the hierarchy of a controller.
std::optional<std::string> ownPath(const fs::path& root, const Version& version,
                                   const std::string& controller) {
    std::ifstream in(root / "proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        // "4:memory,cpu:/a/b", in the second version "0::/a/b"; a path may hold colons.
        const std::size_t first = line.find(':');
        const std::size_t second = first == line.npos ? first : line.find(':', first + 1);
        if (second == line.npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const bool isOne = &version == &kVersion1;
        if (isOne ? contains(split(controllers, ','), controller) : line.rfind("0::", 0) == 0)
            return line.substr(second + 1);
    }
    return {};
}

// Undoes the kernel's way to write blanks and the like: "\040".
std::string unescaped(const std::string& text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && i + 3 < text.size()) {
            plain += char((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8 + (text[i + 3] - '0'));
            i += 3;
        } else {
            plain += text[i];
        }
    }
    return plain;
}

struct Mount {
    std::string root;  // what of the hierarchy is to be seen at
    std::string point;
};

std::optional<Mount> findMount(const fs::path& root, const Version& version,
                               const std::string& controller) {
    std::ifstream in(root / "proc/self/mountinfo");
    for (std::string line; std::getline(in, line);) {
        const std::size_t dash = line.find(" - ");
        if (dash == line.npos) continue;
        const std::vector<std::string> where = split(line.substr(0, dash), ' ');
        const std::vector<std::string> what = split(line.substr(dash + 3), ' ');
        if (where.size() < 5 || what.size() < 3 || what[0] != version.fileSystem) continue;
        if (&version == &kVersion1 && !contains(split(what[2], ','), controller)) continue;
        return Mount{unescaped(where[3]), unescaped(where[4])};
    }
    return {};
}

// Returns where, below the mount, the group of the process is. What is not to be seen there, as in
// a container, is what the mount point itself stands for.
std::string below(const Mount& mount, const std::string& path) {
    const std::string start = mount.root == "/" ? "" : mount.root;
    const bool inside = path.compare(0, start.size(), start) == 0 &&
                        (path.size() == start.size() || path[start.size()] == '/');
    return inside && path.find("/..") == path.npos ? path.substr(start.size()) : "";
}

// Calls visit(group) for all groups that the process is in, from the outermost on.
void forGroups(const fs::path& root, const Version& version, const std::string& controller,
               const std::function<void(const fs::path& group)>& visit) {
    const std::optional<std::string> path = ownPath(root, version, controller);
    const std::optional<Mount> mount = findMount(root, version, controller);
    if (!path || !mount) return;
    fs::path group = root / fs::path(mount->point).relative_path();
    visit(group);
    for (const fs::path& name : fs::path(below(*mount, *path)).relative_path()) {
        group /= name;
        visit(group);
    }
}

}  // namespace

std::uint64_t cgroupAvailable(const fs::path& root) {
    std::uint64_t left = kNoLimit;
    for (const Version* version : {&kVersion1, &kVersion2}) {
        forGroups(root, *version, "memory", [&](const fs::path& group) {
            left = std::min(left, leftInGroup(group, *version));
        });
    }
    return left;
}

int cgroupProcessors(const fs::path& root) {
    int processors = std::numeric_limits<int>::max();
    for (const Version* version : {&kVersion1, &kVersion2}) {
        forGroups(root, *version, "cpu", [&](const fs::path& group) {
            processors = std::min(processors, processorsOf(group, *version));
        });
    }
    return processors;
}

}  // namespace deltasplat
