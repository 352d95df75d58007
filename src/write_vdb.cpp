// SPDX-License-Identifier: Apache-2.0
#include "write_vdb.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "ingest/scalar_grids.h"
#include "output_file.h"
#include "parallel_grid.h"

namespace deltasplat {
namespace {

// Opens what io::Archive keeps for io::File: writing to any stream that can seek, offsets included.
class SeekableArchive : public openvdb::io::Archive {
  public:
    void writeTo(std::ostream& out, const openvdb::GridCPtrVec& grids,
                 const openvdb::MetaMap& metadata) const {
        Archive::write(out, grids, /*seekable=*/true, metadata);
    }
};

// A file that tells how far it is in filling up to the size expected.
class ReportingFile : public std::filebuf {
  public:
    ReportingFile(const Listener& listener, double expectedBytes)
        : listener_(listener), expectedBytes_(expectedBytes) {}

  protected:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        written_ += double(count);
        listener_.report(std::min(1.0, written_ / expectedBytes_));
        return std::filebuf::xsputn(bytes, count);
    }

  private:
    const Listener& listener_;
    double expectedBytes_;
    double written_ = 0;
};

// Where a .vdb has its tag: after magic number (8 bytes), file version, library version (4 bytes
// each of three numbers) and the flag for grid offsets (1 byte).
constexpr std::streamoff kTagPosition = 21;

// Returns a hash of all bytes of a file but the `skipped` ones from kTagPosition on: FNV-1a, eight
// bytes at a time, with the upper half of each product mixed into the lower.
std::uint64_t hashContent(std::istream& in, std::size_t skipped) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    std::vector<char> block(std::size_t{1} << 20);
    for (bool first = true; in.read(block.data(), std::streamsize(block.size())), in.gcount() > 0;
         first = false) {
        const auto count = std::size_t(in.gcount());
        std::fill(block.begin() + std::ptrdiff_t(count), block.end(), '\0');
        if (first) std::fill_n(block.begin() + kTagPosition, skipped, '\0');
        for (std::size_t i = 0; i < count; i += sizeof hash) {
            std::uint64_t word = 0;
            std::memcpy(&word, &block[i], sizeof word);
            hash = (hash ^ word) * 0x100000001b3u;
            hash ^= hash >> 32;
        }
        hash ^= count;
    }
    return hash;
}

// Returns a UUID of version 8 (free use, RFC 9562) that stands for `hash`.
std::string tagFrom(std::uint64_t hash) {
    const std::uint64_t other = (hash ^ (hash >> 29)) * 0xbf58476d1ce4e5b9u;
    char text[37];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8%03x-%012llx", unsigned(hash >> 32),
                  unsigned(hash >> 16 & 0xffff), unsigned(hash & 0xfff),
                  unsigned(other >> 48 & 0xfff), (unsigned long long)(other & 0xffffffffffffu));
    return text;
}

// Replaces the file's random tag, if it is where this program knows it to be.
void makeTagReproducible(std::iostream& stream, const std::string& randomTag) {
    std::string found(randomTag.size(), '\0');
    stream.seekg(kTagPosition);
    stream.read(found.data(), std::streamsize(found.size()));
    if (found != randomTag) return;

    stream.seekg(0);
    stream.exceptions(std::ios::badbit);
    const std::string tag = tagFrom(hashContent(stream, randomTag.size()));
    stream.clear();
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    stream.seekp(kTagPosition);
    stream.write(tag.data(), std::streamsize(tag.size()));
}

// Grids of the types that this program writes, as grids that are packed on all threads.
openvdb::GridCPtrVec parallelGrids(const openvdb::GridCPtrVec& grids) {
    openvdb::GridCPtrVec parallel;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        parallel.push_back(grid);
        grid->apply<ScalarGrids>([&](const auto& typed) {
            using Grid = std::decay_t<decltype(typed)>;
            parallel.back() = std::make_shared<const ParallelGrid<Grid>>(typed);
        });
    }
    return parallel;
}

// The size in memory: a file of all that would be as large without compression.
double memoryBytes(const openvdb::GridCPtrVec& grids) {
    double bytes = 1;
    for (const openvdb::GridBase::ConstPtr& grid : grids) bytes += double(grid->memUsage());
    return bytes;
}

void writeStream(const AtomicFile& file, const openvdb::GridCPtrVec& grids,
                 const openvdb::MetaMap& metadata, const Listener& listener) {
    ReportingFile buffer(listener, memoryBytes(grids));
    std::iostream stream(&buffer);
    // With exceptions the first byte that cannot be written ends the work, and errno is still its.
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    const auto mode = std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc;
    if (!buffer.open(file.path(), mode)) stream.setstate(std::ios::failbit);
    SeekableArchive archive;
    archive.writeTo(stream, parallelGrids(grids), metadata);
    stream.flush();
    // Only a regular file can be read back.
    if (file.path() != file.finalPath()) makeTagReproducible(stream, archive.getUniqueTag());
    if (!buffer.close()) stream.setstate(std::ios::failbit);
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const openvdb::GridCPtrVec& grids,
              const openvdb::MetaMap& fileMetadata, const Listener& listener) {
    openvdb::initialize();
    AtomicFile output(file);
    try {
        errno = 0;
        writeStream(output, grids, fileMetadata, listener);
    } catch (const std::ios_base::failure&) {
        throwCannotWrite(file, errno != 0 ? errno : EIO);
    }
    listener.report(1);
    output.commit();
}

}  // namespace deltasplat
