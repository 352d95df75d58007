// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "base/text.h"
#include "deltasplat/simd.h"

namespace deltasplat {
namespace {

// Returns what follows the separator on the first line of a file that begins with `key`.
std::string fieldOf(const char* file, const std::string& key, char separator) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(key)) continue;
        const std::size_t begin = line.find_first_not_of(" \t\"", line.find(separator) + 1);
        const std::size_t end = line.find_last_not_of(" \t\"");
        if (begin != std::string::npos && begin <= end)
            return printable(line.substr(begin, end + 1 - begin));
    }
    return "";
}

std::string cpuName(const utsname& system) {
    const std::string model = fieldOf("/proc/cpuinfo", "model name", ':');
    // ARM processors do not tell their model.
    return model.empty() ? std::string(system.machine) + " processor" : model;
}

std::string osName(const utsname& system) {
    const std::string distribution = fieldOf("/etc/os-release", "PRETTY_NAME", '=');
    // The number alone: what follows it may name who built the kernel, and where.
    const std::string release = system.release;
    const std::string kernel = std::string(system.sysname) + " " +
                               release.substr(0, release.find_first_not_of("0123456789."));
    return distribution.empty() ? kernel : distribution + ", " + kernel;
}

std::uint64_t physicalMemory() {
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && bytes > 0 ? std::uint64_t(pages) * std::uint64_t(bytes) : 0;
}

std::string compilerName() {
#ifdef __clang__
    return "Clang " __clang_version__;
#else
    return "GCC " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
           std::to_string(__GNUC_PATCHLEVEL__);
#endif
}

}  // namespace

Machine thisMachine() {
    utsname system{};
    uname(&system);
    Machine machine;
    machine.cpu = cpuName(system);
    machine.logicalCores = int(std::thread::hardware_concurrency());
    machine.simd = simdLevel();
    machine.memoryBytes = physicalMemory();
    machine.os = osName(system);
    machine.compiler = compilerName();
    return machine;
}

}  // namespace deltasplat
