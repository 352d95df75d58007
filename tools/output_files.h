// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace deltasplat {

using Files = std::vector<std::filesystem::path>;

/// Returns whether two names are of one file, which need not exist.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Returns all files that are read: those that the inputs are made of (a header's data, a folder's
/// slices), and a transfer function's unless its name is empty.
Files filesRead(const Files& inputs, const std::filesystem::path& transferFunction);

/// Checks an output (empty: none) before the work: that it can be written, and would not overwrite
/// the log, a file that is read or another output.
/// @param option  gives the output's name, for messages
/// @param others  the files that it must not be, called `names` in the message
/// @throw Error(kUsage), Error(kOutput)
void checkOutput(const std::string& option, const std::filesystem::path& file, const Files& others,
                 const std::string& names);

/// The same without asking whether it can be written.
/// @throw Error(kUsage)
void requireOther(const std::string& option, const std::filesystem::path& file, const Files& others,
                  const std::string& names);

/// @throw Error(kUsage) if an output is the run's log, which then is no more
void refuseLog(const std::string& option, const std::filesystem::path& file);

/// Makes the folder of one of many outputs, unless it is there.
/// @return the folders that were not, the innermost first
/// @throw Error(kOutput)
Files makeFolderOf(const std::filesystem::path& file);

/// Folders of many outputs, made as they are needed. Those that are empty in the end, of outputs
/// that came to nothing, are taken away again; not before, for outputs share folders. Thread-safe.
class OutputFolders {
  public:
    OutputFolders() = default;
    OutputFolders(const OutputFolders&) = delete;
    OutputFolders& operator=(const OutputFolders&) = delete;
    ~OutputFolders();

    /// As makeFolderOf.
    void makeFor(const std::filesystem::path& file);

  private:
    std::mutex mutex_;
    Files made_;  // the innermost first
};

/// Writes what was asked for with --stats (empty: nothing), the last thing that a command writes.
/// @throw Error(kOutput)
void writeStats(const std::filesystem::path& file, std::string_view json);

}  // namespace deltasplat
