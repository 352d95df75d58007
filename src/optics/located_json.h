// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deltasplat {

/// Reads a whole text file and drops a UTF-8 byte order mark.
/// @param expected  content of the file, for messages
/// @throw Error(kInput) if the file cannot be read or is longer than 16 MiB
std::string readSmallText(const std::filesystem::path& file, const std::string& expected);

struct LocatedMember;

/// A JSON value that knows its line, so that error messages can name the line.
struct LocatedJson {
    enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };
    Kind kind = Kind::kNull;
    int line = 1;       ///< 1-based; first line of the value
    bool flag = false;  ///< of a kBoolean
    double number = 0;  ///< of a kNumber; always finite
    std::string text;   ///< the text of a kString, or a kNumber as error messages print it
    /// Elements of a kArray (names empty) or members of a kObject, in the file's order.
    std::vector<LocatedMember> members;

    /// Returns the last member of that name, as JSON readers usually do; null if there is none.
    const LocatedJson* find(std::string_view name) const;
    /// Returns the value as error messages quote it: `"abc"`, 3, true, null, an array or an object.
    std::string quoted() const;
};

/// An element or a member: its name (empty in an array) and its value.
struct LocatedMember {
    std::string name;
    LocatedJson value;
};

/// @param what, longName  content of the file, for messages: of JSON, and of a file that is no text
/// @throw Error(kInput) `<file>:<line>: got X; expected Y` if the file is missing, no JSON, longer
///        than 16 MiB or nested deeper than 32 levels
LocatedJson readLocatedJson(const std::filesystem::path& file,
                            const std::string& what = "a transfer function",
                            const std::string& longName = "a transfer function (ParaView's JSON)");

}  // namespace deltasplat
