// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "deltasplat/atomic_file.h"

namespace deltasplat {

/// Throws Error(kOutput) "<file>: cannot be written: <what the system says about `systemError`>".
[[noreturn]] void throwCannotWrite(const std::filesystem::path& file, int systemError);

/// A file written from front to back in pieces, with AtomicFile's promise. Every byte is accounted
/// for: a disk that fills up is noticed at the latest in commit().
class OutputFile {
  public:
    /// @throw Error(kOutput) as AtomicFile
    explicit OutputFile(const std::filesystem::path& finalPath);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// @throw Error(kOutput) if not all bytes can be written
    void write(const void* bytes, std::size_t size);
    /// Ends writing, so that what is left to do in commit() is the renaming.
    /// @throw Error(kOutput) if not all bytes could be written
    void close();
    /// @throw Error(kOutput) if the file cannot be closed or renamed
    void commit();

  private:
    AtomicFile file_;
    int descriptor_ = -1;
};

}  // namespace deltasplat
