// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <string>

namespace deltasplat {

/// Where OpenEXR writes to a string.
class ExrMemoryStream : public Imf::OStream {
  public:
    ExrMemoryStream() : OStream("memory") {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// What has been written. Call it once.
    std::string takeBytes() { return std::move(bytes_); }

  private:
    std::string bytes_;
    std::uint64_t at_ = 0;
};

/// Where OpenEXR writes to a descriptor. No write fails, for OpenEXR says nothing of one that does
/// when it ends a file: problem() does.
class ExrFileStream : public Imf::OStream {
  public:
    explicit ExrFileStream(int file) : OStream("file"), file_(file) {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// What went wrong first, as errno has it, or 0.
    int problem() const { return problem_; }

  private:
    int file_;
    std::uint64_t at_ = 0;
    int problem_ = 0;
};

}  // namespace deltasplat
