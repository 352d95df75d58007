// SPDX-License-Identifier: Apache-2.0
#include "process/large_pages.h"

#include <cstdlib>  // which C library it is

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DELTASPLAT_SANITIZED 1
#elif defined(__has_feature)
#define DELTASPLAT_SANITIZED                                                \
    (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
     __has_feature(memory_sanitizer))
#else
#define DELTASPLAT_SANITIZED 0
#endif
// Sanitizers find what is wrong by a new of their own.
#if defined(__linux__) && defined(__GLIBC__) && !DELTASPLAT_SANITIZED
#define DELTASPLAT_OWN_NEW 1
#else
#define DELTASPLAT_OWN_NEW 0
#endif

#if DELTASPLAT_OWN_NEW
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <new>

#include "base/cleared_memory.h"

namespace deltasplat {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;
// From here on glibc maps blocks by themselves (reuseMemory).
constexpr std::size_t kApart = std::size_t{32} << 20;
// By so much a heap grows at a time: twice in the 64 MiB that those of most threads have.
constexpr std::size_t kStep = kApart - (std::size_t{1} << 20);
constexpr std::size_t kBeside = 16;  // about what glibc's notes and rounding add to a block
constexpr std::size_t kPin = 2048;   // more than what glibc keeps aside when it is freed
// How soon it is asked again whether large pages are wanted.
constexpr std::ptrdiff_t kWait = std::ptrdiff_t{1} << 18;

std::atomic<bool> isWanted = false;

// What the calling thread knows of its heap.
struct Heap {
    std::ptrdiff_t room = 0;   // bytes until it is looked at again
    std::byte* end = nullptr;  // of what was asked for last
    void* pin = nullptr;       // what keeps a heap mapped that has nothing else yet
};
constinit thread_local Heap heap;

// Who allocates may be about to say why something failed.
class KeptErrno {
  public:
    KeptErrno() = default;
    ~KeptErrno() { errno = number_; }
    KeptErrno(const KeptErrno&) = delete;
    KeptErrno& operator=(const KeptErrno&) = delete;

  private:
    int number_ = errno;
};

// Returns how far a place lies behind the beginning of a large page.
std::size_t offsetOf(const std::byte* place) {
    return reinterpret_cast<std::uintptr_t>(place) % kLargePage;
}

void askForLargePages(std::byte* begin, std::byte* end) {
    begin += (kLargePage - offsetOf(begin)) % kLargePage;
    end -= offsetOf(end);
    if (begin >= end || bytesInFreeLargePages() / 2 < std::size_t(end - begin)) return;
    // Only wanted: without them it is slower, and right as well.
    static_cast<void>(::madvise(begin, std::size_t(end - begin), MADV_HUGEPAGE));
}

// Lets the heap of the calling thread have room in large pages: a piece of it is taken and given
// back, by which it stays as large for now. glibc gives no other say in how a heap grows.
void growHeap() {
    const KeptErrno kept;
    heap.room = kWait;
    if (heap.pin != nullptr) {
        std::free(heap.pin);
        heap.pin = nullptr;
        heap.room = std::ptrdiff_t(kStep) - kWait;
        return;
    }
    if (!isWanted.load(std::memory_order_relaxed) || ClearedMemory::isWritten()) return;
    void* volatile piece = std::malloc(kStep);  // which no compiler may leave out
    if (piece == nullptr) return;
    auto* const begin = static_cast<std::byte*>(piece);
    std::byte* const end = begin + kStep;
    const bool goesOn = begin <= heap.end && heap.end <= end;
    // What was had before, and given back, has been asked for.
    if (end != heap.end)
        askForLargePages(goesOn ? std::min(begin, heap.end - offsetOf(heap.end)) : begin, end);
    heap.end = end;
    if (goesOn) {
        std::free(piece);
        heap.room = std::ptrdiff_t(kStep);
    } else {
        // A heap that begins here would be unmapped if nothing were left in it.
        heap.pin = std::realloc(piece, kPin);
    }
}

template <typename Allocate>
void* allocate(std::size_t bytes, Allocate&& blockOf) {
    // With what glibc needs beside it.
    if (bytes < kApart && (heap.room -= std::ptrdiff_t(bytes + kBeside)) < 0) growHeap();
    for (;;) {
        if (void* const block = blockOf()) {
            if (bytes >= kApart && isWanted.load(std::memory_order_relaxed)) {
                const KeptErrno kept;
                auto* const begin = static_cast<std::byte*>(block);
                askForLargePages(begin, begin + bytes);
            }
            return block;
        }
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

}  // namespace

// Linux says how many blocks there are of 2^n small pages: "Node 0, zone Normal 1830 1539 ...".
// Nothing is allocated here.
std::size_t bytesInFreeLargePages() {
    constexpr int kLargeOrder = 9;
    char text[4096];
    const int file = ::open("/proc/buddyinfo", O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    const ssize_t length = ::read(file, text, sizeof text);
    ::close(file);
    std::size_t pages = 0;
    int words = 0;  // of the line so far
    for (const char *at = text, *const end = text + std::max<ssize_t>(length, 0); at < end;) {
        if (*at == '\n') words = 0;
        if (*at <= ' ') {
            ++at;
            continue;
        }
        std::size_t number = 0;
        for (; at<end&& * at> ' '; ++at) number = 10 * number + std::size_t(*at - '0');
        const int order = words++ - 4;  // after node, its number, "zone" and its name
        if (order >= kLargeOrder) pages += number << (order - kLargeOrder);
    }
    return pages * kLargePage;
}

void useLargePages() {
    isWanted = true;
}

}  // namespace deltasplat

// All others of the language call these. Libraries do, too.
#pragma GCC visibility push(default)
void* operator new(std::size_t bytes) {
    return deltasplat::allocate(bytes,
                                [=] { return std::malloc(std::max<std::size_t>(bytes, 1)); });
}

void* operator new(std::size_t bytes, std::align_val_t alignment) {
    // The least that posix_memalign takes.
    const std::size_t multiple = std::max(std::size_t(alignment), sizeof(void*));
    return deltasplat::allocate(bytes, [=] {
        void* block = nullptr;
        return ::posix_memalign(&block, multiple, bytes) == 0 ? block : nullptr;
    });
}

void operator delete(void* block) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t /*bytes*/) noexcept {
    std::free(block);
}

void operator delete(void* block, std::align_val_t /*alignment*/) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
    std::free(block);
}
#pragma GCC visibility pop
#else
namespace deltasplat {

void useLargePages() {}

std::size_t bytesInFreeLargePages() {
    return 0;
}

}  // namespace deltasplat
#endif
