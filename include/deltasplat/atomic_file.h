// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace deltasplat {

/// A file that appears under its final name only when it is whole: commit() renames a temporary
/// file beside it (`.deltasplat.<name>.<number>.tmp`). Without commit() nothing remains, and the
/// next process that writes the same file removes the temporary file of a killed process. A final
/// name that is a symbolic link stays a link, and its target is replaced. A final name that exists
/// and is no regular file (a device, a pipe) is written to directly, as is the name of an open file
/// of any kind (/dev/stdout, /proc/self/fd/3), behind its content.
///
/// One descriptor serves to write the file, to check it and to set its permissions, and the folder
/// is kept open too, so other users of the folder cannot redirect the writing. A replaced file
/// keeps its permissions, and its owner and group as far as this user may set them; until then
/// nobody else can read the new file. Not thread-safe; different objects are independent.
class AtomicFile {
  public:
    /// Checks at once that the file can be written, so that callers can find out before long work.
    /// @throw Error(kOutput) if the folder does not exist or cannot be written to, if the final
    ///        name is a folder, a file without write permission or a link that cannot be resolved
    explicit AtomicFile(std::filesystem::path finalPath);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Returns this object's descriptor of an empty file that can also be read, or of a device.
    /// @throw Error(kOutput) if a device cannot be opened
    int descriptor();
    /// Whether the final name is of a device, a pipe or an open file.
    bool isDevice() const;
    /// The name given to the constructor, for messages.
    const std::filesystem::path& finalPath() const;

    /// @throw Error(kOutput) if not all bytes can be written
    void write(const void* bytes, std::size_t size);
    /// Makes sure that all bytes were written, so that commit() has only the renaming left.
    /// @throw Error(kOutput) if not all bytes could be written
    void close();
    /// Gives the whole file its final name, after close().
    /// @throw Error(kOutput) if that fails or somebody replaced the file; what the gate throws
    void commit();
    /// Gives a data file and then this file, its header, their final names, after close() of both:
    /// all slow or fallible work is done before either name changes. A process killed between the
    /// two renames leaves the old header beside the new data file.
    /// @throw as commit()
    void commitWithData(AtomicFile& data);
    bool isCommitted() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Writes `bytes` as the whole content of `file`, as AtomicFile does.
/// @throw Error(kOutput) if it cannot be written, a full disk included
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

/// Sets a function that is called right before any file gets or loses its final name; nullptr:
/// none. It may throw to prevent that. For the whole process; thread-safe.
void setCommitGate(void (*gate)());

/// Sets whether files and their new names are on the disk before commit() returns, so that both
/// survive a power failure. For the whole process; thread-safe. Off by default.
void setSyncFiles(bool sync);

/// Removes all AtomicFiles' temporary files, for ending without destructors or in signal handlers.
void removeTemporaryFiles() noexcept;

}  // namespace deltasplat
