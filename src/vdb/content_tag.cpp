// SPDX-License-Identifier: Apache-2.0
#include "vdb/content_tag.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace deltasplat {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;

}  // namespace

void ContentTag::add(const char* bytes, std::size_t count) {
    while (count > 0) {
        const std::size_t some = std::min(count, kBlock - block_.size());
        block_.insert(block_.end(), bytes, bytes + some);
        if (block_.size() == kBlock) hashBlock();
        bytes += some;
        count -= some;
    }
}

// FNV-1a, eight bytes at a time, with the upper half of each product mixed into the lower.
void ContentTag::hashBlock() {
    const std::size_t count = block_.size();
    block_.resize((count + sizeof hash_ - 1) / sizeof hash_ * sizeof hash_);
    for (std::size_t i = 0; i < count; i += sizeof hash_) {
        std::uint64_t word = 0;
        std::memcpy(&word, &block_[i], sizeof word);
        hash_ = (hash_ ^ word) * 0x100000001b3u;
        hash_ ^= hash_ >> 32;
    }
    hash_ ^= count;
    block_.clear();
}

std::string ContentTag::text() {
    if (!block_.empty()) hashBlock();
    const std::uint64_t other = (hash_ ^ (hash_ >> 29)) * 0xbf58476d1ce4e5b9u;
    char text[37];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8%03x-%012llx", unsigned(hash_ >> 32),
                  unsigned(hash_ >> 16 & 0xffff), unsigned(hash_ & 0xfff),
                  unsigned(other >> 48 & 0xfff), (unsigned long long)(other & 0xffffffffffffu));
    return text;
}

}  // namespace deltasplat
