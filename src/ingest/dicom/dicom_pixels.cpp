// SPDX-License-Identifier: Apache-2.0
// GDCM, with which ITK reads DICOM, gets a file made here from what it needs: the pixels and the
// numbers that describe them. It would trust all else that a file holds, and end the process where
// that is wrong.
#include "ingest/dicom/dicom_pixels.h"

#include <gdcmImage.h>
#include <gdcmImageReader.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include "deltasplat/error.h"
#include "ingest/guards/cleared_memory.h"
#include "ingest/guards/in_child.h"
#include "ingest/itk/itk_calls.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;

[[noreturn]] void refuse(const DicomSlice& slice, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(slice.file.string(), got, expected));
}

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

std::string readPiece(const DicomSlice& slice, const DicomPixels::Piece& piece) {
    std::string bytes(std::size_t(piece.length), '\0');
    std::ifstream in(slice.file, std::ios::binary);
    in.seekg(std::streamoff(piece.start));
    if (!in.read(bytes.data(), std::streamsize(piece.length))) {
        refuse(slice, "a read error", "a readable file");
    }
    return bytes;
}

void turnRound(std::string& bytes, std::size_t width) {
    for (std::size_t i = 0; i + width <= bytes.size(); i += width) {
        std::reverse(bytes.begin() + std::ptrdiff_t(i), bytes.begin() + std::ptrdiff_t(i + width));
    }
}

std::string pixelElement(const DicomSlice& slice) {
    const DicomPixels& pixels = slice.pixels;
    constexpr std::uint32_t kPixels = 0x7fe00010;
    if (!pixels.packed) {
        std::string bytes = readPiece(slice, pixels.pieces.at(0));
        // Words of two bytes may hold pixels of one.
        const auto width = std::size_t(pixels.bitsAllocated / 8);
        if (pixels.bigEndian)
            turnRound(bytes, pixels.words ? std::max<std::size_t>(width, 2) : width);
        if (bytes.size() % 2 != 0) bytes += '\0';
        return head(kPixels, pixels.bitsAllocated > 8 ? "OW" : "OB", bytes.size()) + bytes;
    }
    std::string bytes = head(kPixels, "OB", kUndefined);
    for (const DicomPixels::Piece& piece : pixels.pieces) {
        const std::string content = readPiece(slice, piece);
        bytes += littleEndian(0xfffe, 2) + littleEndian(0xe000, 2) +
                 littleEndian(content.size() + content.size() % 2, 4) + content +
                 std::string(content.size() % 2, '\0');
    }
    return bytes + littleEndian(0xfffe, 2) + littleEndian(0xe0dd, 2) + littleEndian(0, 4);
}

// A CT slice in explicit little endian, or packed as the file is.
std::string cleanFile(const DicomSlice& slice) {
    const DicomPixels& pixels = slice.pixels;
    const std::string kClass = "1.2.840.10008.5.1.4.1.1.2";
    const std::string kInstance = "1.2.3.4";
    const std::string meta =
        name(0x00020002, "UI", kClass) + name(0x00020003, "UI", kInstance) +
        name(0x00020010, "UI", pixels.packed ? pixels.syntax : "1.2.840.10008.1.2.1");
    return std::string(128, '\0') + "DICM" + head(0x00020000, "UL", 4) +
           littleEndian(meta.size(), 4) + meta + name(0x00080016, "UI", kClass) +
           name(0x00080018, "UI", kInstance) + number(0x00280002, 1) +
           name(0x00280004, "CS", "MONOCHROME2") + number(0x00280010, slice.rows) +
           number(0x00280011, slice.columns) + number(0x00280100, pixels.bitsAllocated) +
           number(0x00280101, pixels.bitsStored) + number(0x00280102, pixels.bitsStored - 1) +
           number(0x00280103, pixels.isSigned ? 1 : 0) + pixelElement(slice);
}

gdcm::PixelFormat formatOf(const DicomPixels& pixels) {
    using Number = unsigned short;
    return gdcm::PixelFormat(1, Number(pixels.bitsAllocated), Number(pixels.bitsStored),
                             Number(pixels.bitsStored - 1), pixels.isSigned ? 1 : 0);
}

RawType storedType(const DicomPixels& pixels) {
    if (pixels.bitsAllocated == 8) return pixels.isSigned ? RawType::kInt8 : RawType::kUint8;
    if (pixels.bitsAllocated == 16) return pixels.isSigned ? RawType::kInt16 : RawType::kUint16;
    return pixels.isSigned ? RawType::kInt32 : RawType::kUint32;
}

// Where a child's libraries complain: libjpeg, inside of GDCM, makes up what a code stream lacks,
// and prints that it did.
class Complaints {
  public:
    Complaints() : file_(::memfd_create("complaints", 0)) {
        std::fflush(stderr);
        ::dup2(file_, STDERR_FILENO);
    }
    bool any() const {
        std::fflush(stderr);
        struct stat status {};
        return ::fstat(file_, &status) != 0 || status.st_size != 0;
    }

  private:
    int file_;
};

bool unpack(const DicomSlice& slice, const std::string& clean, std::size_t bytes, std::byte* out) {
    std::istringstream in(clean);
    gdcm::ImageReader reader;
    reader.SetStream(in);
    if (!reader.Read()) return false;
    const gdcm::Image& image = reader.GetImage();
    const unsigned* dims = image.GetDimensions();
    return dims[0] == unsigned(slice.columns) && dims[1] == unsigned(slice.rows) &&
           image.GetPixelFormat() == formatOf(slice.pixels) && image.GetBufferLength() == bytes &&
           image.GetBuffer(reinterpret_cast<char*>(out));
}

}  // namespace

RawType dicomValueType(const DicomPixels& pixels) {
    if (pixels.rescale.isIdentity()) return storedType(pixels);
    const double least = pixels.isSigned ? -std::ldexp(1, pixels.bitsStored - 1) : 0;
    const double most = std::ldexp(1, pixels.bitsStored - (pixels.isSigned ? 1 : 0)) - 1;
    return rescaledWholeType(least, most, pixels.rescale).value_or(RawType::kFloat64);
}

void readDicomPixels(const DicomSlice& slice, std::byte* to) {
    const std::size_t count = std::size_t(slice.columns) * std::size_t(slice.rows);
    const RawType stored = storedType(slice.pixels);
    const std::size_t bytes = count * std::size_t(rawTypeBytes(stored));
    const auto values = std::make_unique<std::byte[]>(bytes);
    const std::string clean = cleanFile(slice);
    const ClearedMemory cleared;
    const auto work = [&](std::byte* out) { return unpack(slice, clean, bytes, out); };
    bool done = false;
    if (slice.pixels.packed) {
        // GDCM's codecs end the process where packed pixels are damaged.
        const auto complete = [&](std::byte* out) {
            const Complaints complaints;
            return work(out) && !complaints.any();
        };
        done = inChild(bytes, complete, values.get());
    } else {
        callItk(slice.file, Printed::kIsNothing, [&] { done = work(values.get()); });
    }
    if (!done) {
        refuse(slice, "pixels that GDCM cannot unpack, or not all of them",
               "the pixels that the header names");
    }
    constexpr bool kBigEndian = std::endian::native == std::endian::big;
    rescaleValues(values.get(), count, stored, kBigEndian, slice.pixels.rescale, slice.type, to);
}

}  // namespace deltasplat
