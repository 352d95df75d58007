// SPDX-License-Identifier: Apache-2.0
#include "base/in_child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

#include "base/memory.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

// Memory that parent and child both see.
class SharedBytes {
  public:
    explicit SharedBytes(std::size_t bytes) : bytes_(bytes) {
        void* const place =
            ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (place == MAP_FAILED) throw std::bad_alloc();
        place_ = static_cast<std::byte*>(place);
    }
    ~SharedBytes() { ::munmap(place_, bytes_); }
    SharedBytes(const SharedBytes&) = delete;
    SharedBytes& operator=(const SharedBytes&) = delete;
    std::byte* get() const { return place_; }

  private:
    std::size_t bytes_;
    std::byte* place_ = nullptr;
};

void limit(int what, rlim_t most, rlim_t atLast) {
    const rlimit limits{most, atLast};
    ::setrlimit(what, &limits);
}

// Lets this process take so many bytes of addresses besides those that it has.
void limitMemory(std::uint64_t most) {
    std::ifstream in("/proc/self/statm");
    std::uint64_t pages = 0;
    if (!(in >> pages)) return;
    const rlim_t limits = pages * std::uint64_t(::sysconf(_SC_PAGESIZE)) + most;
    rlimit before{};
    if (::getrlimit(RLIMIT_AS, &before) != 0 || before.rlim_cur <= limits) return;
    limit(RLIMIT_AS, limits, limits);
}

// A signal for the parent is to end the child, not to be remembered by it.
void forgetSignalHandlers() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGALRM}) ::signal(signal, SIG_DFL);
}

void endWithParent(pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // It may have ended before it could be said.
    if (::getppid() != parent) ::_exit(0);
}

// What the parent and the child have in common: whether the work is done, what it complained of,
// and what it wrote.
constexpr std::size_t kMostWhy = 4096, kAhead = 1 + kMostWhy;
std::byte* inCommon = nullptr;  // of the child, for its end

// Only where an exception is being handled.
void keepComplaint() {
    try {
        throw;
    } catch (const std::exception& problem) {
        std::strncpy(reinterpret_cast<char*>(inCommon + 1), problem.what(), kMostWhy - 1);
    } catch (...) {
        // Nobody knows what it says.
    }
}

// Files that the parent is writing are none of the child's to remove, as the parent's handler
// would.
[[noreturn]] void endChild() {
    if (std::current_exception()) keepComplaint();
    ::_exit(0);
}

[[noreturn]] void runChild(pid_t parent, std::uint64_t mostMemory,
                           const std::function<bool(std::byte*)>& work, std::byte* shared) {
    inCommon = shared;
    std::set_terminate(endChild);
    endWithParent(parent);
    forgetSignalHandlers();
    constexpr rlim_t kSeconds = 60;
    limit(RLIMIT_CORE, 0, 0);
    // One more, so that it is SIGXCPU that ends the child.
    limit(RLIMIT_CPU, kSeconds, kSeconds + 1);
    limitMemory(mostMemory);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    try {
        if (work(shared + kAhead)) shared[0] = std::byte{1};
    } catch (...) {
        keepComplaint();
    }
    ::_exit(0);
}

// Returns what a child may take: enough for any codec, and no more than there is, but for what a
// process needs to run at all.
std::uint64_t memoryFor(std::size_t bytes) {
    constexpr std::uint64_t kLeast = 64 << 20;
    constexpr std::uint64_t kMost = 1 << 30;
    constexpr std::uint64_t kTimes = 64;
    return std::min(std::max(kLeast, availableMemory()), kMost + kTimes * bytes);
}

[[noreturn]] void fail(const std::string& why) {
    throw Error(ErrorCode::kFailed, "work in a process of its own failed: " + why);
}

}  // namespace

bool inChild(std::size_t bytes, const std::function<bool(std::byte*)>& work, std::byte* to,
             std::string* why) {
    const SharedBytes shared(bytes + kAhead);
    const std::uint64_t mostMemory = memoryFor(bytes);
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) fail(std::generic_category().message(errno));
    if (child == 0) runChild(parent, mostMemory, work, shared.get());
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    // No library ends itself like that: it is a lack of memory, or somebody's wish.
    for (const int signal : {SIGKILL, SIGTERM, SIGINT, SIGHUP}) {
        if (WIFSIGNALED(status) && WTERMSIG(status) == signal)
            fail("it was ended by signal " + std::to_string(signal));
    }
    if (why) *why = reinterpret_cast<const char*>(shared.get() + 1);
    if (shared.get()[0] == std::byte{0}) return false;
    std::memcpy(to, shared.get() + kAhead, bytes);
    return true;
}

}  // namespace deltasplat
