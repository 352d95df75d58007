// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace deltasplat {

struct DenseLayout;
class WriteNotes;

/// The lines of a header that is text, as NRRD and MetaImage have it. Fields that are not spelled
/// as their format spells them, or given twice, are refused: programs read them differently.
struct TextHeader {
    struct Field {
        std::string name;   ///< lower case, without blanks: "datafile", "dimsize"
        std::string value;  ///< without the blanks before it
    };
    std::vector<Field> fields;  ///< those of the format, in file order
    /// NRRD: what anybody may add as "key:=value", in file order.
    std::vector<std::pair<std::string, std::string>> keyValues;
    std::uint64_t dataStart = 0;  ///< place in the file, unpacked, of the byte after the header

    /// Returns the value of the field of this name (as in Field), or nullptr.
    const std::string* find(const std::string& name) const;
    /// Returns the value of a key, or nullptr.
    const std::string* findKey(const std::string& key) const;
};

/// Reads lines `name: value` and `key:=value` up to an empty line or the file's end, of a file that
/// may lie under gzip. Comments are passed over. Blanks behind the name of a data file belong to
/// it.
/// @throw Error(kInput) if the file cannot be read, does not begin with "NRRD000" and 1 to 5, or
/// has
///        a line of more than 2^20 bytes or a header of more than 2^24
TextHeader readNrrdHeader(const std::filesystem::path& file);

/// Reads lines `name = value` up to the one named ElementDataFile, of which those that say what
/// voxels are, or where, are kept.
/// @throw as readNrrdHeader, if there is no such line
TextHeader readMetaHeader(const std::filesystem::path& file);

/// Returns the whole numbers from 1 to 2^30 that `text` holds between blanks.
/// @throw Error(kInput) "<where>: got sizes 4 -3 2; expected whole numbers from 1 to 1073741824"
std::vector<std::int64_t> parseSizes(const std::string& where, const std::string& text);

/// As DenseFormat has them.
void settleNrrd(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string nrrdHeader(const DenseLayout& layout, const std::string& dataFile);
void settleMetaImage(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string metaImageHeader(const DenseLayout& layout, const std::string& dataFile);

}  // namespace deltasplat
