// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "volume/code_tree.h"

namespace deltasplat::testing {

/// A folder of this test's own that vanishes with it; the process works in it, so that messages
/// show plain file names.
class TempFolder {
  public:
    TempFolder() : before_(std::filesystem::current_path()) {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() /
                ("deltasplat_" + std::to_string(getpid()) + "_" + test->name());
        std::filesystem::create_directories(path_);
        std::filesystem::current_path(path_);
    }
    ~TempFolder() {
        std::filesystem::current_path(before_);
        std::filesystem::remove_all(path_);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

  private:
    std::filesystem::path before_;
    std::filesystem::path path_;
};

inline void writeBytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

inline std::string readBytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeGzip(const std::string& file, const std::string& bytes) {
    gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, bytes.data(), unsigned(bytes.size()));
    gzclose(out);
}

/// The bytes of `values` in memory, or each value's bytes turned round.
template <typename T>
std::string bytesOf(const std::vector<T>& values, bool turned = false) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    for (std::size_t i = 0; turned && i < values.size(); ++i) {
        std::reverse(bytes.begin() + std::ptrdiff_t(i * sizeof(T)),
                     bytes.begin() + std::ptrdiff_t((i + 1) * sizeof(T)));
    }
    return bytes;
}

/// Calls `act` and expects an Error of this code with exactly this message.
template <typename Act>
void expectError(ErrorCode code, const std::string& message, const Act& act) {
    try {
        act();
        FAIL() << "no error; expected: " << message;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code);
        EXPECT_EQ(error.what(), message);
    }
}

}  // namespace deltasplat::testing
