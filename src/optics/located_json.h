// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deltasplat {

/// Reads a whole text file, without the byte order mark of UTF-8 that it may begin with.
/// @param expected  what the file should be, for messages
/// @throw Error(kInput) if it is no file that can be read, or longer than 16 MiB
std::string readSmallText(const std::filesystem::path& file, const std::string& expected);

struct LocatedMember;

/// A JSON value that knows its line, so that an error about its meaning can say where it stands.
struct LocatedJson {
    enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };
    Kind kind = Kind::kNull;
    int line = 1;       ///< 1-based, where the value begins
    bool flag = false;  ///< of a kBoolean
    double number = 0;  ///< of a kNumber; always finite
    std::string text;   ///< of a kString; of a kNumber as it is written out in errors
    /// Elements of a kArray (names empty) or members of a kObject, in the file's order.
    std::vector<LocatedMember> members;

    /// Returns the last member of that name, as JSON readers usually take it; null if there is
    /// none.
    const LocatedJson* find(std::string_view name) const;
    /// Returns the value as an error quotes it: `"abc"`, 3, true, null, an array or an object.
    std::string quoted() const;
};

/// An element or a member: its name (empty in an array) and its value.
struct LocatedMember {
    std::string name;
    LocatedJson value;
};

/// Reads a whole JSON file.
/// @param what      it holds, for messages
/// @param longName  the same of what is no text at all
/// @throw Error(kInput) `<file>:<line>: got X; expected Y` if it is missing, no JSON, longer than
/// 16 MiB or nested deeper than 32 levels
LocatedJson readLocatedJson(const std::filesystem::path& file,
                            const std::string& what = "a transfer function",
                            const std::string& longName = "a transfer function (ParaView's JSON)");

}  // namespace deltasplat
