// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace deltasplat {

/// A file under a name without braces, and without any in it if it is text: OpenImageIO takes what
/// OpenColorIO says of a table, its name and a line of it, for the format of its own message, and
/// ends the program where that is none. No table's numbers have braces. Most files are their own.
class BraceFreeFile {
  public:
    /// @throw Error(kInput) if the file cannot be read; Error(kFailed) if there is no place for a
    ///        copy
    explicit BraceFreeFile(const std::filesystem::path& file);
    ~BraceFreeFile();
    BraceFreeFile(const BraceFreeFile&) = delete;
    BraceFreeFile& operator=(const BraceFreeFile&) = delete;

    /// Returns the name, from the root on.
    std::string name() const { return name_.string(); }
    /// Returns a text in which the file has the name that it was given.
    std::string named(std::string text) const;

  private:
    std::filesystem::path given_;
    std::filesystem::path name_;
    std::filesystem::path folder_;  // of the copy; empty: there is none
};

}  // namespace deltasplat
