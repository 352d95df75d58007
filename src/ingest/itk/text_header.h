// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace deltasplat {

/// The lines of a header that is text, as NRRD and MetaImage have it. ITK reads these headers; this
/// is to know, before ITK sees them, where the data lies and how large it is said to be. So what
/// ITK could read otherwise is refused: control characters (CR but in CRLF), fields that are not
/// spelled as their format spells them, and fields given twice.
struct TextHeader {
    struct Field {
        std::string name;   ///< lower case, without blanks: "datafile", "dimsize"
        std::string value;  ///< without the blanks around it
    };
    std::vector<Field> fields;    ///< in file order
    std::uint64_t dataStart = 0;  ///< place in the file of the byte after the header

    /// Returns the value of the first field of this name (as in Field), or nullptr.
    const std::string* find(const std::string& name) const;
};

/// Reads lines `name: value` up to an empty line or the file's end; lines with ":=" and comments
/// are passed over. Blanks behind a value belong to it.
/// @throw Error(kInput) if the file cannot be read, does not begin with "NRRD000" and 1 to 5, has a
///        line or a header too long to be meant, or anything that two readers take differently
TextHeader readNrrdHeader(const std::filesystem::path& file);

/// Reads lines `name = value` up to the one named ElementDataFile.
/// @throw as readNrrdHeader, if there is no such line
TextHeader readMetaHeader(const std::filesystem::path& file);

/// Returns the whole numbers from 1 to 2^30 that `text` holds between blanks.
/// @throw Error(kInput) "<where>: got sizes 4 -3 2; expected whole numbers from 1 to 1073741824"
std::vector<std::int64_t> parseSizes(const std::string& where, const std::string& text);

}  // namespace deltasplat
