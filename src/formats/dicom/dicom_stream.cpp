// SPDX-License-Identifier: Apache-2.0
// Based on: ITU-T T.800 (JPEG 2000), annexes A and I: the SIZ segment and the boxes around a code
// stream.
#include "formats/dicom/dicom_stream.h"

#include "formats/images/image_claims.h"

namespace deltasplat {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kJpeg = "\xff\xd8"sv;
constexpr std::string_view kJpeg2000 = "\xff\x4f\xff\x51"sv;
constexpr std::string_view kBoxes = "\0\0\0\x0cjP  "sv;

class BigEndian {
  public:
    explicit BigEndian(std::string_view bytes) : bytes_(bytes) {}
    // 0 beyond the end.
    std::uint64_t number(std::size_t place, std::size_t size) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const bool there = place + i < bytes_.size();
            value = value << 8 | (there ? static_cast<unsigned char>(bytes_[place + i]) : 0);
        }
        return value;
    }

  private:
    std::string_view bytes_;
};

std::optional<DicomStream> readSize(std::string_view bytes) {
    constexpr std::size_t kLeast = 43;
    if (bytes.size() < kLeast) return {};
    const BigEndian header(bytes);
    DicomStream stream;
    stream.saysSign = true;
    // The picture is what its offset leaves of the reference grid.
    const std::uint64_t right = header.number(8, 4);
    const std::uint64_t bottom = header.number(12, 4);
    const std::uint64_t left = header.number(16, 4);
    const std::uint64_t top = header.number(20, 4);
    if (left >= right || top >= bottom) return {};
    stream.columns = right - left;
    stream.rows = bottom - top;
    stream.components = int(header.number(40, 2));
    const auto depth = int(header.number(42, 1));
    stream.isSigned = depth >= 0x80;
    stream.bits = (depth & 0x7f) + 1;
    return stream;
}

std::optional<DicomStream> readFrame(std::string_view bytes) {
    std::size_t place = 0;
    const std::optional<JpegFrame> frame = findJpegFrame([&] {
        return place < bytes.size() ? int(static_cast<unsigned char>(bytes[place++])) : -1;
    });
    if (!frame) return {};
    DicomStream stream;
    stream.columns = std::uint64_t(frame->columns);
    stream.rows = std::uint64_t(frame->rows);
    stream.components = frame->components;
    stream.bits = frame->bits;
    return stream;
}

}  // namespace

std::optional<DicomStream> readStreamHeader(std::string_view bytes) {
    if (bytes.starts_with(kJpeg)) return readFrame(bytes);
    if (bytes.starts_with(kBoxes)) {
        const std::size_t codes = bytes.find(kJpeg2000);
        if (codes == std::string_view::npos) return {};
        bytes.remove_prefix(codes);
    }
    return bytes.starts_with(kJpeg2000) ? readSize(bytes) : std::nullopt;
}

bool beginsPicture(std::string_view bytes) {
    return bytes.starts_with(kJpeg) || bytes.starts_with(kJpeg2000) || bytes.starts_with(kBoxes);
}

}  // namespace deltasplat
