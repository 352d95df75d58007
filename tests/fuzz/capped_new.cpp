// SPDX-License-Identifier: Apache-2.0
// A size that a file makes up must end as std::bad_alloc, under sanitizers too, which would stop.
// In a file of its own: compilers must not see through these where they are used.
#include <cstdlib>
#include <new>

namespace {

void* allocate(std::size_t bytes) noexcept {
    constexpr std::size_t kMost = std::size_t{1} << 28;
    return bytes <= kMost ? std::malloc(bytes == 0 ? 1 : bytes) : nullptr;
}

void* allocateOrThrow(std::size_t bytes) {
    void* memory = allocate(bytes);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
    return allocateOrThrow(bytes);
}
void* operator new[](std::size_t bytes) {
    return allocateOrThrow(bytes);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    return allocate(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
    return allocate(bytes);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}
