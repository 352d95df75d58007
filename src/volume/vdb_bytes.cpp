// SPDX-License-Identifier: Apache-2.0
#include "volume/vdb_bytes.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "deltasplat/error.h"

namespace deltasplat {

VdbBytes::VdbBytes(std::shared_ptr<const FileBytes> file)
    : file_(std::move(file)), name_(file_->path().string()), size_(file_->size()) {}

void VdbBytes::failCorrupt(const std::string& got, const std::string& expected) const {
    throw Error(ErrorCode::kInput, name_, got, expected);
}

void VdbBytes::require(std::uint64_t count) const {
    if (count > size_ - position_) {
        failCorrupt(std::to_string(size_) + " bytes",
                    "at least " + std::to_string(position_) + " + " + std::to_string(count) +
                        " (a .vdb file that is cut short or corrupt)");
    }
}

void VdbBytes::seek(std::uint64_t position) {
    if (position > size_) {
        failCorrupt(
            std::to_string(size_) + " bytes",
            "at least " + std::to_string(position) + " (a .vdb file that is cut short or corrupt)");
    }
    position_ = position;
}

void VdbBytes::skip(std::uint64_t count) {
    require(count);
    position_ += count;
}

void VdbBytes::read(void* to, std::uint64_t count) {
    require(count);
    // More and more, so that a few small fields take little.
    constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 16;
    auto* out = static_cast<char*>(to);
    while (count > 0) {
        if (position_ < bufferBegin_ || position_ >= bufferBegin_ + buffer_.size()) {
            fill(position_, std::min(nextBytes_, size_ - position_));
            nextBytes_ = std::min(2 * nextBytes_, kMostBytes);
        }
        const std::uint64_t offset = position_ - bufferBegin_;
        const std::uint64_t part = std::min(count, buffer_.size() - offset);
        std::memcpy(out, buffer_.data() + offset, std::size_t(part));
        out += part;
        position_ += part;
        count -= part;
    }
}

void VdbBytes::fill(std::uint64_t begin, std::uint64_t count) {
    bufferBegin_ = begin;
    buffer_.resize(std::size_t(count));
    if (file_->read(begin, buffer_.data(), std::size_t(count)) != count) file_->throwChanged();
    constexpr std::uint64_t kStepBytes = std::uint64_t{4} << 20;
    untold_ += count;
    if (!step_ || untold_ < kStepBytes) return;
    untold_ = 0;
    step_(begin);
}

std::string VdbBytes::bytes(std::uint64_t count) {
    require(count);
    std::string text(std::size_t(count), '\0');
    read(text.data(), count);
    return text;
}

// OpenVDB itself reads its files only on little endian machines.
template <typename T>
T VdbBytes::number() {
    T value;
    read(&value, sizeof value);
    return value;
}

std::uint8_t VdbBytes::u8() {
    return number<std::uint8_t>();
}
std::uint32_t VdbBytes::u32() {
    return number<std::uint32_t>();
}
std::int64_t VdbBytes::i64() {
    return number<std::int64_t>();
}

std::string VdbBytes::text(std::uint32_t most) {
    const std::uint32_t length = u32();
    if (length > most) {
        failCorrupt("a name of " + std::to_string(length) + " bytes",
                    "at most " + std::to_string(most) + " (a corrupt .vdb file)");
    }
    return bytes(length);
}

void appendU32(std::string& text, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) text += char(value >> (8 * i) & 0xff);
}

}  // namespace deltasplat
