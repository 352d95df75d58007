// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <memory_resource>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace deltasplat {

/// Gives a vector elements that have no value until one is written, so that several threads can do
/// that: clearing a large one takes longer than filling it.
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
