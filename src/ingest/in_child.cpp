// SPDX-License-Identifier: Apache-2.0
#include "ingest/in_child.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

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

void limit(int what, rlim_t most) {
    const rlimit limits{most, most};
    ::setrlimit(what, &limits);
}

[[noreturn]] void runChild(const std::function<bool(std::byte*)>& work, std::byte* shared) {
    constexpr rlim_t kSeconds = 60;
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, kSeconds);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    try {
        if (work(shared + 1)) shared[0] = std::byte{1};
    } catch (...) {
        // The parent sees that nothing was done.
    }
    ::_exit(0);
}

}  // namespace

bool inChild(std::size_t bytes, const std::function<bool(std::byte*)>& work, std::byte* to) {
    // The first byte says that the others are there.
    const SharedBytes shared(bytes + 1);
    const pid_t child = ::fork();
    if (child < 0) return false;
    if (child == 0) runChild(work, shared.get());
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    if (shared.get()[0] == std::byte{0}) return false;
    std::memcpy(to, shared.get() + 1, bytes);
    return true;
}

}  // namespace deltasplat
