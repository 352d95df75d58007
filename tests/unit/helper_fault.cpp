// SPDX-License-Identifier: Apache-2.0
// A module of the helper that does to it what foreign libraries do: what a request says.
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string>

#include "helper_work.h"

namespace {

bool takeMemory(std::size_t mebibytes) {
    void* const taken = std::malloc(mebibytes << 20);
    if (taken) std::memset(taken, 1, 4096);
    std::free(taken);
    return taken != nullptr;
}

[[noreturn]] void endWhileHandling() {
    try {
        throw std::runtime_error("a {b}");
    } catch (...) {
        std::terminate();
    }
}

bool doFault(const std::string& what) {
    if (what == "abort") ::abort();
    if (what == "exit") ::_exit(0);
    if (what == "kill") ::raise(SIGKILL);
    if (what == "throw 1") throw 1;
    if (what == "throw") throw std::runtime_error("a {b}");
    if (what == "throw much") throw std::runtime_error(std::string(9000, 'x'));
    if (what == "terminate while handling") endWhileHandling();
    if (what == "take 16 MiB") return takeMemory(16);
    if (what == "take 2 GiB") return takeMemory(2048);
    while (what == "pause") ::pause();
    return false;
}

std::string answerTo(const std::string& what) {
    rlimit seconds{};
    ::getrlimit(RLIMIT_CPU, &seconds);
    if (what == "seconds") return std::to_string(seconds.rlim_cur);
    // One is that of the folder.
    if (what == "descriptors")
        return std::to_string(
            std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
    return std::to_string(::getpid());
}

}  // namespace

bool deltasplat_helper_work(std::string_view request, std::string& answer,
                            deltasplat::HelperNote note) {
    constexpr std::size_t kAnswer = 16;
    const std::string what(request);
    answer = answerTo(what);
    answer.resize(kAnswer, '\0');
    if (what == "process" || what == "seconds" || what == "descriptors") return true;
    note("at " + what + ": ");
    return doFault(what);
}
