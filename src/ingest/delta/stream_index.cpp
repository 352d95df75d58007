// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/stream_index.h"

#include <algorithm>
#include <atomic>

#include "deltasplat/error.h"
#include "ingest/delta/bit_reader.h"
#include "ingest/delta/delta_format.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

class IndexReader {
  public:
    IndexReader(const std::uint64_t* words, std::size_t some, std::size_t count,
                const DeltaHeader& header, const std::string& where)
        : header_(header), where_(where), some_(some), count_(count), in_(words, 0) {}

    std::optional<std::vector<StreamPart>> read();

  private:
    [[noreturn]] void fail(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, gotExpected(where_, got, expected));
    }
    // Each part has a word, and bits in the stream, which both may be few in a file.
    [[noreturn]] void failTooMany(std::uint64_t words) const {
        fail("columns of " + std::to_string(words) + " words or more",
             "at most " + std::to_string(count_) + ", those of the whole stream");
    }
    // What has been read has to lie before the end.
    void requireBits() const {
        if (in_.position() <= 64 * count_) return;
        fail("a stream of " + std::to_string(count_) + " words that ends early", "the rest of it");
    }
    // Whether the next part's four numbers are there.
    bool mayGoOn() const {
        constexpr std::size_t kMostBits = 4 * 128;
        return some_ == count_ || in_.position() + kMostBits <= 64 * some_;
    }
    // Of each of slab, u and v there is what is more than in the part before, as far as those
    // before it are the same.
    void takePlace(glm::i64vec3& place, const glm::i64vec3& most);

    const DeltaHeader& header_;
    const std::string& where_;
    std::size_t some_;
    std::size_t count_;
    BitReader in_;
};

void IndexReader::takePlace(glm::i64vec3& place, const glm::i64vec3& most) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint64_t more = in_.takeNumber();
        const std::int64_t room = most[axis] - place[axis] - (axis == 2);
        if (header_.box.empty() || room < 0 || more > std::uint64_t(room))
            fail("deltas outside of the box", "columns within it, in order");
        place[axis] += std::int64_t(more) + (axis == 2);
        if (more > 0 && axis < 2) place[2] = -1;
        if (more > 0 && axis == 0) place[1] = 0;
    }
}

std::optional<std::vector<StreamPart>> IndexReader::read() {
    const int blocksPerSlab = header_.keyInterval / 8;
    const glm::ivec3 first = toSliceOrder(header_.box.min, header_.sliceAxis) >> 3;
    const glm::ivec3 last = toSliceOrder(header_.box.max, header_.sliceAxis) >> 3;
    glm::i64vec3 place(0, 0, -1);
    glm::i64vec3 most = glm::i64vec3(last) - glm::i64vec3(first);
    most.x /= blocksPerSlab;
    if (!mayGoOn()) return std::nullopt;
    const std::uint64_t number = in_.takeNumber();
    requireBits();
    if (number > count_) failTooMany(number);
    requireMemory(where_, double(number) * sizeof(StreamPart));
    std::vector<StreamPart> parts;
    parts.reserve(std::size_t(number));
    constexpr std::uint64_t kMostNumber = std::uint64_t{1} << 62;
    std::size_t words = 0;
    for (std::uint64_t left = number; left > 0; --left) {
        if (!mayGoOn()) return std::nullopt;
        requireBits();
        takePlace(place, most);
        const std::uint64_t size = in_.takeNumber();
        if (size >= count_ - words) failTooMany(words + std::min(size, kMostNumber) + 1);
        const std::size_t end = words + std::size_t(size) + 1;
        const glm::i64vec3 blocks(place.x * blocksPerSlab, place.y, place.z);
        parts.push_back({first + glm::ivec3(blocks), words, end});
        words = end;
    }
    requireBits();
    in_.skipToWord();
    const std::size_t before = in_.position() / 64;
    if (before + words != count_)
        fail("a stream of " + std::to_string(count_) + " words", "as many as its columns have");
    for (StreamPart& part : parts) {
        part.begin += before;
        part.end += before;
    }
    return parts;
}

}  // namespace

std::optional<std::vector<StreamPart>> readStreamIndex(const std::uint64_t* words, std::size_t some,
                                                       std::size_t count, const DeltaHeader& header,
                                                       const std::string& where) {
    return IndexReader(words, some, count, header, where).read();
}

std::size_t countBlocks(const std::uint64_t* words, const std::vector<StreamPart>& parts) {
    // One delta at least: its gap, 8 slices, a form, a parameter, rows, a row, a number.
    constexpr std::size_t kFewestBits = 1 + 8 + 2 + 5 + 8 + 8 + 1;
    std::atomic<std::size_t> blocks = 0;
    parallelForChunks(parts.size(), [&](std::size_t begin, std::size_t end) {
        std::size_t some = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const StreamPart& part = parts[i];
            const std::uint64_t more = BitReader(words, 64 * part.begin).takeNumber();
            const std::size_t most = 64 * (part.end - part.begin) / kFewestBits;
            some += std::size_t(std::min(more, std::uint64_t(most))) + 1;
        }
        blocks += some;
    });
    return blocks;
}

}  // namespace deltasplat
