// SPDX-License-Identifier: Apache-2.0
// Memory in large pages: blocks are as large and lie as even as asked for, and filling them takes
// a fraction of the page faults.
#include "process/large_pages.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "base/cleared_memory.h"
#include "process/reuse_memory.h"

namespace deltasplat {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;
constexpr std::size_t kSmallPage = 4096;

long faults() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

// Whether the system gives so much in large pages now, asked without any allocator.
bool areToBeHad(std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    void* const place =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) return false;
    bool had = ::madvise(place, bytes, MADV_HUGEPAGE) == 0;
    const long before = faults();
    if (had) std::memset(place, 1, bytes);
    had = had && std::size_t(faults() - before) < bytes / kSmallPage / 8;
    ::munmap(place, bytes);
    return had;
#else
    return bytes == 0;
#endif
}

void begin() {
    reuseMemory();
    useLargePages();
}

// Whether memory is handed out as said; else a sanitizer does, or the system says nothing of pages.
bool isOurs() {
    return bytesInFreeLargePages() > 0;
}

constexpr const char* kNotOurs = "memory is a sanitizer's, or nobody knows of large pages";

void expectBlock(std::size_t bytes, std::size_t alignment) {
    SCOPED_TRACE(std::to_string(bytes) + " bytes at multiples of " + std::to_string(alignment));
    void* const block = ::operator new(bytes, std::align_val_t(alignment));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % alignment, 0u);
    std::memset(block, 1, bytes);
    ::operator delete(block, std::align_val_t(alignment));
}

TEST(LargePages, BlocksLieAsEvenAsAskedFor) {
    begin();
    for (std::size_t alignment = 1; alignment <= 2 * kMebibyte; alignment *= 2) {
        for (const std::size_t bytes :
             {std::size_t{0}, std::size_t{1}, std::size_t{100}, kMebibyte})
            expectBlock(bytes, alignment);
    }
    for (const std::size_t alignment : {4, 64}) expectBlock(40 * kMebibyte, alignment);
    std::vector<char>(40 * kMebibyte, 1).resize(50 * kMebibyte);
}

TEST(LargePages, WhatCannotBeIsRefused) {
    if (!isOurs()) GTEST_SKIP() << kNotOurs;
    begin();
    const volatile std::size_t most = std::numeric_limits<std::ptrdiff_t>::max();
    EXPECT_THROW(static_cast<void>(::operator new(most)), std::bad_alloc);
    EXPECT_THROW(static_cast<void>(::operator new(most, std::align_val_t(64))), std::bad_alloc);
    EXPECT_EQ(::operator new(most, std::nothrow), nullptr);
}

// Fills so much in pieces of 2 KiB, as leaves are, and one block; then gives all back.
void fill(std::size_t bytes) {
    std::vector<std::unique_ptr<char[]>> pieces(bytes / 2048);
    for (auto& piece : pieces) piece = std::make_unique<char[]>(2048);
    const std::vector<char> block(bytes, 1);
    EXPECT_EQ(block.back(), 1);
}

TEST(LargePages, FillingMemoryTakesFewFaults) {
    constexpr std::size_t kBytes = 100 * kMebibyte;
    if (bytesInFreeLargePages() < 8 * kBytes || !areToBeHad(4 * kBytes))
        GTEST_SKIP() << "the system has no large pages to give; or " << kNotOurs;
    begin();
    for (const bool onThreads : {false, true}) {
        SCOPED_TRACE(onThreads ? "two threads" : "one thread");
        const long before = faults();
        if (onThreads) {
            const std::jthread first(fill, kBytes), second(fill, kBytes);
        } else {
            fill(kBytes);
        }
        const std::size_t pages = (onThreads ? 4 : 2) * kBytes / kSmallPage;
        EXPECT_LT(std::size_t(faults() - before), pages / 8);
    }
}

std::size_t residentBytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    file >> all >> resident;
    return resident * kSmallPage;
}

// What threads have given back is not kept for them.
TEST(LargePages, HeapsOfThreadsShrink) {
    if (!isOurs()) GTEST_SKIP() << kNotOurs;
    begin();
    constexpr std::size_t kBytes = 150 * kMebibyte;
    const std::size_t before = residentBytes();
    { const std::jthread first(fill, kBytes), second(fill, kBytes); }
    if (before > 0) {
        EXPECT_LT(residentBytes(), before + kBytes);
    }
}

// What malloc writes to all it gives is written to no more than that.
TEST(LargePages, WrittenMemoryIsNoMoreThanUsed) {
    if (!isOurs()) GTEST_SKIP() << kNotOurs;
    begin();
    const ClearedMemory written;
    const std::size_t before = residentBytes();
    for (int i = 0; i < 4; ++i) std::jthread([] { EXPECT_TRUE(std::make_unique<char[]>(100)); });
    EXPECT_LT(residentBytes(), before + 16 * kMebibyte);
}

// Who cannot open a file, and allocates before saying why.
TEST(LargePages, ErrorNumbersStayAsTheyAre) {
    begin();
    rlimit files{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &files), 0);
    const rlimit none{0, files.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
    std::vector<std::unique_ptr<char[]>> blocks(51);
    errno = ENOSPC;
    for (std::unique_ptr<char[]>& block : blocks)
        block = std::make_unique_for_overwrite<char[]>(kMebibyte);
    blocks[0] = std::make_unique_for_overwrite<char[]>(40 * kMebibyte);
    const int after = errno;
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
    EXPECT_EQ(after, ENOSPC);
}

}  // namespace
}  // namespace deltasplat
