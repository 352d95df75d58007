// SPDX-License-Identifier: Apache-2.0
#include "image/brace_free_file.h"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBraces = "{}";

std::string withoutBraces(std::string text) {
    std::replace(text.begin(), text.end(), '{', '(');
    std::replace(text.begin(), text.end(), '}', ')');
    return text;
}

bool hasBraces(const std::string& text) {
    return text.find_first_of(kBraces) != std::string::npos;
}

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (in && !in.bad()) return bytes;
    throw Error(ErrorCode::kInput,
                gotExpected(file.string(), "a file that cannot be read", "a readable file"));
}

fs::path makeFolder() {
    std::error_code ignored;
    fs::path parent = fs::temp_directory_path(ignored);
    if (parent.empty() || hasBraces(parent.string())) parent = "/tmp";
    std::string name = (parent / "deltasplat.XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) return name;
    throw Error(ErrorCode::kFailed, gotExpected(name, std::generic_category().message(errno),
                                                "a folder for a copy of a look"));
}

}  // namespace

BraceFreeFile::BraceFreeFile(const fs::path& file) : given_(file), name_(fs::absolute(file)) {
    std::string bytes = bytesOf(file);
    const bool isText = bytes.find('\0') == std::string::npos;
    if (!hasBraces(name_.string()) && !(isText && hasBraces(bytes))) return;
    folder_ = makeFolder();
    name_ = folder_ / withoutBraces("look" + file.extension().string());
    std::ofstream(name_, std::ios::binary) << (isText ? withoutBraces(std::move(bytes)) : bytes);
}

BraceFreeFile::~BraceFreeFile() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string BraceFreeFile::named(std::string text) const {
    const std::string name = name_.string();
    for (std::size_t at = folder_.empty() ? std::string::npos : text.find(name);
         at != std::string::npos; at = text.find(name, at + given_.string().size()))
        text.replace(at, name.size(), given_.string());
    return text;
}

}  // namespace deltasplat
