// SPDX-License-Identifier: Apache-2.0
#include "ingest/files/byte_source.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "ingest/files/unpacker.h"

namespace deltasplat {

ByteSource::ByteSource(const std::filesystem::path& file, Packing packing, std::uint64_t start)
    : ByteSource(std::make_shared<const FileBytes>(file), start) {
    if (packing == Packing::kNone) return;
    unpacker_ = std::make_unique<Unpacker>(*file_, packing == Packing::kZlib, start);
}

ByteSource::ByteSource(std::shared_ptr<const FileBytes> file, std::uint64_t start)
    : file_(std::move(file)), place_(start) {}

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
