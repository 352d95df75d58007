// SPDX-License-Identifier: Apache-2.0
#include "process/tell_place.h"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <string_view>

#include "process/handle_signal.h"

namespace deltasplat {
namespace {

std::atomic<int> percent{0};
std::atomic<long> beginSecond{0};

static_assert(std::atomic<int>::is_always_lock_free && std::atomic<long>::is_always_lock_free,
              "signal handlers cannot wait");

long secondNow() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return long(now.tv_sec);
}

// A line put together by what signal handlers may call.
class Line {
  public:
    void add(std::string_view text) {
        for (const char c : text)
            if (size_ < sizeof text_) text_[size_++] = c;
    }
    void add(long number) {
        char digits[24];
        std::size_t count = 0;
        do digits[count++] = char('0' + number % 10);
        while ((number /= 10) > 0);
        std::reverse(digits, digits + count);
        add(std::string_view(digits, count));
    }
    void write() const { (void)!::write(STDERR_FILENO, text_, size_); }

  private:
    char text_[96];
    std::size_t size_ = 0;
};

extern "C" {

static void tell(int) {
    const int before = errno;
    Line line;
    line.add("deltasplat: ");
    line.add(long(percent.load()));
    line.add("% after ");
    line.add(std::max(0L, secondNow() - beginSecond.load()));
    line.add(" s\n");
    line.write();
    errno = before;
}

}  // extern "C"

}  // namespace

void tellPlaceOnSignal() {
    beginSecond = secondNow();
    handleSignal(SIGUSR1, tell);
}

void notePlace(double share) {
    percent = int(100 * std::clamp(share, 0.0, 1.0) + 1e-9);
}

}  // namespace deltasplat
