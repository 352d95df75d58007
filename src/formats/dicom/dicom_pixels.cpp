// SPDX-License-Identifier: Apache-2.0
// Pixels that are not packed are read here. For others GDCM, in the helper program, gets a file
// made from what it needs: the packed pixels and the numbers that describe them, which are the
// packed picture's own. It would trust all else that a file holds, and end the helper where that is
// wrong.
#include "formats/dicom/dicom_pixels.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/raw/raw_format.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;

std::string littleEndian(std::uint64_t number, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += char(number >> (8 * i) & 0xff);
    return text;
}

std::string head(std::uint32_t tag, const std::string& type, std::uint64_t length) {
    const std::string start = littleEndian(tag >> 16, 2) + littleEndian(tag & 0xffff, 2) + type;
    const bool wide = type == "OB" || type == "OW";
    return wide ? start + littleEndian(0, 2) + littleEndian(length, 4)
                : start + littleEndian(length, 2);
}

std::string name(std::uint32_t tag, const std::string& type, std::string text) {
    if (text.size() % 2 != 0) text += type == "UI" ? '\0' : ' ';
    return head(tag, type, text.size()) + text;
}

std::string number(std::uint32_t tag, int value) {
    return head(tag, "US", 2) + littleEndian(std::uint64_t(value), 2);
}

void readBytes(const DicomSlice& slice, const DicomPixels::Piece& piece, char* to) {
    std::ifstream in(slice.file, std::ios::binary);
    in.seekg(std::streamoff(piece.start));
    if (!in.read(to, std::streamsize(piece.length))) {
        refuseFile(slice.file, "a read error", "a readable file");
    }
}

std::string readPiece(const DicomSlice& slice, const DicomPixels::Piece& piece) {
    std::string bytes(std::size_t(piece.length), '\0');
    readBytes(slice, piece, bytes.data());
    return bytes;
}

// What GDCM is told of an unpacked picture, and has to find again. Run lengths are of whole cells.
DicomUnpacking unpackingOf(const DicomPixels& pixels, const std::optional<DicomStream>& stream) {
    DicomUnpacking what;
    what.columns = pixels.columns;
    what.rows = pixels.rows;
    what.allocated = what.stored = pixels.bits.allocated;
    if (stream) {
        what.allocated = stream->bits <= 8 ? 8 : stream->bits <= 16 ? 16 : 32;
        what.stored = stream->bits;
        what.isSigned = stream->isSigned;
    }
    what.bytes = std::uint64_t(pixels.columns) * std::uint64_t(pixels.rows) *
                 std::uint64_t(what.allocated / 8);
    return what;
}

std::string sizeText(std::uint64_t columns, std::uint64_t rows) {
    return std::to_string(columns) + "x" + std::to_string(rows);
}

// Decoders take the sizes at their word that a packed picture says: they are held against the
// header's first.
std::optional<DicomStream> checkedStream(const DicomSlice& slice, const std::string& bytes) {
    const DicomPixels& pixels = slice.pixels;
    constexpr const char* kRunLengths = "1.2.840.10008.1.2.5";
    if (pixels.syntax == kRunLengths) return {};
    const std::optional<DicomStream> stream = readStreamHeader(bytes);
    if (!stream) {
        refuseFile(slice.file, "packed pixels that do not begin as a JPEG picture does",
                   "the pixels that the header names");
    }
    if (stream->columns != std::uint64_t(pixels.columns) ||
        stream->rows != std::uint64_t(pixels.rows) || stream->components != 1 || stream->bits < 1 ||
        stream->bits > 32) {
        refuseFile(slice.file,
                   "a packed picture of " + sizeText(stream->columns, stream->rows) +
                       " pixels of " + std::to_string(stream->components) + " numbers of " +
                       std::to_string(stream->bits) + " bits",
                   sizeText(std::uint64_t(pixels.columns), std::uint64_t(pixels.rows)) +
                       " of one number, as the header says");
    }
    return stream;
}

std::string fragment(const std::string& content) {
    return littleEndian(0xfffe, 2) + littleEndian(0xe000, 2) +
           littleEndian(content.size() + content.size() % 2, 4) + content +
           std::string(content.size() % 2, '\0');
}

// A CT slice, packed as the file is.
std::string cleanFile(const std::string& syntax, const DicomUnpacking& what,
                      const std::string& packed) {
    const std::string kClass = "1.2.840.10008.5.1.4.1.1.2";
    const std::string kInstance = "1.2.3.4";
    const std::string meta = name(0x00020002, "UI", kClass) + name(0x00020003, "UI", kInstance) +
                             name(0x00020010, "UI", syntax);
    std::string file = std::string(128, '\0') + "DICM" + head(0x00020000, "UL", 4) +
                       littleEndian(meta.size(), 4) + meta + name(0x00080016, "UI", kClass) +
                       name(0x00080018, "UI", kInstance) + number(0x00280002, 1) +
                       name(0x00280004, "CS", "MONOCHROME2") + number(0x00280010, what.rows) +
                       number(0x00280011, what.columns) + number(0x00280100, what.allocated) +
                       number(0x00280101, what.stored) + number(0x00280102, what.stored - 1) +
                       number(0x00280103, what.isSigned ? 1 : 0) +
                       head(0x7fe00010, "OB", kUndefined) + fragment("");
    return file + fragment(packed) + littleEndian(0xfffe, 2) + littleEndian(0xe0dd, 2) +
           littleEndian(0, 4);
}

DicomCells unpackedCells(const DicomSlice& slice, HelperProcess& helper) {
#ifndef DELTASPLAT_DICOM
    refuseFile(slice.file, "packed pixels", "a build with DELTASPLAT_DICOM=ON to unpack them");
#endif
    const DicomPixels& pixels = slice.pixels;
    double length = 0;
    for (const DicomPixels::Piece& piece : pixels.pieces) length += double(piece.length);
    constexpr double kCopies = 7;  // here, in the helper and on the way
    requireMemory(slice.file.string(), kCopies * length);
    std::string packed;  // in one piece: GDCM does not join those of JPEG 2000
    for (const DicomPixels::Piece& piece : pixels.pieces) packed += readPiece(slice, piece);
    DicomCells cells;
    cells.stream = checkedStream(slice, packed);
    const DicomUnpacking what = unpackingOf(pixels, cells.stream);
    constexpr double kTimes = 18;  // here, in the helper and on the way, and what codecs take
    requireMemory(slice.file.string(), kTimes * double(what.bytes));
    cells.bits = what.allocated;
    cells.bigEndian = std::endian::native == std::endian::big;
    cells.bytes.resize(std::size_t(what.bytes));
    std::string request(sizeof what, '\0');
    std::memcpy(request.data(), &what, sizeof what);
    helper.beginRequest(request + cleanFile(pixels.syntax, what, packed), cells.bytes.size());
    const bool done = helper.finishRequest(cells.bytes.data());
    if (!done) {
        refuseFile(slice.file, "pixels that GDCM cannot unpack, or not all of them",
                   "the pixels that the header names");
    }
    return cells;
}

// Big endian are words of two bytes, of which a cell of four bytes has the lower first, and of
// which pictures of one byte a pixel may begin or end in the middle.
DicomCells plainCells(const DicomSlice& slice) {
    const DicomPixels& pixels = slice.pixels;
    const DicomPixels::Piece& piece = pixels.pieces.at(0);
    const bool inWords = pixels.bigEndian && pixels.words;
    DicomCells cells;
    cells.bits = pixels.bits.allocated;
    cells.bigEndian = pixels.bigEndian && !inWords;
    const std::uint64_t before = inWords ? (piece.start - pixels.element.start) % 2 : 0;
    std::uint64_t length = before + piece.length;
    requireMemory(slice.file.string(), double(length));
    if (inWords) {
        const std::uint64_t end = pixels.element.start + pixels.element.length;
        length = std::min(length + length % 2, end + before - piece.start);
    }
    cells.bytes.resize(std::size_t(length));
    readBytes(slice, {piece.start - before, length}, reinterpret_cast<char*>(cells.bytes.data()));
    for (std::size_t i = 0; inWords && i + 1 < cells.bytes.size(); i += 2)
        std::swap(cells.bytes[i], cells.bytes[i + 1]);
    cells.bytes.erase(cells.bytes.begin(), cells.bytes.begin() + std::ptrdiff_t(before));
    cells.bytes.resize(std::size_t(piece.length));
    return cells;
}

// Turns cells into the numbers that are stored in them.
class NumberTaker {
  public:
    NumberTaker(const DicomBits& bits, const DicomCells& cells)
        : isSigned_(bits.isSigned),
          cellSigned_(cells.stream && cells.stream->isSigned),
          allocated_(bits.allocated),
          cellBits_(cells.stream ? cells.stream->bits : cells.bits),
          stored_(bits.stored) {
        shift_ = cellBits_ > bits.high ? bits.high + 1 - bits.stored : 0;
        // Where header and packed picture differ about signs, the picture knows where the sign is.
        const bool differ =
            cells.stream && cells.stream->saysSign && cells.stream->isSigned != bits.isSigned;
        if (differ) stored_ = std::min(stored_, cellBits_);
    }

    std::int64_t stored(std::uint64_t cell) const {
        return numberOfBits(std::uint64_t(whole(cell)) >> shift_, stored_, isSigned_);
    }
    /// Returns the number that all bits of a cell are.
    std::int64_t wholeCell(std::uint64_t cell) const {
        return numberOfBits(std::uint64_t(whole(cell)), allocated_, isSigned_);
    }

  private:
    std::int64_t whole(std::uint64_t cell) const {
        return numberOfBits(cell, cellBits_, cellSigned_);
    }

    bool isSigned_;
    bool cellSigned_;
    int allocated_;
    int cellBits_;
    int stored_;
    int shift_ = 0;
};

// Turns cells into values.
class ValueTaker {
  public:
    ValueTaker(const DicomSlice& slice, const DicomCells& cells, double nothing)
        : numbers_(slice.pixels.bits, cells), meaning_(slice.meaning), nothing_(nothing) {
        // What fills up may be a number that the stored bits cannot be: then it is all of a cell.
        const DicomBits& bits = slice.pixels.bits;
        if (!meaning_.padding) return;
        padsCells_ = meaning_.padding->first < bits.least() || meaning_.padding->last > bits.most();
    }

    double valueOf(std::uint64_t cell) const {
        const std::int64_t number = numbers_.stored(cell);
        if (meaning_.padding &&
            (meaning_.padding->contains(number) ||
             (padsCells_ && meaning_.padding->contains(numbers_.wholeCell(cell)))))
            return nothing_;
        if (meaning_.measured && !meaning_.measured->contains(number)) return nothing_;
        return meaning_.valueOf(number);
    }

  private:
    NumberTaker numbers_;
    const DicomMeaning& meaning_;
    double nothing_;
    bool padsCells_ = false;
};

template <typename Cell, typename To>
void takeRow(const ValueTaker& taker, const std::byte* from, bool swap, std::size_t count,
             std::byte* to) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto value =
            valueAs<To>(taker.valueOf(loadValue<Cell>(from + i * sizeof(Cell), swap)));
        std::memcpy(to + i * sizeof(To), &value, sizeof(To));
    }
}

template <typename To>
void takeRow(const ValueTaker& taker, const DicomCells& cells, std::size_t first, std::size_t count,
             std::byte* to) {
    const bool swap = mustSwap(cells.bigEndian);
    const std::byte* const from = cells.bytes.data() + first * std::size_t(cells.bits / 8);
    if (cells.bits == 8) return takeRow<std::uint8_t, To>(taker, from, swap, count, to);
    if (cells.bits == 16) return takeRow<std::uint16_t, To>(taker, from, swap, count, to);
    takeRow<std::uint32_t, To>(taker, from, swap, count, to);
}

}  // namespace

void DicomReader::read(const DicomSlice& slice, const DicomTarget& target, std::byte* to) {
    const DicomPixels& pixels = slice.pixels;
    const std::uint64_t place = pixels.pieces.empty() ? 0 : pixels.pieces[0].start;
    if (file_ != slice.file || place_ != place) {
        file_.clear();
        cells_ = {};
        cells_ = pixels.packed ? unpackedCells(slice, helper_) : plainCells(slice);
        file_ = slice.file;
        place_ = place;
    }
    const ValueTaker taker(slice, cells_, target.nothing);
    const auto rowBytes = std::size_t(slice.columns) * std::size_t(rawTypeBytes(target.type));
    parallelForChunks(std::size_t(slice.rows), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const std::size_t first = (std::size_t(slice.top) + row) * std::size_t(pixels.columns) +
                                      std::size_t(slice.left);
            withRawType(target.type, [&](auto zero) {
                takeRow<decltype(zero)>(taker, cells_, first, std::size_t(slice.columns),
                                        to + row * rowBytes);
            });
        }
    });
}

}  // namespace deltasplat
