// SPDX-License-Identifier: Apache-2.0
#include "files/file_name.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {

std::string lowerExtension(const std::filesystem::path& file) {
    std::string last = lowerCase(file.extension().string());
    if (last != ".gz") return last;
    return lowerCase(file.stem().extension().string()) + last;
}

bool isVdbName(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    return extension == ".vdb" || extension == ".vdb.gz";
}

std::string nameWithoutExtensions(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    return name.substr(0, name.size() - lowerExtension(file).size());
}

std::string folderName(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(folder, error);
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

void requireRegularFile(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    const std::string expected = "a readable file";
    if (error && !std::filesystem::exists(status) &&
        status.type() != std::filesystem::file_type::not_found) {
        throw Error(ErrorCode::kInput, file.string(),
                    "a file that cannot be opened (" + error.message() + ")", expected);
    }
    if (!std::filesystem::exists(status)) {
        throw Error(ErrorCode::kInput, file.string(), "no such file", expected);
    }
    if (!std::filesystem::is_regular_file(status)) {
        const bool folder = std::filesystem::is_directory(status);
        throw Error(ErrorCode::kInput, file.string(), folder ? "a folder" : "no regular file",
                    expected);
    }
}

std::uint64_t hashOf(std::string_view text, std::uint64_t before) {
    for (const char byte : text)
        before = (before ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    return before;
}

std::uint64_t markOf(const std::filesystem::path& file) {
    constexpr std::uint64_t kBytes = 4096;
    std::error_code ignored;
    // Looked at first, because opening a pipe waits for who writes to it.
    if (!std::filesystem::is_regular_file(file, ignored)) return 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) return 0;
    const std::uint64_t size = std::filesystem::file_size(file, ignored);
    std::uint64_t mark = hashOf(std::to_string(size));
    std::string bytes(std::size_t(std::min(size, kBytes)), '\0');
    for (const std::uint64_t at : {std::uint64_t(0), size - bytes.size()}) {
        in.seekg(std::streamoff(at));
        if (!in.read(bytes.data(), std::streamsize(bytes.size()))) return 0;
        mark = hashOf(bytes, mark);
    }
    return mark;
}

}  // namespace deltasplat
