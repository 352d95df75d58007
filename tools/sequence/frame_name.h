// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltasplat {

/// A file name with places for a frame's number: `####` (as many digits at least as there are #),
/// `%04d`, `%d`, `@@@@` (as ####), `$F4` or `$F`. A lone `@` stands for a number of any length. In
/// the name of a folder there are places only if no folder of that very name is there; behind a `\`
/// a sign is none anywhere.
class FrameName {
  public:
    /// Returns nothing if a name has no such place.
    static std::optional<FrameName> find(const std::filesystem::path& file);
    /// The same of a volume that is read; nothing if there is one of that very name. In the name of
    /// an image stack, # and % count slices: its frames are $F or @, or stand in the names of
    /// folders.
    static std::optional<FrameName> findInput(const std::filesystem::path& input);

    /// Returns the file of a frame. Signs count as a digit, as in printf: -5 in #### is -005.
    std::filesystem::path at(int frame) const;
    /// The same of a file that is read: where inputs are confined, links in names with such a place
    /// lead nowhere else.
    /// @throw Error(kInput) as requireFoundIn
    std::filesystem::path inputAt(int frame) const;
    /// Returns the path, as it was given, of the first folder that has a place; empty: none has.
    const std::string& folder() const { return folder_; }

  private:
    struct Place {
        std::string before;
        int digits;
    };
    // What stands between slashes.
    struct Part {
        std::string text;  // as given
        bool isFolder = false;
        std::vector<Place> places;
        std::string after;

        std::string at(int frame) const;
    };
    static std::optional<FrameName> find(const std::string& text, bool isStack);
    static Part parse(const std::string& text, bool isOfStack);

    std::vector<Part> parts_;
    std::string folder_;
    bool isStack_ = false;
};

}  // namespace deltasplat
