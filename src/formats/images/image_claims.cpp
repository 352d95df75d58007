// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenEXR project, "OpenEXR File Layout"; Microsoft's BITMAPINFOHEADER.
#include "formats/images/image_claims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/memory.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "formats/images/tiff_pages.h"
#include "formats/input_kind.h"

namespace deltasplat {

namespace {

void requireEnough(const std::string& where, const FileBytes& file, double ratio, double width,
                   double height, double pixelBytes) {
    if (isEnough(double(file.size()), ratio, width * height * pixelBytes)) return;
    throw Error(ErrorCode::kInput, where, std::to_string(file.size()) + " bytes",
                "enough for " + std::to_string(std::int64_t(width)) + "x" +
                    std::to_string(std::int64_t(height)) + " pixels");
}

// Reads numbers and texts from a file in sequence; zeros after its end.
class Reader {
  public:
    explicit Reader(const FileBytes& file) : file_(file) {}

    bool ended() const { return place_ > file_.size(); }
    void skip(std::uint64_t bytes) {
        place_ =
            bytes <= file_.size() && place_ <= file_.size() ? place_ + bytes : file_.size() + 1;
    }
    std::uint8_t byte() {
        if (place_ < begin_ || place_ >= begin_ + length_) {
            begin_ = place_;
            length_ = ended() ? 0 : file_.read(place_, bytes_.data(), bytes_.size());
        }
        const std::uint8_t value = length_ > 0 ? bytes_[std::size_t(place_ - begin_)] : 0;
        if (!ended()) ++place_;
        return value;
    }
    // Little endian.
    std::uint32_t number(int bytes) {
        std::uint32_t value = 0;
        for (int i = 0; i < bytes; ++i) value |= std::uint32_t(byte()) << (8 * i);
        return value;
    }
    // A text that ends with 0. These formats have none of more than 255 bytes.
    std::string text() {
        std::string text;
        for (char c = char(byte()); c != 0; c = char(byte())) {
            text += c;
            if (text.size() > 255) skip(file_.size());
        }
        return text;
    }

  private:
    const FileBytes& file_;
    std::uint64_t place_ = 0;
    std::array<std::uint8_t, 4096> bytes_{};  // most recently read
    std::uint64_t begin_ = 0;
    std::size_t length_ = 0;
};

// One picture of an .exr, from its header.
struct ExrPart {
    double width = 0, height = 0;
    double pixelBytes = 0;
    std::size_t compression = 0;
    bool isDeep = false;
    std::optional<std::array<double, 2>> tile;

    // Per kind of compression: lines per block, and the most bytes that one byte unpacks to.
    static constexpr std::array<double, 10> kLines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    static constexpr std::array<double, 10> kRatios{1,    64, 1032, 1032,   0x1p13,
                                                    1376, 16, 16,   0x1p13, 0x1p13};
};

void readExrChannels(Reader& reader, ExrPart& part) {
    while (!reader.ended() && !reader.text().empty()) {
        const std::uint32_t type = reader.number(4);
        reader.skip(12);
        part.pixelBytes += type == 1 ? 2 : 4;  // half, or float and uint
    }
}

// Returns nothing after the last part.
std::optional<ExrPart> readExrPart(Reader& reader) {
    ExrPart part;
    bool isAny = false;
    for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
        isAny = true;
        reader.text();
        const std::uint32_t bytes = reader.number(4);
        Reader value = reader;
        reader.skip(bytes);
        if (reader.ended()) return {};
        if (name == "channels") readExrChannels(value, part);
        if (name == "compression") part.compression = value.number(1);
        // The number of deep samples is unknown, but each pixel stores its count.
        if (name == "type") part.isDeep = value.text().starts_with("deep");
        if (name == "tiles") part.tile = {double(value.number(4)), double(value.number(4))};
        if (name != "dataWindow") continue;
        const auto left = std::int32_t(value.number(4)), top = std::int32_t(value.number(4));
        part.width = double(std::int32_t(value.number(4))) - left + 1;
        part.height = double(std::int32_t(value.number(4))) - top + 1;
    }
    if (!isAny) return {};
    if (part.isDeep) part.pixelBytes = 4;
    return part;
}

// OpenEXR holds a block three times (stored, unpacked, intermediate), two blocks per thread.
bool requireExr(const std::string& where, const FileBytes& file) {
    constexpr double kTimes = 3;
    constexpr double kMuch = double(64 << 20);
    constexpr std::uint32_t kManyParts = 0x1000;
    Reader reader(file);
    reader.skip(4);
    const bool isMany = (reader.number(4) & kManyParts) != 0;
    bool mayThread = true;
    do {
        const std::optional<ExrPart> part = readExrPart(reader);
        if (!part || part->compression >= ExrPart::kLines.size()) return mayThread;
        const double lines = ExrPart::kLines[part->compression];
        const double width = part->tile ? (*part->tile)[0] : part->width;
        const double height = part->tile ? (*part->tile)[1] : lines;
        requireEnough(where, file, ExrPart::kRatios[part->compression], part->width, part->height,
                      part->pixelBytes);
        const double block = kTimes * width * height * part->pixelBytes;
        const double blocks = std::max(1, 2 * threadCount());
        const double picture = part->width * part->height * part->pixelBytes;
        if (block * blocks > std::max(kMuch, picture)) mayThread = false;
        requireClaimedMemory(where, block * (mayThread ? blocks : 1));
    } while (isMany && !reader.ended());
    return mayThread;
}

// Progressive JPEGs are held whole.
void requireJpeg(const std::string& where, const FileBytes& file) {
    constexpr int kLastOfOnePass = 0xc1;
    Reader reader(file);
    const std::optional<JpegFrame> frame = findJpegFrame([&] {
        const int byte = reader.byte();
        return reader.ended() ? -1 : byte;
    });
    if (!frame) return;
    requireEnough(where, file, mostRatio(""), frame->columns, frame->rows, frame->components);
    if (frame->marker > kLastOfOnePass) {
        requireClaimedMemory(where, 2.0 * frame->columns * double(frame->rows) * frame->components);
    }
}

// Runs of one colour are unpacked at once.
void requireBmp(const std::string& where, const FileBytes& file) {
    Reader reader(file);
    reader.skip(18);
    const double width = std::abs(double(std::int32_t(reader.number(4))));
    const double height = std::abs(double(std::int32_t(reader.number(4))));
    reader.skip(4);
    const std::uint32_t packing = reader.number(4);
    if (!reader.ended() && packing != 0)
        requireEnough(where, file, mostRatio(""), width, height, 1);
}

}  // namespace

double mostRatio(const std::string& packing) {
    if (packing == "none") return 8;  // bits become bytes
    if (packing == "zstd") return 0x1p15;
    if (packing.rfind("ccitt", 0) == 0) return 0x1p18;
    return 0x1p13;
}

bool isEnough(double packedBytes, double ratio, double unpackedBytes) {
    constexpr double kOthers = 1024;  // bytes stored elsewhere
    return unpackedBytes <= (packedBytes + kOthers) * ratio;
}

bool requireClaims(const std::filesystem::path& file) {
    if (isTiffName(file)) {
        walkTiff(file);
        return true;
    }
    const std::string extension = lowerExtension(file);
    const FileBytes bytes(file);
    if (extension == ".exr") return requireExr(file.string(), bytes);
    if (extension == ".jpg" || extension == ".jpeg") requireJpeg(file.string(), bytes);
    if (extension == ".bmp") requireBmp(file.string(), bytes);
    return true;
}

// Based on: ITU-T T.81 (JPEG), annex B: frame headers; T.87 (JPEG-LS), annex C.
namespace {

bool isFrame(int marker) {
    constexpr int kTables = 0xc4, kOther = 0xc8, kArithmetic = 0xcc, kLosslessFrame = 0xf7;
    return marker == kLosslessFrame || (marker >= 0xc0 && marker <= 0xcf && marker != kTables &&
                                        marker != kOther && marker != kArithmetic);
}

// Markers without a length.
bool isAlone(int marker) {
    return marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8);
}

}  // namespace

std::optional<JpegFrame> findJpegFrame(const std::function<int()>& next) {
    constexpr int kEnd = 0xd9, kScan = 0xda;
    const auto word = [&] {
        const int high = next();
        return high << 8 | next();  // -1 after the last byte
    };
    for (int byte = next(); byte >= 0; byte = next()) {
        if (byte != 0xff) continue;
        int marker = 0xff;
        while (marker == 0xff) marker = next();
        if (isAlone(marker)) continue;
        if (marker == kEnd || marker == kScan) return {};
        const int bytes = word();
        if (isFrame(marker)) {
            JpegFrame frame{marker, next()};
            frame.rows = word();
            frame.columns = word();
            frame.components = next();
            if (frame.components < 0) return {};
            return frame;
        }
        for (int i = 2; i < bytes; ++i) next();
    }
    return {};
}

}  // namespace deltasplat
