// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <utility>

namespace deltasplat {

/// Owns a file descriptor of the system; -1: none.
class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }

    int get() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }
    /// Closes the descriptor; returns what close() returns, 0 if all is well.
    int reset() { return number_ >= 0 ? ::close(std::exchange(number_, -1)) : 0; }

  private:
    int number_;
};

/// Throws Error(kOutput) "<file>: cannot be written: <the system's text for `systemError`>".
[[noreturn]] void throwCannotWrite(const std::filesystem::path& file, int systemError);

/// Throws Error(kOutput) "<file>: cannot be written: there is no folder <folder>".
[[noreturn]] void throwNoFolder(const std::filesystem::path& file,
                                const std::filesystem::path& folder);

}  // namespace deltasplat
