// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/stream_index.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "formats/delta/bit_reader.h"
#include "formats/delta/delta_format.h"

namespace deltasplat {
namespace {

class IndexReader {
  public:
    IndexReader(const std::uint64_t* words, std::size_t count, const DeltaHeader& header,
                const std::string& where)
        : header_(header), where_(where), words_(words), count_(count), in_(words, 0) {}

    StreamIndex read();

  private:
    [[noreturn]] void fail(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, where_, got, expected);
    }
    // A small file may claim many parts, although each takes a word and bits of the stream.
    [[noreturn]] void failTooMany(std::uint64_t words) const {
        fail("columns of " + std::to_string(words) + " words or more",
             "at most " + std::to_string(count_) + ", those of the whole stream");
    }
    // Requires that all bits read so far lie before the end.
    void requireBits() const {
        if (in_.position() <= 64 * count_) return;
        fail("a stream of " + std::to_string(count_) + " words that ends early", "the rest of it");
    }
    // Takes the steps from the part before; a step in a slower coordinate resets the faster ones.
    void takePlace(glm::i64vec3& place, const glm::i64vec3& most);
    void takeRange(StreamPart& part);
    // Takes the distances of the active voxels' box from the grid's sides.
    IndexBox takeBox();
    void requireSum();
    void requireCounted(const StreamIndex& index) const;
    std::vector<std::uint64_t> takeHistogram();

    const DeltaHeader& header_;
    const std::string& where_;
    const std::uint64_t* words_;
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

void IndexReader::takeRange(StreamPart& part) {
    const std::uint64_t lowest = in_.takeNumber();
    const std::uint64_t more = in_.takeNumber();
    const auto codes = std::uint64_t(header_.codeCount);
    if (lowest >= codes || more >= codes - lowest) {
        fail("codes beyond those of the code book",
             "codes below " + std::to_string(header_.codeCount));
    }
    part.lowest = Code(lowest);
    part.highest = Code(lowest + more);
}

std::vector<std::uint64_t> IndexReader::takeHistogram() {
    const auto codes = std::uint64_t(header_.codeCount);
    std::vector<std::uint64_t> histogram(kCodeCount);
    std::uint64_t code = 0;
    std::uint64_t left = header_.active;
    const std::uint64_t number = in_.takeNumber();
    for (std::uint64_t i = 0; i < number; ++i, ++code) {
        requireBits();
        const std::uint64_t gap = in_.takeNumber();
        const std::uint64_t count = in_.takeNumber();
        if (code >= codes || gap >= codes - code || count >= left) {
            fail("numbers of codes that go together with no volume",
                 std::to_string(header_.active) + " voxels of " +
                     std::to_string(header_.codeCount) + " codes");
        }
        code += gap;
        histogram[std::size_t(code)] = count + 1;
        left -= count + 1;
        if (!std::isfinite(header_.book.valueOf(Code(code))))
            fail("voxels of code " + std::to_string(code) + ", which is no number", "numbers");
    }
    if (left > 0) {
        fail("codes of " + std::to_string(header_.active - left) + " voxels",
             "of " + std::to_string(header_.active));
    }
    return histogram;
}

IndexBox IndexReader::takeBox() {
    IndexBox box{toSliceOrder(header_.box.min, header_.sliceAxis),
                 toSliceOrder(header_.box.max, header_.sliceAxis)};
    const glm::i64vec3 size = glm::i64vec3(box.max) - glm::i64vec3(box.min);
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint64_t low = in_.takeNumber();
        const std::uint64_t high = in_.takeNumber();
        const auto most = std::uint64_t(size[axis]);
        if (header_.box.empty() || low > most || high > most - low)
            fail("a box of active voxels outside of that of the grid", "one within it");
        box.min[axis] += int(low);
        box.max[axis] -= int(high);
    }
    return box;
}

// Partial unpacking cannot notice a damaged index, so the sum must.
void IndexReader::requireSum() {
    const std::uint64_t sum = streamSum(words_, in_.position() / 64);
    if (in_.take(64) != sum)
        fail("a stream whose beginning is damaged", "one with the sum it says");
}

// Requires voxels of each column's lowest and highest code.
void IndexReader::requireCounted(const StreamIndex& index) const {
    for (const StreamPart& part : index.parts) {
        if (index.histogram[part.lowest] == 0 || index.histogram[part.highest] == 0)
            fail("columns of codes that no voxel has", "those of some voxel");
    }
}

StreamIndex IndexReader::read() {
    const int blocksPerSlab = header_.keyInterval / 8;
    const glm::ivec3 first = toSliceOrder(header_.box.min, header_.sliceAxis) >> 3;
    const glm::ivec3 last = toSliceOrder(header_.box.max, header_.sliceAxis) >> 3;
    glm::i64vec3 place(0, 0, -1);
    glm::i64vec3 most = glm::i64vec3(last) - glm::i64vec3(first);
    most.x /= blocksPerSlab;
    const std::uint64_t number = in_.takeNumber();
    requireBits();
    if (number > count_) failTooMany(number);
    requireMemory(where_, double(number) * sizeof(StreamPart));
    const bool knowsCodes = in_.take(1) == 1;
    if (knowsCodes && header_.exact) fail("a stream of exact values that says its codes", "none");
    StreamIndex index;
    std::vector<StreamPart>& parts = index.parts;
    parts.reserve(std::size_t(number));
    constexpr std::uint64_t kMostNumber = std::uint64_t{1} << 62;
    std::size_t words = 0;
    for (std::uint64_t left = number; left > 0; --left) {
        requireBits();
        takePlace(place, most);
        const std::uint64_t size = in_.takeNumber();
        if (size >= count_ - words) failTooMany(words + std::min(size, kMostNumber) + 1);
        const std::size_t end = words + std::size_t(size) + 1;
        const glm::i64vec3 blocks(place.x * blocksPerSlab, place.y, place.z);
        parts.push_back({first + glm::ivec3(blocks), words, end});
        if (knowsCodes) takeRange(parts.back());
        words = end;
    }
    if (knowsCodes) {
        requireBits();
        index.histogram = takeHistogram();
        index.active = takeBox();
        in_.skipToWord();
        requireSum();
        requireCounted(index);
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
    return index;
}

}  // namespace

StreamIndex readStreamIndex(const std::uint64_t* words, std::size_t count,
                            const DeltaHeader& header, const std::string& where) {
    return IndexReader(words, count, header, where).read();
}

CodesInUse codesInUse(const StreamIndex& index, const DeltaHeader& header) {
    return {index.histogram,
            {fromSliceOrder(index.active.min, header.sliceAxis),
             fromSliceOrder(index.active.max, header.sliceAxis)}};
}

std::uint64_t streamSum(const std::uint64_t* words, std::size_t count) {
    uLong sum = ::crc32_z(0, nullptr, 0);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<Bytef, 8> bytes;
        for (std::size_t byte = 0; byte < bytes.size(); ++byte)
            bytes[byte] = Bytef(words[i] >> 8 * byte & 0xff);
        sum = ::crc32_z(sum, bytes.data(), bytes.size());
    }
    return std::uint64_t(sum);
}

std::size_t countBlocks(const std::uint64_t* words, const std::vector<StreamPart>& parts) {
    // A block with one delta: gap, 8 slices, form, parameter, rows, one row, one number.
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
