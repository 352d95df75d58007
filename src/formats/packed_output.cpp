// SPDX-License-Identifier: Apache-2.0
#include "formats/packed_output.h"

#include <algorithm>
#include <limits>
#include <new>

namespace deltasplat {

PackedOutput::PackedOutput(const std::filesystem::path& finalPath) : file_(finalPath) {}

PackedOutput::~PackedOutput() {
    if (!packed_.empty()) ::deflateEnd(&stream_);
}

void PackedOutput::beginGzip() {
    constexpr int kGzipWindow = 15 + 16;  // the largest window; 16 asks for gzip's own header
    constexpr int kMemoryLevel = 8;
    const int result = ::deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow,
                                      kMemoryLevel, Z_DEFAULT_STRATEGY);
    if (result != Z_OK) throw std::bad_alloc();
    packed_.resize(std::size_t{1} << 18);
}

void PackedOutput::write(const void* bytes, std::size_t size) {
    if (packed_.empty()) return file_.write(bytes, size);
    // zlib never writes to its input, which is not const for historical reasons.
    stream_.next_in = static_cast<Bytef*>(const_cast<void*>(bytes));
    while (size > 0) {
        constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
        stream_.avail_in = uInt(std::min(size, kMost));
        size -= stream_.avail_in;
        deflateInput(Z_NO_FLUSH);
    }
}

void PackedOutput::close() {
    if (!packed_.empty()) {
        stream_.avail_in = 0;
        deflateInput(Z_FINISH);
    }
    file_.close();
}

void PackedOutput::deflateInput(int flush) {
    int result = Z_OK;
    do {
        stream_.next_out = packed_.data();
        stream_.avail_out = uInt(packed_.size());
        result = ::deflate(&stream_, flush);
        file_.write(packed_.data(), packed_.size() - stream_.avail_out);
    } while (flush == Z_FINISH ? result == Z_OK : stream_.avail_out == 0);
}

}  // namespace deltasplat
