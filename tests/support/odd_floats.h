// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfenv>
#include <cstdint>
#include <string>
#include <vector>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace deltasplat::test {

/// While one of these lives, the thread does arithmetic as no library expects it.
class OddFloats {
  public:
    enum class Kind { kFlushToZero, kUpward, kDownward, kTowardZero };

    /// Those that this processor has.
    static std::vector<Kind> kinds() {
        std::vector<Kind> kinds = {Kind::kUpward, Kind::kDownward, Kind::kTowardZero};
#if defined(__x86_64__) || defined(__aarch64__)
        kinds.push_back(Kind::kFlushToZero);
#endif
        return kinds;
    }

    static std::string name(Kind kind) {
        switch (kind) {
            case Kind::kFlushToZero:
                return "flush to zero";
            case Kind::kUpward:
                return "upward";
            case Kind::kDownward:
                return "downward";
            case Kind::kTowardZero:
                return "toward zero";
        }
        return "";
    }

    explicit OddFloats(Kind kind) : kind_(kind) {
        std::fegetenv(&before_);
        if (kind == Kind::kFlushToZero) {
            flushToZero();
        } else {
            std::fesetround(kind == Kind::kUpward     ? FE_UPWARD
                            : kind == Kind::kDownward ? FE_DOWNWARD
                                                      : FE_TOWARDZERO);
        }
    }
    ~OddFloats() {
        std::fesetenv(&before_);
    }
    OddFloats(const OddFloats&) = delete;
    OddFloats& operator=(const OddFloats&) = delete;

    /// Whether arithmetic is still odd, as seen from its results.
    bool stillSet() const {
        volatile double one = 1, tiny = 1e-310, small = 1e-30;
        const bool flushed = tiny * one == 0;
        const bool up = one + small > 1, down = one - small < 1;
        const bool towardZero = down && -one + small > -1;
        switch (kind_) {
            case Kind::kFlushToZero:
                return flushed;
            case Kind::kUpward:
                return up;
            case Kind::kDownward:
                return down && !towardZero;
            case Kind::kTowardZero:
                return towardZero;
        }
        return false;
    }

  private:
    static void flushToZero() {
#if defined(__x86_64__)
        _mm_setcsr(_mm_getcsr() | 0x8040);  // results, and what is read
#elif defined(__aarch64__)
        std::uint64_t control;
        __asm__ volatile("mrs %0, fpcr" : "=r"(control));
        __asm__ volatile("msr fpcr, %0" : : "r"(control | std::uint64_t{1} << 24));
#endif
    }

    Kind kind_;
    std::fenv_t before_;
};

}  // namespace deltasplat::test
