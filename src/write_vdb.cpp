// SPDX-License-Identifier: Apache-2.0
#include "write_vdb.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ios>
#include <memory>
#include <ostream>
#include <streambuf>
#include <string>
#include <type_traits>
#include <vector>

#include "cannot_write.h"
#include "deltasplat/atomic_file.h"
#include "ingest/grids/scalar_grids.h"
#include "parallel_grid.h"

namespace deltasplat {
namespace {

// Opens what io::Archive keeps for io::File: writing to any stream that can seek, offsets included.
// There is none of its kind; so it needs nothing of io::Archive's but its functions.
class SeekableArchive : public openvdb::io::Archive {
  public:
    using Archive::write;
    static constexpr void (openvdb::io::Archive::*kWrite)(
        std::ostream&, const openvdb::GridCPtrVec&, bool,
        const openvdb::MetaMap&) const = &SeekableArchive::write;
};

// A file of which a stream may write any part, and that tells how far it is in filling up to the
// size expected.
class FileBuffer : public std::streambuf {
  public:
    FileBuffer(AtomicFile& file, const Listener& listener, double expectedBytes)
        : file_(file), listener_(listener), expectedBytes_(expectedBytes) {
        setp(buffer_.data(), buffer_.data() + buffer_.size());
    }

  protected:
    int_type overflow(int_type next) override {
        flush();
        if (traits_type::eq_int_type(next, traits_type::eof())) return 0;
        return sputc(traits_type::to_char_type(next));
    }

    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        written_ += double(count);
        listener_.report(std::min(1.0, written_ / expectedBytes_));
        if (count < epptr() - pptr()) {
            std::memcpy(pptr(), bytes, std::size_t(count));
            pbump(int(count));
            return count;
        }
        flush();
        file_.write(bytes, std::size_t(count));
        begin_ += count;
        return count;
    }

    int sync() override {
        flush();
        return 0;
    }

    pos_type seekpos(pos_type place, std::ios_base::openmode) override {
        return seekoff(off_type(place), std::ios_base::beg, std::ios_base::out);
    }

    pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                     std::ios_base::openmode) override {
        const off_type now = begin_ + (pptr() - pbase());
        if (from == std::ios_base::end) return pos_type(off_type(-1));
        if (from == std::ios_base::cur) offset += now;
        if (offset == now) return now;
        flush();
        begin_ = ::lseek(file_.descriptor(), offset, SEEK_SET);
        return begin_;
    }

  private:
    void flush() {
        file_.write(pbase(), std::size_t(pptr() - pbase()));
        begin_ += pptr() - pbase();
        setp(buffer_.data(), buffer_.data() + buffer_.size());
    }

    AtomicFile& file_;
    const Listener& listener_;
    double expectedBytes_;
    double written_ = 0;
    off_type begin_ = 0;  // where in the file the buffer is to go
    std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 16);
};

// Where a .vdb has its tag: after magic number (8 bytes), file version, library version (4 bytes
// each of three numbers) and the flag for grid offsets (1 byte).
constexpr std::streamoff kTagPosition = 21;

// Returns how many bytes there were to read from a place on.
std::size_t readAt(AtomicFile& file, off_t place, std::vector<char>& bytes) {
    std::size_t count = 0;
    while (count < bytes.size()) {
        const ssize_t read = ::pread(file.descriptor(), bytes.data() + count, bytes.size() - count,
                                     place + off_t(count));
        if (read < 0 && errno == EINTR) continue;
        if (read < 0) throwCannotWrite(file.finalPath(), errno);
        if (read == 0) break;
        count += std::size_t(read);
    }
    return count;
}

// Returns a hash of all bytes of a file but the `skipped` ones from kTagPosition on: FNV-1a, eight
// bytes at a time, with the upper half of each product mixed into the lower.
std::uint64_t hashContent(AtomicFile& file, std::size_t skipped) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    std::vector<char> block(std::size_t{1} << 20);
    off_t place = 0;
    while (const std::size_t count = readAt(file, place, block)) {
        std::fill(block.begin() + std::ptrdiff_t(count), block.end(), '\0');
        if (place == 0) std::fill_n(block.begin() + kTagPosition, skipped, '\0');
        for (std::size_t i = 0; i < count; i += sizeof hash) {
            std::uint64_t word = 0;
            std::memcpy(&word, &block[i], sizeof word);
            hash = (hash ^ word) * 0x100000001b3u;
            hash ^= hash >> 32;
        }
        hash ^= count;
        place += off_t(count);
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
void makeTagReproducible(AtomicFile& file, const std::string& randomTag) {
    std::vector<char> found(randomTag.size());
    readAt(file, kTagPosition, found);
    if (!std::equal(found.begin(), found.end(), randomTag.begin())) return;

    const std::string tag = tagFrom(hashContent(file, randomTag.size()));
    if (::lseek(file.descriptor(), kTagPosition, SEEK_SET) != kTagPosition)
        throwCannotWrite(file.finalPath(), errno);
    file.write(tag.data(), tag.size());
}

// What this program writes: volumes and, of samples, colours.
using WrittenGrids = ScalarGrids::Append<openvdb::Vec3SGrid>;

// Grids of the types that this program writes, as grids that are packed on all threads.
openvdb::GridCPtrVec parallelGrids(const openvdb::GridCPtrVec& grids) {
    openvdb::GridCPtrVec parallel;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        parallel.push_back(grid);
        grid->apply<WrittenGrids>([&](const auto& typed) {
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

void writeStream(AtomicFile& file, const openvdb::GridCPtrVec& grids,
                 const openvdb::MetaMap& metadata, const Listener& listener) {
    FileBuffer buffer(file, listener, memoryBytes(grids));
    std::ostream stream(&buffer);
    // With exceptions the first byte that cannot be written ends the work, and errno is still its.
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    const openvdb::io::Archive archive;
    (archive.*SeekableArchive::kWrite)(stream, parallelGrids(grids), /*seekable=*/true, metadata);
    stream.flush();
    // Only a regular file can be read back.
    if (!file.isDevice()) makeTagReproducible(file, archive.getUniqueTag());
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const openvdb::GridCPtrVec& grids,
              const openvdb::MetaMap& fileMetadata, const Listener& listener) {
    openvdb::initialize();
    AtomicFile output(file);
    // Its grids' places are counted from the beginning, where others may have written.
    struct stat status {};
    const bool isOpenFile =
        output.isDevice() && ::fstat(output.descriptor(), &status) == 0 && S_ISREG(status.st_mode);
    if (isOpenFile) throwCannotWrite(file, ESPIPE);
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
