// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_list.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

struct FrameRange {
    std::int64_t first, last, step;

    std::int64_t count() const { return (last > first ? last - first : first - last) / step + 1; }
    int at(std::int64_t i) const {
        return int(last >= first ? first + i * step : first - i * step);
    }
};

// Takes a number off the front of a text.
std::optional<std::int64_t> takeNumber(std::string_view& text) {
    int number = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (result.ec != std::errc{}) return {};
    text.remove_prefix(std::size_t(result.ptr - text.data()));
    return number;
}

bool take(std::string_view& text, char c) {
    if (text.empty() || text.front() != c) return false;
    text.remove_prefix(1);
    return true;
}

std::optional<FrameRange> rangeOf(std::string_view text) {
    const auto first = takeNumber(text);
    if (!first) return {};
    if (text.empty()) return FrameRange{*first, *first, 1};
    if (!take(text, '-')) return {};
    const auto last = takeNumber(text);
    if (!last) return {};
    if (text.empty()) return FrameRange{*first, *last, 1};
    if (!take(text, 'x')) return {};
    const auto step = takeNumber(text);
    if (!step || *step < 1 || !text.empty()) return {};
    return FrameRange{*first, *last, *step};
}

}  // namespace

Parser<std::vector<int>> frameList() {
    return [](const std::string& option, const std::string& text) {
        std::vector<int> frames;
        std::unordered_set<int> known;
        for (const std::string& part : splitAt(text, ',')) {
            const auto range = rangeOf(part);
            if (!range) {
                throw Error(ErrorCode::kUsage, option, text,
                            "frames such as 1-100, 1-100x2, 100-1, -5--1 or 1,4,10-20");
            }
            if (range->count() + std::int64_t(frames.size()) > std::int64_t(kMostFrames)) {
                throw Error(ErrorCode::kUsage, option, text,
                            "at most " + std::to_string(kMostFrames) + " frames");
            }
            for (std::int64_t i = 0; i < range->count(); ++i)
                if (known.insert(range->at(i)).second) frames.push_back(range->at(i));
        }
        return frames;
    };
}

}  // namespace deltasplat
