// SPDX-License-Identifier: Apache-2.0
#include "process/terminate.h"

#include <unistd.h>

#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "deltasplat/atomic_file.h"
#include "flag_names.h"

namespace deltasplat {
namespace {

std::atomic<int> exitCode{1};

std::string currentProblem() {
    try {
        std::rethrow_exception(std::current_exception());
    } catch (const std::exception& problem) {
        return describe(problem);
    } catch (...) {
        return "an unknown failure";
    }
}

[[noreturn]] void fail() {
    removeTemporaryFiles();
    const std::string what = std::current_exception() ? currentProblem() : "an unknown failure";
    const std::string line = "deltasplat: " + withFlagNames(what) + "\n";
    (void)!::write(STDERR_FILENO, line.data(), line.size());
    ::_exit(exitCode);
}

// Libraries start threads while they are loaded (log4cplus, which OpenVDB may be linked with), and
// that is before anything of ours but what stands here.
void failInsteadOfAborting(int, char**, char**) {
    std::set_terminate(fail);
}
#ifdef __linux__
[[gnu::section(".preinit_array"),
  gnu::used]] void (*const beforeLibraries)(int, char**, char**) = failInsteadOfAborting;
#endif

}  // namespace

std::string describe(const std::exception& problem) {
    const std::string what = problem.what();
    const std::string unavailable =
        std::make_error_condition(std::errc::resource_unavailable_try_again).message();
    if (what.find(unavailable) == std::string::npos) return what;
    return "a thread cannot be started: " + what + " (limits: ulimit -u, ulimit -v, pids.max)";
}

void setTerminateExitCode(int code) {
    exitCode = code;
}

int startableThreads(int most) {
    std::mutex gate;
    std::unique_lock closed(gate);
    std::vector<std::thread> threads;
    try {
        while (int(threads.size()) < most)
            threads.emplace_back([&] { const std::lock_guard wait(gate); });
    } catch (const std::system_error&) {
        // So many there are.
    }
    const int count = int(threads.size());
    closed.unlock();
    for (std::thread& thread : threads) thread.join();
    return count;
}

}  // namespace deltasplat
