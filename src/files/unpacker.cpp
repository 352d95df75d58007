// SPDX-License-Identifier: Apache-2.0
#include "files/unpacker.h"

#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>

#include "deltasplat/error.h"

namespace deltasplat {
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

}  // namespace deltasplat
