// SPDX-License-Identifier: Apache-2.0
#include "files/checked_json.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "deltasplat/error.h"
#include "deltasplat/memory_limit.h"
#include "files/file_name.h"
#include "support/error_of.h"
#include "support/memory_beyond.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;

std::string complaint(const std::string& text) {
    return errorOf([&] { parseCheckedJson(text, "a.json", "facts"); });
}

std::string nested(int levels) {
    return std::string(std::size_t(levels), '[') + std::string(std::size_t(levels), ']');
}

TEST(CheckedJson, IsReadAsItStands) {
    const auto json =
        parseCheckedJson(R"({"a": [1, "[[\"", "\\"], "b": {"c": null}})", "a.json", "facts");
    EXPECT_EQ(json.dump(), R"({"a":[1,"[[\"","\\"],"b":{"c":null}})");
}

// Copying and writing follow lists in lists by calls in calls.
TEST(CheckedJson, NestedIsRefused) {
    EXPECT_EQ(complaint(nested(32)), "no error");
    const std::string deep = "input: a.json: got JSON of more than 32 levels; expected facts";
    for (const int levels : {33, 1000, 1000000}) EXPECT_EQ(complaint(nested(levels)), deep);
    EXPECT_EQ(complaint(std::string(100, '{')), deep);
    // Brackets between quotes are none.
    EXPECT_EQ(complaint('"' + std::string(100, '[') + '"'), "no error");
    EXPECT_EQ(complaint("[\"\\\"" + std::string(100, '[') + "\"]"), "no error");
}

TEST(CheckedJson, WhatIsNoneIsRefused) {
    for (const char* const text : {"", "{", "[1,]", "a", "\"", "\"\\"})
        EXPECT_EQ(complaint(text), "input: a.json: got something else; expected facts") << text;
}

// Lists of little take many times their text.
TEST(CheckedJson, MemoryIsAskedForBeforeItIsTaken) {
    std::string lists = "[";
    for (int i = 0; i < 2000000; ++i) lists += "[],";
    lists += "0]";
    setMemoryLimit(test::memoryBeyond(std::uint64_t{100} << 20));
    const std::string said = complaint(lists);
    setMemoryLimit(0);
    EXPECT_EQ(said.find("failed: a.json: needs "), 0U) << said;
    EXPECT_EQ(complaint(lists), "no error");
}

TEST(CheckedJson, AFileIsOneThatCanBeRead) {
    const test::TempFolder folder;
    const std::string file = (folder / "a.json").string();
    const auto said = [&] { return errorOf([&] { readCheckedJson(file, "facts"); }); };
    EXPECT_EQ(said(), "input: " + file + ": got no such file; expected a readable file");
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_EQ(said(), "input: " + file + ": got no regular file; expected a readable file");
}

}  // namespace
}  // namespace deltasplat
