// SPDX-License-Identifier: Apache-2.0
#include "ingest/files/byte_source.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "ingest/files/unpacker.h"

namespace deltasplat {

// Two bytes that are gzip's, and the only method of packing that it has.
Packing packingOf(const std::filesystem::path& file, std::uint64_t start) {
    constexpr std::array<unsigned char, 3> kGzip{0x1f, 0x8b, 8};
    std::array<unsigned char, 3> begin{};
    FileBytes(file).read(start, begin.data(), begin.size());
    return begin == kGzip ? Packing::kGzip : Packing::kNone;
}

ByteSource::ByteSource(const std::filesystem::path& file, Packing packing, std::uint64_t start)
    : ByteSource(std::make_shared<const FileBytes>(file), start, packing) {}

ByteSource::ByteSource(std::shared_ptr<const FileBytes> file, std::uint64_t start, Packing packing)
    : file_(std::move(file)), place_(start) {
    if (packing == Packing::kNone) return;
    unpacker_ = std::make_unique<Unpacker>(*file_, packing == Packing::kZlib, start);
}

ByteSource::~ByteSource() = default;

std::size_t ByteSource::read(void* to, std::size_t bytes) {
    if (unpacker_) return unpacker_->read(to, bytes);
    const std::size_t got = file_->readInParts(place_, to, bytes);
    place_ += got;
    return got;
}

std::uint64_t ByteSource::skip(std::uint64_t bytes, const std::function<void()>& step) {
    constexpr std::uint64_t kRun = std::uint64_t{1} << 20;
    std::vector<char> sink(std::size_t(std::min(bytes, kRun)));
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
