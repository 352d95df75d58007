// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// A file name with places for a frame's number: `####` (as many digits at least as there are #),
/// `%04d`, `%d`, `@@@@` (as ####), `$F4` or `$F`. A lone `@` stands for a number of any length.
class FrameName {
  public:
    /// Returns nothing if a name has no such place.
    static std::optional<FrameName> find(const std::filesystem::path& file);
    /// The same of a volume that is read. In the name of an image stack, # and % count slices: its
    /// frames are $F or @, or stand in the names of folders.
    static std::optional<FrameName> findInput(const std::filesystem::path& input);

    /// Returns the file of a frame. Signs count as a digit, as in printf: -5 in #### is -005.
    std::filesystem::path at(int frame) const;
    /// The same of a file that is read: where inputs are confined, links in names with such a place
    /// lead nowhere else.
    /// @throw Error(kInput) as requireFoundIn
    std::filesystem::path inputAt(int frame) const;

  private:
    struct Place {
        std::string before;
        int digits;
    };
    static std::optional<FrameName> find(const std::string& text, std::size_t stackBegin);

    std::vector<Place> places_;
    std::string after_;
};

}  // namespace deltasplat
