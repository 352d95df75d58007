// SPDX-License-Identifier: Apache-2.0
// Based on: the PNG specification (W3C, third edition), sections 5 and 11; Microsoft's
// BITMAPINFOHEADER.
#include "formats/images/stored_numbers.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

#include "files/file_bytes.h"
#include "files/file_name.h"

namespace deltasplat {
namespace {

std::string read(const FileBytes& file, std::uint64_t place, std::size_t bytes) {
    std::string text(bytes, '\0');
    text.resize(file.read(place, text.data(), bytes));
    return text;
}

std::uint32_t numberAt(const std::string& bytes, std::size_t at, int width, bool bigEndian) {
    std::uint32_t value = 0;
    for (int i = 0; i < width; ++i) {
        const int digit = bigEndian ? i : width - 1 - i;
        value = value << 8 | static_cast<unsigned char>(bytes[at + std::size_t(digit)]);
    }
    return value;
}

constexpr std::size_t kPngHeader = 13, kChecksum = 4;  // bytes
constexpr std::uint64_t kPngPlace = 16;                // of the header

// The header and its checksum as those of greys, and what is known of colours, which stands before
// the pixels, as what may be passed over.
void addPngGreys(const FileBytes& file, std::string header, std::size_t colorType,
                 StoredNumbers& numbers) {
    header[colorType] = 0;
    const std::string summed = "IHDR" + header;
    const auto sum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(summed.data()), uInt(summed.size())));
    for (int shift = 24; shift >= 0; shift -= 8) header += char((sum >> shift) & 0xff);
    numbers.asGreys.emplace_back(kPngPlace, header);
    std::uint64_t place = kPngPlace + kPngHeader + kChecksum;
    // Each stands at most once in a file.
    bool colors = false, opacities = false;
    while (true) {
        const std::string head = read(file, place, 8);
        if (head.size() < 8 || head.ends_with("IDAT")) return;
        if ((head.ends_with("PLTE") && !std::exchange(colors, true)) ||
            (head.ends_with("tRNS") && !std::exchange(opacities, true)))
            numbers.asGreys.emplace_back(place + 4, "xxXx");
        place += 8 + std::uint64_t{numberAt(head, 0, 4, true)} + kChecksum;
    }
}

std::optional<StoredNumbers> numbersOfPng(const FileBytes& file) {
    constexpr std::size_t kBits = 8, kColorType = 9;
    const std::string bytes = read(file, 0, kPngPlace + kPngHeader);
    if (bytes.size() < kPngPlace + kPngHeader || !bytes.starts_with("\x89PNG")) return {};
    const std::string header = bytes.substr(kPngPlace);
    StoredNumbers numbers;
    numbers.bits = static_cast<unsigned char>(header[kBits]);
    numbers.isPalette = header[kColorType] == 3;
    if (numbers.isPalette) addPngGreys(file, header, kColorType, numbers);
    return numbers;
}

// The table of colours as one of greys.
std::optional<StoredNumbers> numbersOfBmp(const FileBytes& file) {
    constexpr std::size_t kSize = 14, kBits = 28, kColors = 46;
    constexpr std::size_t kOldHeader = 12;
    const std::string head = read(file, 0, 54);
    if (head.size() < 54 || !head.starts_with("BM")) return {};
    const std::size_t headerBytes = numberAt(head, kSize, 4, false);
    const bool isOld = headerBytes == kOldHeader;
    const std::uint32_t bits = numberAt(head, isOld ? 24 : kBits, 2, false);
    StoredNumbers numbers;
    numbers.isPalette = bits >= 1 && bits <= 8;
    if (!numbers.isPalette) return numbers;
    const std::uint32_t all = 1U << bits;
    const std::uint32_t used = isOld ? 0 : numberAt(head, kColors, 4, false);
    std::string greys;
    for (std::uint32_t i = 0; i < (used > 0 ? std::min(used, all) : all); ++i)
        greys += std::string(3, char(i)) + (isOld ? "" : std::string(1, '\0'));
    numbers.asGreys.emplace_back(kSize + headerBytes, greys);
    return numbers;
}

}  // namespace

std::optional<StoredNumbers> storedNumbers(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    if (extension == ".png") return numbersOfPng(FileBytes(path));
    if (extension == ".bmp") return numbersOfBmp(FileBytes(path));
    return {};
}

}  // namespace deltasplat
