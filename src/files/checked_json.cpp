// SPDX-License-Identifier: Apache-2.0
#include "files/checked_json.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/memory.h"
#include "deltasplat/error.h"
#include "files/file_name.h"

namespace deltasplat {

namespace {

constexpr int kMostLevels = 32;

struct Shape {
    std::size_t values = 1;  // at most
    int levels = 0;
};

// What stands between quotes is passed over.
Shape shapeOf(const std::string& text) {
    Shape shape;
    int level = 0;
    bool isQuoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            isQuoted = !isQuoted;
        } else if (isQuoted) {
            if (c == '\\') ++i;
        } else if (c == '[' || c == '{') {
            ++shape.values;
            shape.levels = std::max(shape.levels, ++level);
        } else if (c == ']' || c == '}') {
            --level;
        } else if (c == ',') {
            ++shape.values;
        }
    }
    return shape;
}

}  // namespace

nlohmann::ordered_json parseCheckedJson(const std::string& text, const std::string& where,
                                        const std::string& expected) {
    const Shape shape = shapeOf(text);
    if (shape.levels > kMostLevels) {
        throw Error(ErrorCode::kInput, where,
                    "JSON of more than " + std::to_string(kMostLevels) + " levels", expected);
    }
    // A value, in a list that has grown to twice of what it holds while it is copied, and with a
    // list or a text of its own.
    constexpr double kValueBytes = 3 * sizeof(nlohmann::ordered_json) + 64;
    requireMemory(where, 2 * double(text.size()) + kValueBytes * double(shape.values));
    try {
        return nlohmann::ordered_json::parse(text);
    } catch (const nlohmann::ordered_json::exception&) {
        throw Error(ErrorCode::kInput, where, "something else", expected);
    }
}

nlohmann::ordered_json readCheckedJson(const std::filesystem::path& file,
                                       const std::string& expected) {
    requireRegularFile(file);
    std::ifstream in(file, std::ios::binary);
    const auto bytes = std::filesystem::file_size(file);
    requireMemory(file.string(), double(bytes));
    std::string text(std::size_t(bytes), '\0');
    if (!in || !in.read(text.data(), std::streamsize(bytes))) {
        throw Error(ErrorCode::kInput, file.string(), "a file that cannot be read",
                    "a readable file");
    }
    return parseCheckedJson(text, file.string(), expected);
}

}  // namespace deltasplat
