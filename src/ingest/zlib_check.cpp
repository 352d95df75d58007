// SPDX-License-Identifier: Apache-2.0
#include "ingest/zlib_check.h"

#include <zlib.h>

#include <fstream>
#include <vector>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& got) {
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, "sound data"));
}

struct Inflater {
    z_stream stream{};
    // Takes zlib and gzip headers.
    Inflater() { inflateInit2(&stream, 15 + 32); }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

std::uint64_t unpackedBytes(const std::filesystem::path& file, std::uint64_t start,
                            std::uint64_t most) {
    constexpr std::size_t kBuffer = std::size_t{1} << 18;
    std::vector<char> packed(kBuffer);
    std::vector<Bytef> unpacked(kBuffer);
    std::ifstream in(file, std::ios::binary);
    in.seekg(std::streamoff(start));
    Inflater inflater;
    z_stream& stream = inflater.stream;
    std::uint64_t done = 0;
    // One byte more than is wanted is let through, so that a stream's end is seen and checked.
    while (done <= most) {
        if (stream.avail_in == 0) {
            in.read(packed.data(), std::streamsize(packed.size()));
            stream.next_in = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_in = uInt(in.gcount());
            if (stream.avail_in == 0) refuse(file, "packed data that are cut short");
        }
        stream.next_out = unpacked.data();
        stream.avail_out = uInt(unpacked.size());
        const int status = inflate(&stream, Z_NO_FLUSH);
        done += unpacked.size() - stream.avail_out;
        if (status == Z_STREAM_END) break;
        if (status != Z_OK) refuse(file, "corrupt packed data");
    }
    return done;
}

}  // namespace deltasplat
