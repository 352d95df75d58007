// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory_resource>
#include <mutex>

namespace deltasplat {

/// Memory for sheets and layers, which every picture allocates anew. Large blocks that are freed
/// stay here for the next picture, so that the system need not clear them again. The pool never
/// holds more than was in use at one time. Thread-safe.
class KeptMemory : public std::pmr::memory_resource {
  public:
    KeptMemory() = default;
    ~KeptMemory() override;
    KeptMemory(const KeptMemory&) = delete;
    KeptMemory& operator=(const KeptMemory&) = delete;

    /// Ends a picture: blocks that it did not use go back to the system. With a memory limit
    /// (setMemoryLimit) all blocks do, because kept blocks count as taken.
    void endPicture();
    /// Bytes of the blocks that are kept. A caller that asks for more, in any sizes, makes the pool
    /// grow by no more than the rest.
    std::size_t idleBytes() const;

  private:
    struct Block {
        void* memory;
        bool used;  // since the last picture but one
    };
    void* do_allocate(std::size_t bytes, std::size_t alignment) override;
    void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
    bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
        return this == &other;
    }
    void release(std::multimap<std::size_t, Block>::iterator block);

    mutable std::mutex mutex_;
    std::multimap<std::size_t, Block> idle_;  // by size
    std::size_t idleBytes_ = 0;
    std::size_t usedBytes_ = 0;
    std::size_t mostUsedBytes_ = 0;
};

}  // namespace deltasplat
