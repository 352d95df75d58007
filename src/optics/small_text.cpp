// SPDX-License-Identifier: Apache-2.0
#include "optics/small_text.h"

#include <cstddef>
#include <fstream>

#include "deltasplat/error.h"

namespace deltasplat {

std::string readSmallText(const std::filesystem::path& file, const std::string& expected) {
    constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
    const auto fail = [&](const std::string& got) {
        throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
    };
    std::error_code ignored;
    // Looked at first, because opening a pipe waits for who writes to it.
    const auto status = std::filesystem::status(file, ignored);
    if (!std::filesystem::exists(status)) fail("no such file");
    std::ifstream in;
    if (std::filesystem::is_regular_file(status)) in.open(file, std::ios::binary);
    if (!in.is_open()) fail("no file that can be read");
    // As much at a time as most have in all: room for the largest takes longer than reading them.
    constexpr std::size_t kPart = std::size_t{64} << 10;
    std::string text;
    while (in && text.size() <= kMaxBytes) {
        const std::size_t begin = text.size();
        text.resize(begin + kPart);
        in.read(text.data() + begin, std::streamsize(kPart));
        text.resize(begin + std::size_t(in.gcount()));
    }
    if (in.bad()) fail("no file that can be read");
    if (text.size() > kMaxBytes) fail("more than 16 MiB");
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    return text;
}

}  // namespace deltasplat
