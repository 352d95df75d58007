// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace deltasplat {

/// An array whose elements have no value until they are written, so that several threads can write
/// them: clearing a large array takes longer than filling it. Moves, does not copy.
template <class T>
requires std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>
class UnclearedArray {
  public:
    UnclearedArray() = default;
    explicit UnclearedArray(std::size_t size, std::pmr::memory_resource& memory)
        : memory_(&memory),
          size_(size),
          data_(static_cast<T*>(memory.allocate(size * sizeof(T), alignof(T)))) {}
    UnclearedArray(UnclearedArray&& other) noexcept { swap(other); }
    UnclearedArray& operator=(UnclearedArray&& other) noexcept {
        UnclearedArray moved(std::move(other));
        swap(moved);
        return *this;
    }
    ~UnclearedArray() {
        if (memory_) memory_->deallocate(data_, size_ * sizeof(T), alignof(T));
    }

    bool empty() const { return size_ == 0; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }

  private:
    void swap(UnclearedArray& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
        std::swap(data_, other.data_);
    }

    std::pmr::memory_resource* memory_ = nullptr;
    std::size_t size_ = 0;
    T* data_ = nullptr;
};

/// The allocator of vectors whose elements have no value until they are written, as those of
/// UnclearedArray.
template <typename Base>
class UnclearedAllocator : public Base {
  public:
    template <typename U>
    struct rebind {
        using other =
            UnclearedAllocator<typename std::allocator_traits<Base>::template rebind_alloc<U>>;
    };
    using Base::Base;
    UnclearedAllocator() = default;
    UnclearedAllocator(const Base& base) : Base(base) {}
    template <typename Other>
    UnclearedAllocator(const UnclearedAllocator<Other>& other)
        : Base(static_cast<const Other&>(other)) {}

    template <typename U, typename... Args>
    void construct(U* place, Args&&... args) {
        if constexpr (sizeof...(Args) == 0) {
            static_assert(std::is_trivially_default_constructible_v<U>);
            ::new (static_cast<void*>(place)) U;
        } else {
            std::construct_at(place, std::forward<Args>(args)...);
        }
    }
    UnclearedAllocator select_on_container_copy_construction() const { return {}; }
};

template <typename T>
using UnclearedVector = std::vector<T, UnclearedAllocator<std::allocator<T>>>;

namespace pmr {

template <typename T>
using UnclearedVector = std::vector<T, UnclearedAllocator<std::pmr::polymorphic_allocator<T>>>;

}  // namespace pmr

}  // namespace deltasplat
