// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace deltasplat {

/// A file that appears under its final name only when it is whole: written beside it under a name
/// of its own (`.deltasplat.<name>.<number>.tmp`), then renamed. Destroyed without commit(), it
/// leaves nothing; what a process that was killed leaves, the next one removes that writes the same
/// file. A final name that is a symbolic link stays one, and what it leads to is replaced. A final
/// name that exists and is no regular file (a device, a pipe) is written to directly, and so is one
/// of a file that is open (/dev/stdout, /proc/self/fd/3), whatever it is, behind what is in it.
///
/// The file is written, checked and given its permissions through one descriptor, and its folder is
/// kept open too: whoever else may write in that folder cannot have anything written elsewhere. A
/// file that is replaced keeps its permissions, and its owner and group as far as this user may
/// give them; until then nobody else can read the new one. Not thread-safe; different objects are
/// independent.
class AtomicFile {
  public:
    /// Makes sure at once that the file can be written, so that it may be asked before long work.
    /// @throw Error(kOutput) if the folder does not exist or cannot be written to, if the final
    /// name is a folder, a file without write permission or a link that cannot be resolved
    explicit AtomicFile(std::filesystem::path finalPath);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write: a descriptor of an empty file that can also be read, or of a device. It
    /// stays this object's.
    /// @throw Error(kOutput) if a device cannot be opened
    int descriptor();
    /// Whether the final name is of a device, a pipe or an open file.
    bool isDevice() const;
    /// The name given to the constructor, for messages.
    const std::filesystem::path& finalPath() const;

    /// Writes after what was written before.
    /// @throw Error(kOutput) if not all bytes can be written
    void write(const void* bytes, std::size_t size);
    /// Makes sure that all was written, so that what is left to do in commit() is the renaming.
    /// @throw Error(kOutput) if not all bytes could be written
    void close();
    /// Gives the whole file its final name, after close().
    /// @throw Error(kOutput) if that fails, or if somebody else put another file in its place;
    /// whatever the commit gate throws
    void commit();
    /// Gives first a data file and then this one, its header, their final names, after close() of
    /// both: all that may take long or fail is done before either name changes. Who is killed
    /// between the two renames leaves the old header beside the new data file.
    /// @throw Error(kOutput), whatever the commit gate throws: as commit()
    void commitWithData(AtomicFile& data);
    /// Whether the file has got its final name.
    bool isCommitted() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Writes `bytes` as the whole content of `file`, as AtomicFile does.
/// @throw Error(kOutput) if it cannot be written, a full disk included
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

/// Sets what is called right before any file gets its final name or loses it; nullptr: nothing. It
/// may throw to keep that from happening. For the whole process; thread-safe.
void setCommitGate(void (*gate)());

/// Sets whether files, and their new names, are on the disk before commit() returns, so that they
/// outlive a power failure. For the whole process; thread-safe. Off by default.
void setSyncFiles(bool sync);

/// Removes the temporary files of all AtomicFiles: for who ends the process without destroying
/// them. May be called by a signal handler.
void removeTemporaryFiles() noexcept;

}  // namespace deltasplat
