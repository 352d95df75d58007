// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10 writes it (io/Archive.h, io/GridDescriptor.h).
#include "formats/vdb/write_vdb.h"

#include <blosc.h>
#include <openvdb/Grid.h>
#include <openvdb/io/Compression.h>
#include <openvdb/version.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/threads.h"
#include "files/file_bytes.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/packed_values.h"

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

namespace {

using openvdb::GridBase;

constexpr double kPackShare = 0.9;

// Most bytes of packed leaves that are kept until written.
constexpr std::uint64_t kMostKept = std::uint64_t{512} << 20;

constexpr std::size_t kTagBytes = 36;

void appendText(const std::string& text, std::string& to) {
    appendBytes(std::uint32_t(text.size()), to);
    to += text;
}

std::string textOf(const openvdb::math::MapBase& map) {
    std::ostringstream stream;
    map.write(stream);
    std::string bytes;
    appendText(map.type(), bytes);
    return bytes + std::move(stream).str();
}

glm::ivec3 toVector(const openvdb::Coord& place) {
    return {place.x(), place.y(), place.z()};
}

class GridPacker {
  public:
    GridPacker(const WrittenGrid& grid, std::string uniqueName)
        : grid_(grid), name_(std::move(uniqueName)), leaves_(*grid.tree, grid.isHalf()) {}

    void pack(std::uint64_t& room, const std::function<void(double)>& step) {
        leaves_.pack(room, step);
    }

    // Returns the bytes before the leaves, for a grid at offset `begin` of the file.
    std::string head(std::uint64_t begin) const {
        const TreeFacts facts = grid_.tree->facts();
        std::string bytes;
        appendText(name_, bytes);
        appendText("Tree_" + facts.type + "_5_4_3" + (grid_.isHalf() ? "_HalfFloat" : ""), bytes);
        appendText("", bytes);  // no other grid's tree
        std::string grid;
        appendBytes(std::uint32_t{openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK},
                    grid);
        grid += metadata(facts).bytes();
        grid += textOf(*grid_.map);
        grid += grid_.tree->topology(grid_.isHalf());
        const std::uint64_t gridBegin = begin + bytes.size() + 3 * sizeof begin;
        appendBytes(gridBegin, bytes);
        appendBytes(gridBegin + grid.size(), bytes);
        appendBytes(gridBegin + grid.size() + leafBytes(), bytes);
        return bytes + grid;
    }

    std::uint64_t leafBytes() const { return leaves_.bytes(); }
    void takeLeaves(const std::function<void(const std::string&)>& use) { leaves_.take(use); }

  private:
    VdbMetadata metadata(const TreeFacts& facts) const {
        VdbMetadata metadata = grid_.metadata;
        for (const char* const key : fileMetadata()) metadata.erase(key);
        metadata.insert(GridBase::META_FILE_BBOX_MIN, toVector(facts.activeBox.min()));
        metadata.insert(GridBase::META_FILE_BBOX_MAX, toVector(facts.activeBox.max()));
        metadata.insert(GridBase::META_FILE_COMPRESSION, std::string("blosc + active values"));
        metadata.insert(GridBase::META_FILE_MEM_BYTES, std::int64_t(facts.memoryBytes));
        metadata.insert(GridBase::META_FILE_VOXEL_COUNT, std::int64_t(facts.activeVoxels));
        if (grid_.tree->notesLeaves())
            metadata.insert(GridBase::META_FILE_DELAYED_LOAD,
                            {"__delayedload", leaves_.notes(grid_.packsNotes)});
        return metadata;
    }

    const WrittenGrid& grid_;
    std::string name_;
    LeafPieces leaves_;
};

// Returns unique names, with the suffixes by which OpenVDB separates grids of the same name.
std::vector<std::string> uniqueNames(const std::vector<WrittenGrid>& grids) {
    std::map<std::string, int> counts;
    for (const WrittenGrid& grid : grids) ++counts[grid.name];
    const auto numbered = [](const std::string& name, int number) {
        return name + '\x1e' + std::to_string(number);
    };
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const WrittenGrid& grid : grids) {
        const bool isAlone = !grid.name.empty() && counts[grid.name] == 1;
        std::string name = isAlone ? grid.name : numbered(grid.name, 0);
        for (int number = 1; !taken.insert(name).second; ++number)
            name = numbered(grid.name, number);
        names.push_back(name);
    }
    return names;
}

std::string fileHead(const std::string& tag, const VdbMetadata& metadata, std::size_t grids) {
    std::string bytes;
    appendBytes(std::int64_t{openvdb::OPENVDB_MAGIC}, bytes);
    appendBytes(openvdb::OPENVDB_FILE_VERSION, bytes);
    appendBytes(openvdb::OPENVDB_LIBRARY_MAJOR_VERSION, bytes);
    appendBytes(openvdb::OPENVDB_LIBRARY_MINOR_VERSION, bytes);
    bytes += '\1';  // has grid offsets
    bytes += tag;
    bytes += metadata.bytes();
    appendBytes(std::uint32_t(grids), bytes);
    return bytes;
}

// The tag follows magic number (8 bytes), three version numbers (4 bytes each) and offset flag (1).
constexpr std::size_t kTagPlace = 21;

// Fills in the tag, which was left open.
void writeTag(AtomicFile& file, const std::string& tag) {
    if (::lseek(file.descriptor(), kTagPlace, SEEK_SET) != off_t(kTagPlace))
        throwCannotWrite(file.finalPath(), errno);
    file.write(tag.data(), tag.size());
}

void writeGrids(AtomicFile& file, const std::vector<std::unique_ptr<GridPacker>>& grids,
                const VdbMetadata& metadata, const Listener& listener) {
    std::vector<std::string> heads;
    std::string front = fileHead(std::string(kTagBytes, '\0'), metadata, grids.size());
    std::uint64_t size = front.size();
    for (const auto& grid : grids) {
        heads.push_back(grid->head(size));
        size += heads.back().size() + grid->leafBytes();
    }
    ContentTag tag;
    if (file.isDevice()) {
        // A device may take each byte only once.
        for (const std::string& head : heads) tag.add(head.data(), head.size());
        front.replace(kTagPlace, kTagBytes, tag.text());
    }
    std::uint64_t written = 0;
    const auto write = [&](const std::string& bytes) {
        if (!file.isDevice()) tag.add(bytes.data(), bytes.size());
        file.write(bytes.data(), bytes.size());
        written += bytes.size();
        listener.report(double(written) / double(size));
    };
    write(front);
    for (std::size_t i = 0; i < grids.size(); ++i) {
        write(heads[i]);
        grids[i]->takeLeaves(write);
    }
    if (!file.isDevice()) writeTag(file, tag.text());
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const std::vector<WrittenGrid>& grids,
              const VdbMetadata& fileMetadata, const Listener& listener) {
    AtomicFile output(file);
    // Grid offsets count from the file's beginning, where others may have written.
    struct stat status {};
    const bool isOpenFile =
        output.isDevice() && ::fstat(output.descriptor(), &status) == 0 && S_ISREG(status.st_mode);
    if (isOpenFile) throwCannotWrite(file, ESPIPE);

    std::vector<std::unique_ptr<GridPacker>> packed;
    std::vector<std::string> names = uniqueNames(grids);
    // Under a memory limit the room must depend on the grids alone.
    std::uint64_t room = memoryLimit() != 0 ? 0 : std::min(kMostKept, availableMemory() / 4);
    for (std::size_t i = 0; i < grids.size(); ++i) {
        packed.push_back(std::make_unique<GridPacker>(grids[i], std::move(names[i])));
        packed[i]->pack(room, [&](double share) {
            listener.report(kPackShare * (double(i) + share) / double(grids.size()));
        });
    }
    writeGrids(output, packed, fileMetadata, partOf(listener, kPackShare, 1));
    listener.report(1);
    output.commit();
}

std::uint64_t writtenBytes(const WrittenGrid& grid) {
    GridPacker packed(grid, grid.name);
    std::uint64_t room = 0;
    packed.pack(room, [](double) {});
    const std::string front = fileHead(std::string(kTagBytes, '\0'), {}, 1);
    return front.size() + packed.head(0).size() + packed.leafBytes();
}

// Based on: the OpenVDB file format, as OpenVDB 10 writes it (io/DelayedLoadMetadata.h,
// points/StreamCompression.h).
namespace {

// Smaller arrays are not packed, or are padded with zeros.
constexpr std::size_t kLeastBytes = 48;
constexpr std::size_t kLeastPacked = 128;

// Appends an array: its packed size, or 0 if it is not packed, then its bytes.
template <typename T>
void appendArray(const std::vector<T>& values, bool mayPack, std::string& to) {
    const std::size_t bytes = values.size() * sizeof(T);
    const std::size_t place = to.size();
    appendBytes(std::uint32_t{0}, to);
    if (mayPack && bytes > kLeastBytes && bytes <= BLOSC_MAX_BUFFERSIZE - BLOSC_MAX_OVERHEAD) {
        std::string padded(reinterpret_cast<const char*>(values.data()), bytes);
        if (bytes < kLeastPacked) padded.resize(kLeastPacked);
        const auto size = std::uint32_t(appendBlosc(padded.data(), padded.size(), to));
        if (size > 0 && size < bytes) {
            std::memcpy(&to[place], &size, sizeof size);
            return;
        }
        to.resize(place + sizeof size);
    }
    to.append(reinterpret_cast<const char*>(values.data()), bytes);
}

}  // namespace

std::string leafNotes(const std::vector<std::int8_t>& kinds, const std::vector<std::int64_t>& sizes,
                      bool mayPack) {
    std::string notes;
    if (kinds.empty()) return notes;
    appendBytes(std::uint32_t(kinds.size()), notes);
    appendArray(kinds, mayPack, notes);
    appendArray(sizes, mayPack, notes);
    return notes;
}

namespace {

constexpr std::size_t kPiece = 256;  // leaves; 1 MiB of floats at most
constexpr std::size_t kPiecesPerThread = 4;

}  // namespace

LeafPieces::LeafPieces(const WrittenTree& tree, bool half) : tree_(tree), half_(half) {}

std::size_t LeafPieces::count() const {
    return (tree_.leafCount() + kPiece - 1) / kPiece;
}

PackedLeaves LeafPieces::packPiece(std::size_t piece) const {
    PackedLeaves packed;
    const std::size_t begin = piece * kPiece;
    tree_.packLeaves(begin, std::min(begin + kPiece, tree_.leafCount()), half_, packed);
    return packed;
}

// Packs the pieces from `begin` on, and calls use() for each piece in order.
void LeafPieces::forBatches(std::size_t begin, const std::function<void(PackedLeaves)>& use) const {
    const std::size_t most = std::size_t(std::max(1, threadCount())) * kPiecesPerThread;
    for (; begin < count(); begin += most) {
        std::vector<PackedLeaves> batch(std::min(most, count() - begin));
        parallelFor(batch.size(), [&](std::size_t i) { batch[i] = packPiece(begin + i); });
        for (PackedLeaves& piece : batch) use(std::move(piece));
    }
}

void LeafPieces::pack(std::uint64_t& room, const std::function<void(double)>& step) {
    std::size_t done = 0;
    forBatches(0, [&](PackedLeaves piece) {
        bytes_ += piece.bytes.size();
        kinds_.insert(kinds_.end(), piece.kinds.begin(), piece.kinds.end());
        sizes_.insert(sizes_.end(), piece.sizes.begin(), piece.sizes.end());
        if (kept_.size() == done && piece.bytes.size() <= room) {
            room -= piece.bytes.size();
            piece.bytes.shrink_to_fit();
            kept_.push_back(std::move(piece.bytes));
        }
        step(double(++done) / double(count()));
    });
}

std::string LeafPieces::notes(bool mayPack) const {
    return leafNotes(kinds_, sizes_, mayPack);
}

void LeafPieces::take(const std::function<void(const std::string&)>& use) {
    for (std::string& piece : kept_) use(std::exchange(piece, {}));
    forBatches(kept_.size(), [&](const PackedLeaves& piece) { use(piece.bytes); });
}

}  // namespace deltasplat
