// SPDX-License-Identifier: Apache-2.0
#include "ingest/byte_source.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "deltasplat/error.h"
#include "ingest/file_name.h"

namespace deltasplat {
namespace {

constexpr unsigned kBufferBytes = 1u << 18;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
}

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& file, bool gzip) : file_(file), gzip_(gzip) {
    requireRegularFile(file);
    errno = 0;
    if (gzip) {
        handle_ = gzopen(file.c_str(), "rb");
    } else {
        handle_ = std::fopen(file.c_str(), "rb");
    }
    if (handle_ == nullptr) {
        const std::string reason = errno == 0 ? "not enough memory" : std::strerror(errno);
        fail(file, "a file that cannot be opened (" + reason + ")", "a readable file");
    }
    if (gzip) {
        gzbuffer(gzFile(handle_), kBufferBytes);
    } else {
        // Whole layers are read at once: a buffer between would only copy them again.
        std::setvbuf(static_cast<std::FILE*>(handle_), nullptr, _IONBF, 0);
    }
}

ByteSource::~ByteSource() {
    if (gzip_) {
        gzclose_r(gzFile(handle_));
    } else {
        std::fclose(static_cast<std::FILE*>(handle_));
    }
}

std::size_t ByteSource::readSome(void* to, unsigned bytes) {
    if (!gzip_) {
        auto* plain = static_cast<std::FILE*>(handle_);
        const std::size_t count = std::fread(to, 1, bytes, plain);
        if (std::ferror(plain) != 0) fail(file_, "a read error", "a readable file");
        return count;
    }
    const auto zipped = gzFile(handle_);
    const int count = gzread(zipped, to, bytes);
    int status = Z_OK;
    const char* text = gzerror(zipped, &status);
    if (status == Z_BUF_ERROR) fail(file_, "a gzip stream that is cut short", "a whole one");
    if (count < 0 || status < 0) {
        const char* colon = std::strstr(text, ": ");
        fail(file_, std::string("a corrupt gzip stream (") + (colon ? colon + 2 : text) + ")",
             "a sound one");
    }
    // zlib hands bytes through unchanged when a file is no gzip at all.
    if (gzdirect(zipped) != 0 && count > 0) fail(file_, "no gzip stream", "a gzip file");
    return std::size_t(count);
}

std::size_t ByteSource::read(void* to, std::size_t bytes) {
    constexpr std::size_t kMost = std::size_t{1} << 30;
    std::size_t done = 0;
    while (done < bytes) {
        const std::size_t count =
            readSome(static_cast<char*>(to) + done, unsigned(std::min(bytes - done, kMost)));
        if (count == 0) break;
        done += count;
    }
    return done;
}

std::uint64_t ByteSource::skip(std::uint64_t bytes, const std::function<void()>& step) {
    std::vector<char> sink(std::size_t(std::min<std::uint64_t>(bytes, 4 * kBufferBytes)));
    std::uint64_t done = 0;
    while (done < bytes) {
        const std::size_t count =
            read(sink.data(), std::size_t(std::min<std::uint64_t>(bytes - done, sink.size())));
        if (count == 0) break;
        done += count;
        step();
    }
    return done;
}

}  // namespace deltasplat
