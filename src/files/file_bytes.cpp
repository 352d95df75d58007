// SPDX-License-Identifier: Apache-2.0
#include "files/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "files/file_name.h"

namespace deltasplat {

/// Unpacks gzip or zlib streams of a file. (zlib's gzread accepts a file whose checksum is cut off,
/// and reads a file that begins otherwise as plain bytes.)
class Unpacker {
  public:
    /// @param anyStream  true: one zlib or gzip stream, whatever follows it; false: gzip members,
    /// and
    ///                   nothing but zeros behind them
    /// @param start      place in the file
    Unpacker(const FileBytes& file, bool anyStream, std::uint64_t start);
    ~Unpacker();
    Unpacker(const Unpacker&) = delete;
    Unpacker& operator=(const Unpacker&) = delete;

    /// As ByteSource::read.
    std::size_t read(void* to, std::size_t bytes);

  private:
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const;
    bool fill();
    std::size_t inflateSome(void* to, std::size_t bytes);
    [[noreturn]] void refuseCorrupt() const;
    void passEnd();

    const FileBytes& file_;
    bool anyStream_;
    std::uint64_t place_;
    std::vector<unsigned char> packed_;
    std::unique_ptr<z_stream_s> stream_;
    int members_ = 0;  // gzip members that have ended
    bool done_ = false;
};

namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr int kWindowBits = 15;
// What is added to the window's bits to say which headers there may be.
constexpr int kGzipOnly = 16, kZlibOrGzip = 32;

}  // namespace

Unpacker::Unpacker(const FileBytes& file, bool anyStream, std::uint64_t start)
    : file_(file),
      anyStream_(anyStream),
      place_(start),
      packed_(kBufferBytes),
      stream_(std::make_unique<z_stream>()) {
    const int status =
        inflateInit2(stream_.get(), kWindowBits + (anyStream ? kZlibOrGzip : kGzipOnly));
    if (status != Z_OK) throw std::bad_alloc();
}

Unpacker::~Unpacker() {
    inflateEnd(stream_.get());
}

void Unpacker::refuse(const std::string& got, const std::string& expected) const {
    throw Error(ErrorCode::kInput, file_.path().string(), got, expected);
}

// Returns whether there are packed bytes left.
bool Unpacker::fill() {
    if (stream_->avail_in != 0) return true;
    const std::size_t got = file_.read(place_, packed_.data(), packed_.size());
    place_ += got;
    stream_->next_in = packed_.data();
    stream_->avail_in = uInt(got);
    return got != 0;
}

std::size_t Unpacker::read(void* to, std::size_t bytes) {
    constexpr std::size_t kMost = std::size_t{1} << 30;
    std::size_t done = 0;
    while (done < bytes && !done_) {
        const std::size_t wanted = std::min(bytes - done, kMost);
        done += inflateSome(static_cast<unsigned char*>(to) + done, wanted);
    }
    return done;
}

std::size_t Unpacker::inflateSome(void* to, std::size_t bytes) {
    if (!fill()) {
        if (anyStream_) refuse("packed data that are cut short", "sound data");
        refuse("a gzip stream that is cut short", "a whole one");
    }
    stream_->next_out = static_cast<Bytef*>(to);
    stream_->avail_out = uInt(bytes);
    const int status = inflate(stream_.get(), Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status == Z_STREAM_END) {
        passEnd();
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
        refuseCorrupt();
    }
    return bytes - stream_->avail_out;
}

void Unpacker::refuseCorrupt() const {
    if (anyStream_) refuse("corrupt packed data", "sound data");
    const std::string reason = stream_->msg == nullptr ? "no reason given" : stream_->msg;
    if (reason == "incorrect header check") {
        if (members_ > 0) refuse("bytes behind the gzip stream", "nothing there");
        refuse("no gzip stream", "a gzip file");
    }
    refuse("a corrupt gzip stream (" + reason + ")", "a sound one");
}

// A stream's end has been checked: another may follow, or zeros, as tapes and blocks have them.
void Unpacker::passEnd() {
    ++members_;
    done_ = anyStream_;
    bool zeros = false;
    while (!done_) {
        if (!fill()) {
            done_ = true;
        } else if (*stream_->next_in != 0) {
            if (zeros) refuse("bytes behind the gzip stream", "nothing there");
            inflateReset(stream_.get());
            return;
        } else {
            zeros = true;
            ++stream_->next_in;
            --stream_->avail_in;
        }
    }
}

FileBytes::FileBytes(const std::filesystem::path& file) : path_(file) {
    requireRegularFile(file);
    handle_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle_ < 0) {
        const std::string reason = std::strerror(errno);
        throw Error(ErrorCode::kInput, file.string(),
                    "a file that cannot be opened (" + reason + ")", "a readable file");
    }
    size_ = std::filesystem::file_size(file);
    opened_ = state();
}

std::shared_ptr<const FileBytes> FileBytes::unpacked(const std::filesystem::path& file) {
    constexpr std::size_t kRun = std::size_t{1} << 20;
    auto bytes = std::make_shared<FileBytes>(file);
    Unpacker unpacker(*bytes, false, 0);
    std::vector<char> all;
    for (std::size_t got = kRun; got == kRun;) {
        const std::size_t done = all.size();
        // A vector that grows is there twice for a while.
        if (done + kRun > all.capacity()) {
            requireMemory(file.string(), 2 * double(done + kRun));
            all.reserve(2 * (done + kRun));
        }
        all.resize(done + kRun);
        got = unpacker.read(all.data() + done, kRun);
        all.resize(done + got);
    }
    bytes->size_ = all.size();
    bytes->held_ = std::move(all);
    return bytes;
}

std::shared_ptr<const FileBytes> FileBytes::plain(const std::filesystem::path& file) {
    if (packingOf(file) == Packing::kNone) return std::make_shared<const FileBytes>(file);
    return unpacked(file);
}

FileBytes::~FileBytes() {
    ::close(handle_);
}

std::optional<FileBytes::State> FileBytes::state() const {
    struct stat status {};
    if (::fstat(handle_, &status) != 0) return std::nullopt;
    return State{std::int64_t{status.st_size}, std::int64_t{status.st_mtim.tv_sec},
                 std::int64_t{status.st_mtim.tv_nsec}};
}

void FileBytes::requireUnchanged() const {
    if (!opened_ || state() != opened_) throwChanged();
}

void FileBytes::throwChanged() const {
    throw Error(ErrorCode::kInput, path_.string(), "a file that was written to while it was read",
                "one that stays as it is");
}

std::size_t FileBytes::read(std::uint64_t place, void* to, std::size_t bytes) const {
    if (held_) {
        const std::size_t count =
            std::size_t(std::min<std::uint64_t>(bytes, size_ - std::min(size_, place)));
        std::copy_n(held_->data() + std::min(size_, place), count, static_cast<char*>(to));
        return count;
    }
    std::size_t done = 0;
    while (done < bytes) {
        const ssize_t got =
            ::pread(handle_, static_cast<char*>(to) + done, bytes - done, off_t(place + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            throw Error(ErrorCode::kInput, path_.string(), "a read error", "a readable file");
        }
        if (got == 0) break;
        done += std::size_t(got);
    }
    return done;
}

std::size_t FileBytes::readInParts(std::uint64_t place, void* to, std::size_t bytes) const {
    constexpr std::size_t kPart = std::size_t{1} << 20;
    if (bytes <= kPart) return read(place, to, bytes);
    std::vector<std::size_t> got((bytes + kPart - 1) / kPart);
    parallelFor(got.size(), [&](std::size_t i) {
        const std::size_t begin = i * kPart;
        got[i] =
            read(place + begin, static_cast<char*>(to) + begin, std::min(kPart, bytes - begin));
    });
    // Up to the first part that is short.
    std::size_t done = 0;
    for (const std::size_t part : got) {
        done += part;
        if (part < kPart) break;
    }
    return done;
}

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

void throwCannotWrite(const std::filesystem::path& file, int systemError) {
    throw Error(ErrorCode::kOutput, file.string() + ": cannot be written: " +
                                        std::generic_category().message(systemError));
}

void throwNoFolder(const std::filesystem::path& file, const std::filesystem::path& folder) {
    throw Error(ErrorCode::kOutput,
                file.string() + ": cannot be written: there is no folder " + folder.string());
}

}  // namespace deltasplat
