// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vdb_stream.h"

#include <algorithm>
#include <cstring>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

constexpr std::uint64_t kStepBytes = std::uint64_t{4} << 20;

}  // namespace

VdbStreamBuf::VdbStreamBuf(const std::filesystem::path& file)
    : file_(file, std::ios::in | std::ios::binary) {
    if (!file_) {
        throw Error(ErrorCode::kInput,
                    gotExpected(file.string(), "a file that cannot be opened", "a readable file"));
    }
}

void VdbStreamBuf::addText(std::string text) {
    Piece piece;
    piece.size = text.size();
    piece.text = std::move(text);
    total_ += piece.size;
    pieces_.push_back(std::move(piece));
}

void VdbStreamBuf::addRange(std::uint64_t begin, std::uint64_t end) {
    Piece piece;
    piece.begin = begin;
    piece.size = end - begin;
    piece.inFile = true;
    total_ += piece.size;
    pieces_.push_back(std::move(piece));
}

std::streamsize VdbStreamBuf::readPiece(char* to, std::streamsize count) {
    while (piece_ < pieces_.size() && offset_ == pieces_[piece_].size) {
        ++piece_;
        offset_ = 0;
    }
    if (piece_ == pieces_.size()) return 0;
    const Piece& piece = pieces_[piece_];
    auto part = std::streamsize(std::min(std::uint64_t(count), piece.size - offset_));
    if (piece.inFile) {
        if (offset_ == 0) file_.seekg(std::streamoff(piece.begin));
        file_.read(to, part);
        part = file_.gcount();
    } else {
        std::memcpy(to, piece.text.data() + offset_, std::size_t(part));
    }
    offset_ += std::uint64_t(part);
    return part;
}

std::streamsize VdbStreamBuf::xsgetn(char* to, std::streamsize count) {
    std::streamsize done = 0;
    while (done < count) {
        const std::streamsize part = readPiece(to + done, count - done);
        if (part <= 0) break;
        done += part;
    }
    read_ += std::uint64_t(done);
    tell();
    return done;
}

void VdbStreamBuf::tell() {
    if (!step_ || (read_ - told_ < kStepBytes && read_ != total_)) return;
    told_ = read_;
    try {
        step_(double(read_) / double(total_));
    } catch (...) {
        stopped_ = std::current_exception();
        throw;
    }
}

VdbStreamBuf::int_type VdbStreamBuf::underflow() {
    char byte = 0;
    if (readPiece(&byte, 1) != 1) return traits_type::eof();
    --offset_;
    if (pieces_[piece_].inFile) file_.seekg(-1, std::ios::cur);
    return traits_type::to_int_type(byte);
}

VdbStreamBuf::int_type VdbStreamBuf::uflow() {
    char byte = 0;
    return xsgetn(&byte, 1) == 1 ? traits_type::to_int_type(byte) : traits_type::eof();
}

VdbStreamBuf::pos_type VdbStreamBuf::seekoff(off_type offset, std::ios_base::seekdir from,
                                             std::ios_base::openmode) {
    // Only asking for the position is allowed.
    const bool asks = offset == 0 && from == std::ios_base::cur;
    return asks ? pos_type(off_type(read_)) : pos_type(off_type(-1));
}

}  // namespace deltasplat
