// SPDX-License-Identifier: Apache-2.0
#include "files/file_mark.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

namespace deltasplat {

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
