// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace deltasplat {

/// A file that appears under its final name only when it is whole: written beside it under a name
/// of its own, then renamed. Destroyed without commit(), it leaves nothing. A final name that
/// exists and is no regular file (a device, a pipe) is written to directly.
class AtomicFile {
  public:
    /// @throw Error(kOutput) if the folder does not exist or cannot be written to
    explicit AtomicFile(std::filesystem::path finalPath);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write; has the final name's extension.
    const std::filesystem::path& path() const { return path_; }
    /// Gives the whole file its final name.
    /// @throw Error(kOutput) if that fails
    void commit();

  private:
    std::filesystem::path final_;
    std::filesystem::path path_;
    bool committed_ = false;
};

/// Writes `bytes` as the whole content of `file`.
/// @throw Error(kOutput) if it cannot be written, a full disk included
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace deltasplat
