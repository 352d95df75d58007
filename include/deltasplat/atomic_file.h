// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace deltasplat {

/// A file that appears under its final name only when it is whole: written beside it under a name
/// of its own (`.deltasplat.<process>.<number>.tmp<extension>`), then renamed. Destroyed without
/// commit(), it leaves nothing. A final name that is a symbolic link stays one, and what it points
/// to is replaced. A final name that exists and is no regular file (a device, a pipe) is written to
/// directly. Not thread-safe; different objects are independent.
class AtomicFile {
  public:
    /// Makes sure at once that the file can be written, so that it may be asked before long work.
    /// @throw Error(kOutput) if the folder does not exist or cannot be written to, if the final
    /// name is a folder or a file without write permission
    explicit AtomicFile(std::filesystem::path finalPath);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write: an empty file (or a device) that exists; has the final name's extension.
    const std::filesystem::path& path() const { return path_; }
    /// The name given to the constructor, for messages.
    const std::filesystem::path& finalPath() const { return final_; }
    /// Gives the whole file its final name. Close it first, and check that closing worked.
    /// @throw Error(kOutput) if that fails
    void commit();

  private:
    std::filesystem::path final_;
    std::filesystem::path path_;
    bool committed_ = false;
};

/// Writes `bytes` as the whole content of `file`, as AtomicFile does.
/// @throw Error(kOutput) if it cannot be written, a full disk included
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace deltasplat
