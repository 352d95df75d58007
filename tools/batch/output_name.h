// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace deltasplat {

/// What names of outputs may say of an input.
struct InputParts {
    std::string name;              ///< without folder and extensions
    std::filesystem::path folder;  ///< relative; empty: none
    std::string frame;             ///< digits of the last number in the name; empty: none
    std::string grid;              ///< as the file has it
};

/// Returns the parts of a file that a pattern has found, but for its grid.
InputParts partsOfInput(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Whether a name has a placeholder that OutputName knows.
bool hasPlaceholder(const std::filesystem::path& file);

/// A file name with `{name}`, `{dir}`, `{frame}` or `{grid}` where these parts of an input stand;
/// `{{`, `}}` and what follows a `\` are braces, as are those of a folder that is there.
class OutputName {
  public:
    /// @param option  what gives the name, for messages
    /// @throw Error(kUsage) for another placeholder, a `{` without `}`, or no placeholder at all
    OutputName(std::string option, const std::filesystem::path& file);

    bool hasGrid() const;
    /// Returns the file of an input. Slashes in the name of a grid, and a dot before it, become
    /// `_`; a folder that is empty and has nothing beside it between slashes takes the one behind
    /// it with it.
    /// @throw Error(kUsage) naming `input` if a frame is asked for and it has none
    std::filesystem::path of(const InputParts& parts, const std::filesystem::path& input) const;

  private:
    struct Piece {
        std::string text;
        bool isPlace;
    };

    std::string option_;
    std::string file_;
    std::vector<Piece> pieces_;
};

}  // namespace deltasplat
