// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory_resource>
#include <mutex>

namespace deltasplat {

/// Memory for what every picture takes anew: sheets, layers. Large blocks that are given back are
/// kept for the next who asks, so that the system need not clear them again; never more is held
/// than was in use at one time. Thread-safe.
class KeptMemory : public std::pmr::memory_resource {
  public:
    KeptMemory() = default;
    ~KeptMemory() override;
    KeptMemory(const KeptMemory&) = delete;
    KeptMemory& operator=(const KeptMemory&) = delete;

    /// Says that a picture is done: what it had no use for goes back to the system; where memory is
    /// limited (setMemoryLimit) all does, for what is kept counts as taken.
    void endPicture();
    /// Bytes that are kept for the next who asks. Who asks for more than that, in any sizes, makes
    /// what is held grow by no more than the rest.
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
