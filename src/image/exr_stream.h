// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

namespace deltasplat {

/// Where OpenEXR writes to a string.
class ExrMemoryStream : public Imf::OStream {
  public:
    /// @param file  for messages
    explicit ExrMemoryStream(const std::filesystem::path& file) : OStream(file.c_str()) {}

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
    /// @param file  for messages
    ExrFileStream(const std::filesystem::path& file, int descriptor)
        : OStream(file.c_str()), descriptor_(descriptor) {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// What went wrong first, as errno has it, or 0.
    int problem() const { return problem_; }

  private:
    int descriptor_;
    std::uint64_t at_ = 0;
    int problem_ = 0;
};

}  // namespace deltasplat
