// SPDX-License-Identifier: Apache-2.0
#include "base/kept_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <new>

#include "deltasplat/memory_limit.h"

namespace deltasplat {
namespace {

// What is smaller is quickly had from anyone.
constexpr std::size_t kLeast = std::size_t{1} << 16;
// Before each block lies its size; cache lines begin where blocks do.
constexpr std::size_t kHead = 64;
// A block serves who asks for at least this share of it.
constexpr std::size_t kShare = 2;

std::size_t& sizeOf(void* memory) {
    return *reinterpret_cast<std::size_t*>(static_cast<std::byte*>(memory) - kHead);
}

// Where the system clears memory page by page as it is written to, large pages take a fraction of
// the time.
constexpr std::size_t kLargePage = std::size_t{1} << 21;

std::align_val_t alignmentOf(std::size_t bytes) {
    return std::align_val_t(bytes < kLargePage ? kHead : kLargePage);
}

void* allocateBlock(std::size_t bytes) {
    void* const block = ::operator new(bytes + kHead, alignmentOf(bytes));
#ifdef MADV_HUGEPAGE
    // Only wanted: without them it is slower, and right as well.
    if (bytes >= kLargePage) static_cast<void>(madvise(block, bytes, MADV_HUGEPAGE));
#endif
    void* const memory = static_cast<std::byte*>(block) + kHead;
    sizeOf(memory) = bytes;
    return memory;
}

void freeBlock(void* memory) {
    const std::align_val_t alignment = alignmentOf(sizeOf(memory));
    ::operator delete(static_cast<std::byte*>(memory) - kHead, alignment);
}

}  // namespace

KeptMemory::~KeptMemory() {
    for (const auto& [size, block] : idle_) freeBlock(block.memory);
}

void KeptMemory::release(std::multimap<std::size_t, Block>::iterator block) {
    idleBytes_ -= block->first;
    freeBlock(block->second.memory);
    idle_.erase(block);
}

void* KeptMemory::do_allocate(std::size_t bytes, std::size_t alignment) {
    if (bytes < kLeast || alignment > kHead)
        return std::pmr::new_delete_resource()->allocate(bytes, alignment);
    {
        const std::lock_guard lock(mutex_);
        const auto found = idle_.lower_bound(bytes);
        if (found != idle_.end() && found->first / kShare <= bytes) {
            const std::size_t size = found->first;
            void* const memory = found->second.memory;
            idle_.erase(found);
            idleBytes_ -= size;
            usedBytes_ += size;
            mostUsedBytes_ = std::max(mostUsedBytes_, usedBytes_);
            return memory;
        }
        usedBytes_ += bytes;
        mostUsedBytes_ = std::max(mostUsedBytes_, usedBytes_);
        while (!idle_.empty() && usedBytes_ + idleBytes_ > mostUsedBytes_)
            release(std::prev(idle_.end()));
    }
    try {
        return allocateBlock(bytes);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        usedBytes_ -= bytes;
        throw;
    }
}

void KeptMemory::do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) {
    if (bytes < kLeast || alignment > kHead)
        return std::pmr::new_delete_resource()->deallocate(memory, bytes, alignment);
    const std::size_t size = sizeOf(memory);
    const std::lock_guard lock(mutex_);
    usedBytes_ -= size;
    try {
        idle_.insert({size, {memory, true}});
        idleBytes_ += size;
    } catch (const std::bad_alloc&) {
        freeBlock(memory);
    }
}

void KeptMemory::endPicture() {
    const std::lock_guard lock(mutex_);
    for (auto block = idle_.begin(); block != idle_.end();) {
        const auto here = block++;
        if (here->second.used && memoryLimit() == 0) {
            here->second.used = false;
        } else {
            release(here);
        }
    }
    mostUsedBytes_ = usedBytes_ + idleBytes_;
}

std::size_t KeptMemory::idleBytes() const {
    const std::lock_guard lock(mutex_);
    return idleBytes_;
}

}  // namespace deltasplat
