// SPDX-License-Identifier: Apache-2.0
#include "oiio/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/cleared_memory.h"
#include "base/memory.h"
#include "base/silent_stderr.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "formats/images/image_claims.h"
#include "formats/input_kind.h"

namespace deltasplat {

namespace {

/// Whether a file is a grey Netpbm image, plain (P2) or binary (P5). OpenImageIO 2.4 stretches its
/// samples to the type's range, and rounds half of the 16-bit samples down by one.
bool isPgm(const std::filesystem::path& file);

/// Reads a .pgm's first image with samples as stored, whatever the maximum. Writes one byte per
/// sample if the maximum is at most 255, else two.
/// @param to  one entry per pixel
/// @throw Error(kInput) unless the file has `pixels` whole samples, none above its maximum
void readPgm(const std::filesystem::path& file, std::size_t pixels, std::span<std::byte> to);

// Based on: Netpbm's description of its pgm format.
constexpr std::uint32_t kMost = 65535;

class Numbers {
  public:
    Numbers(const std::filesystem::path& file, const std::vector<unsigned char>& bytes)
        : file_(file), bytes_(bytes) {}

    // Skips white space and comments.
    std::uint32_t next() {
        while (place_ < bytes_.size() && !std::isdigit(bytes_[place_])) {
            const unsigned char byte = bytes_[place_++];
            if (byte == '#') {
                while (place_ < bytes_.size() && bytes_[place_] != '\n') ++place_;
            } else if (!std::isspace(byte)) {
                refuseFile(file_, "a byte " + std::to_string(byte) + " where a number should be",
                           "a whole .pgm image");
            }
        }
        if (place_ == bytes_.size())
            refuseFile(file_, "a file that is cut short", "a whole .pgm image");
        std::uint64_t number = 0;
        for (; place_ < bytes_.size() && std::isdigit(bytes_[place_]); ++place_) {
            number = 10 * number + (bytes_[place_] - '0');
            if (number > 0xffffffff) refuseFile(file_, "a number of many digits", "a .pgm image");
        }
        return std::uint32_t(number);
    }
    // A binary raster starts one byte after the header's last number.
    std::size_t place() const { return place_; }
    void skip(std::size_t bytes) { place_ += bytes; }

  private:
    const std::filesystem::path& file_;
    const std::vector<unsigned char>& bytes_;
    std::size_t place_ = 0;
};

void put(std::uint32_t sample, std::size_t width, std::byte* to) {
    const auto small = std::uint8_t(sample);
    const auto large = std::uint16_t(sample);
    std::memcpy(to, width == 1 ? static_cast<const void*>(&small) : &large, width);
}

bool isPgm(const std::filesystem::path& file) {
    char magic[2];
    const FileBytes bytes(file);
    return bytes.read(0, magic, 2) == 2 && magic[0] == 'P' && (magic[1] == '2' || magic[1] == '5');
}

void readPgm(const std::filesystem::path& file, std::size_t pixels, std::span<std::byte> to) {
    const FileBytes source(file);
    const auto read = [&](std::uint64_t place, std::uint64_t size) {
        requireClaimedMemory(file.string(), double(size));
        std::vector<unsigned char> bytes(size);
        bytes.resize(source.read(place, bytes.data(), bytes.size()));
        return bytes;
    };
    // A header has about twenty bytes, plus comments.
    constexpr std::uint64_t kMostHeader = std::uint64_t{1} << 16;
    std::vector<unsigned char> bytes = read(0, std::min(kMostHeader, source.size()));
    const bool isBinary = bytes.size() > 1 && bytes[1] == '5';
    if (!isBinary) bytes = read(0, source.size());
    Numbers numbers(file, bytes);
    numbers.skip(2);
    const std::uint64_t size = std::uint64_t{numbers.next()} * numbers.next();
    const std::uint32_t most = numbers.next();
    if (size != pixels) refuseFile(file, std::to_string(size) + " pixels", std::to_string(pixels));
    if (most < 1 || most > kMost) {
        refuseFile(file, "samples up to " + std::to_string(most),
                   "at most " + std::to_string(kMost) + ", at least 1");
    }
    const std::size_t width = most < 256 ? 1 : 2;
    if (to.size() != pixels * width) {
        refuseFile(file, std::to_string(width) + " bytes a sample",
                   std::to_string(to.size() / pixels));
    }
    std::vector<unsigned char> raster;
    if (isBinary) {
        raster = read(numbers.place() + 1, pixels * width);
        if (raster.size() < pixels * width)
            refuseFile(file, "a file that is cut short", "a whole .pgm image");
    }
    const unsigned char* next = raster.data();
    for (std::size_t i = 0; i < pixels; ++i) {
        std::uint32_t sample = 0;
        if (!isBinary) {
            sample = numbers.next();
        } else {
            for (std::size_t n = 0; n < width; ++n) sample = sample << 8 | *next++;
        }
        if (sample > most) {
            refuseFile(file, "a sample of " + std::to_string(sample),
                       "at most " + std::to_string(most) + ", as its header says");
        }
        put(sample, width, to.data() + i * width);
    }
}

/// Storage of numbers, from the header of a .png or .bmp.
struct StoredNumbers {
    int bits = 8;            ///< per number: 1, 2, 4, 8 or 16; for a .bmp as decoded
    bool isPalette = false;  ///< whether they are palette indices
    /// For a palette: replacement bytes, by offset, that make the indices greys.
    std::vector<std::pair<std::uint64_t, std::string>> asGreys;
};

/// Returns nothing for other extensions or without such a header.
std::optional<StoredNumbers> storedNumbers(const std::filesystem::path& file);

// Based on: PNG specification (W3C, third edition), sections 5, 11; Microsoft's BITMAPINFOHEADER.
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
constexpr std::uint64_t kPngPlace = 16;                // offset of the header

// Turns the header and its checksum into a grey image's, and makes colour chunks ignorable.
void addPngGreys(const FileBytes& file, std::string header, std::size_t colorType,
                 StoredNumbers& numbers) {
    header[colorType] = 0;
    const std::string summed = "IHDR" + header;
    const auto sum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(summed.data()), uInt(summed.size())));
    for (int shift = 24; shift >= 0; shift -= 8) header += char((sum >> shift) & 0xff);
    numbers.asGreys.emplace_back(kPngPlace, header);
    std::uint64_t place = kPngPlace + kPngHeader + kChecksum;
    // Each chunk occurs at most once.
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

// Replaces the colour table by a grey ramp.
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

std::optional<StoredNumbers> storedNumbers(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    if (extension == ".png") return numbersOfPng(FileBytes(path));
    if (extension == ".bmp") return numbersOfBmp(FileBytes(path));
    return {};
}

using OIIO::ImageInput;
using OIIO::ImageSpec;

// OpenImageIO repeats its message on further lines.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& complaint,
                         const std::string& expected) {
    const std::string reason = complaint.empty()
                                   ? "no reason given"
                                   : printable(complaint.substr(0, complaint.find('\n')));
    throw Error(ErrorCode::kInput, file.string(), "what OpenImageIO refuses (" + reason + ")",
                expected);
}

std::unique_ptr<ImageInput> openInput(const std::filesystem::path& file,
                                      OIIO::Filesystem::IOProxy* proxy, ImageSpec& spec) {
    requireRegularFile(file);
    ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // unused alpha must not change colours
    const SilentStderr silent;             // libpng prints errors that OpenImageIO also reports
    const ClearedMemory cleared;
    // Asks for the format's own reader. Given a file name that this reader refuses, OpenImageIO
    // would try all others, including DICOM and movies.
    limitExrThreads(isTiffName(file) || requireClaims(file));
    auto input = ImageInput::create(lowerExtension(file).substr(1));
    if (input && proxy != nullptr) input->set_ioproxy(proxy);
    if (!input || !input->open(file.string(), spec, config)) {
        refuse(file, input ? input->geterror() : OIIO::geterror(), "an image");
    }
    return input;
}

// OpenImageIO gives no compression for formats that always compress, such as PNG.
std::string packingOf(const std::filesystem::path& file, const ImageSpec& spec) {
    const std::string extension = lowerExtension(file);
    const bool netpbm = extension.size() == 4 && extension[1] == 'p' && extension[3] == 'm';
    return spec.get_string_attribute("compression", netpbm ? "none" : "");
}

}  // namespace

std::string sizeText(const ImageSpec& spec) {
    return std::to_string(spec.width) + "x" + std::to_string(spec.height) + " " +
           spec.format.c_str() + ", channels: " + std::to_string(spec.nchannels);
}

bool hasColors(const ImageSpec& spec) {
    return spec.nchannels >= 3 && spec.channelnames[0] == "R" && spec.channelnames[1] == "G" &&
           spec.channelnames[2] == "B";
}

void requireSane(const std::filesystem::path& file, const ImageSpec& spec) {
    // OpenImageIO reports success for these but returns zeros.
    const bool isOneByOne = spec.tile_width > 0 || spec.height == 1;
    if (isTiffName(file) && isOneByOne && spec.format.size() == 8) {
        throw Error(ErrorCode::kInput, file.string(),
                    "64-bit numbers in tiles or one row, which "
                    "OpenImageIO cannot read",
                    "float32, or strips of an image of more rows");
    }
    const bool flat = spec.depth <= 1 && !spec.deep;
    if (!flat || spec.width < 1 || spec.height < 1 || spec.nchannels < 1) {
        const std::string got = sizeText(spec) + (spec.deep ? ", deep" : "");
        throw Error(ErrorCode::kInput, file.string(), got, "a flat image with pixels");
    }
    const double bytes = double(spec.width) * spec.height * spec.nchannels;
    const double held = double(std::filesystem::file_size(file));
    if (isEnough(held, mostRatio(packingOf(file, spec)), bytes)) return;
    throw Error(ErrorCode::kInput, file.string(), std::to_string(std::uint64_t(held)) + " bytes",
                "enough for " + sizeText(spec));
}

/// A file in which readers see some bytes replaced.
class PatchedFile : public OIIO::Filesystem::IOProxy {
  public:
    explicit PatchedFile(const std::filesystem::path& file)
        : IOProxy(file.string(), Read), bytes_(file) {}

    const char* proxytype() const override { return "patched"; }
    std::size_t size() const override { return std::size_t(bytes_.size()); }
    std::size_t read(void* to, std::size_t bytes) override {
        const std::size_t got = pread(to, bytes, m_pos);
        m_pos += std::int64_t(got);
        return got;
    }
    std::size_t pread(void* to, std::size_t bytes, std::int64_t place) override {
        const std::size_t got = readPlain(to, bytes, place);
        for (const auto& [at, text] : patches_) replace(at, text, std::uint64_t(place), got, to);
        return got;
    }
    void patch(std::uint64_t place, std::string bytes) {
        patches_.emplace_back(place, std::move(bytes));
    }
    void patch(std::uint64_t place, std::uint64_t number, int bytes, bool bigEndian) {
        std::string text(std::size_t(bytes), '\0');
        for (int i = 0; i < bytes; ++i)
            text[std::size_t(bigEndian ? bytes - 1 - i : i)] = char((number >> (8 * i)) & 0xff);
        patch(place, std::move(text));
    }

  private:
    // C readers must not see exceptions.
    std::size_t readPlain(void* to, std::size_t bytes, std::int64_t place) const {
        try {
            return place < 0 ? 0 : bytes_.read(std::uint64_t(place), to, bytes);
        } catch (const Error&) {
            return 0;
        }
    }
    // Overwrites patched bytes within the range just read.
    static void replace(std::uint64_t field, const std::string& text, std::uint64_t place,
                        std::size_t got, void* to) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            const std::uint64_t at = field + i;
            if (at >= place && at - place < got) static_cast<char*>(to)[at - place] = text[i];
        }
    }

    FileBytes bytes_;
    std::vector<std::pair<std::uint64_t, std::string>> patches_;
};

namespace {

// Makes a page the only one: libtiff searches each page from the first, taking quadratic time.
void patchTiff(const TiffPages& tiff, const TiffPage& page, bool asNumbers, PatchedFile& file) {
    constexpr std::uint64_t kBlackIsZero = 1;
    file.patch(tiff.firstField, page.table, tiff.offsetBytes, tiff.bigEndian);
    file.patch(page.nextField, 0, tiff.offsetBytes, tiff.bigEndian);
    if (asNumbers && page.paletteField != 0)
        file.patch(page.paletteField, kBlackIsZero, 2, tiff.bigEndian);
}

// Reverts OpenImageIO's stretching: value * largest / largest of few bits, rounded down.
template <typename T>
void unstretch(int bits, std::span<std::byte> bytes) {
    const std::uint64_t highest = (std::uint64_t{1} << bits) - 1;
    constexpr std::uint64_t kMost = std::numeric_limits<T>::max();
    for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
        T value;
        std::memcpy(&value, &bytes[at], sizeof(T));
        value = T((value * highest + kMost - 1) / kMost);
        std::memcpy(&bytes[at], &value, sizeof(T));
    }
}

void unstretch(const OIIO::TypeDesc& type, int bits, std::span<std::byte> bytes) {
    if (type == OIIO::TypeDesc::UINT8) unstretch<std::uint8_t>(bits, bytes);
    if (type == OIIO::TypeDesc::UINT16) unstretch<std::uint16_t>(bits, bytes);
    if (type == OIIO::TypeDesc::UINT32) unstretch<std::uint32_t>(bits, bytes);
}

// Returns the bits per stored number if OpenImageIO stretches numbers; else 0.
int storedBits(const std::filesystem::path& file, const ImageSpec& spec,
               const std::optional<StoredNumbers>& said) {
    const int bits = said               ? said->bits
                     : isTiffName(file) ? spec.get_int_attribute("oiio:BitsPerSample", 0)
                                        : 0;
    const bool isUnsigned = spec.format == OIIO::TypeDesc::UINT8 ||
                            spec.format == OIIO::TypeDesc::UINT16 ||
                            spec.format == OIIO::TypeDesc::UINT32;
    return isUnsigned && bits > 0 && bits < int(8 * spec.format.size()) ? bits : 0;
}

}  // namespace

ImagePages::ImagePages(const std::filesystem::path& file) {
    if (isTiffName(file)) {
        tiff_ = walkTiff(file);
        return;
    }
    if (const std::optional<StoredNumbers> said = storedNumbers(file)) isPalette_ = said->isPalette;
    ImageSpec spec;
    const auto input = openInput(file, nullptr, spec);
    while (input->seek_subimage(count_, 0)) ++count_;
    input->geterror();
}

ImageFile::ImageFile(const std::filesystem::path& file, const ImagePages& pages, int page,
                     Samples samples)
    : file_(file) {
    const bool asNumbers = samples == Samples::kNumbers;
    const std::optional<StoredNumbers> said = storedNumbers(file);
    if (pages.tiff()) {
        proxy_ = std::make_unique<PatchedFile>(file);
        patchTiff(*pages.tiff(), pages.tiff()->pages.at(std::size_t(page)), asNumbers, *proxy_);
    } else if (said && said->isPalette && asNumbers) {
        proxy_ = std::make_unique<PatchedFile>(file);
        for (const auto& [place, bytes] : said->asGreys) proxy_->patch(place, bytes);
    } else {
        page_ = page;
    }
    input_ = openInput(file, proxy_.get(), spec_);
    if (page_ > 0) spec_ = input_->spec(page_);
    // OpenImageIO inverts only 8-bit numbers; undo that, because stored values count.
    isInverted_ = pages.isWhiteZero(page) && spec_.format == OIIO::TypeDesc::UINT8;
    // Palette colours are whole bytes.
    const bool isColored = pages.isPalette(page) && !asNumbers;
    if (samples != Samples::kShown && !isColored) bits_ = storedBits(file, spec_, said);
    isPgm_ = spec_.nchannels == 1 && lowerExtension(file) == ".pgm" && isPgm(file);
}

ImageFile::~ImageFile() {
    const SilentStderr silent;
    input_.reset();
}

bool ImageFile::readNative(int channels, void* to) {
    const std::size_t values =
        std::size_t(spec_.width) * std::size_t(spec_.height) * std::size_t(channels);
    if (isPgm_) {
        readPgm(file_, values, {static_cast<std::byte*>(to), values * spec_.format.size()});
        return true;
    }
    if (!readStored(channels, to)) return false;
    const std::span bytes(static_cast<std::byte*>(to), values * spec_.format.size());
    if (isInverted_)
        for (std::byte& byte : bytes) byte = ~byte;
    if (bits_ > 0) unstretch(spec_.format, bits_, bytes);
    return true;
}

// OpenImageIO's read_image would allocate, and here clear, 64 MiB per image.
bool ImageFile::readStored(int channels, void* to) {
    if (spec_.tile_width > 0) return readTiles(channels, static_cast<std::byte*>(to));
    return input_->read_native_scanlines(page_, 0, spec_.y, spec_.y + spec_.height, 0, 0, channels,
                                         to);
}

// One by one: asked for all tiles, OpenImageIO's TIFF reader overruns the buffer at image edges.
bool ImageFile::readTiles(int channels, std::byte* to) {
    const std::size_t stored = std::size_t(spec_.nchannels) * spec_.format.size();
    const std::size_t wanted = std::size_t(channels) * spec_.format.size();
    const std::size_t tileRow = std::size_t(spec_.tile_width) * stored;
    const std::size_t imageRow = std::size_t(spec_.width) * wanted;
    const auto tile = std::make_unique<std::byte[]>(tileRow * std::size_t(spec_.tile_height));
    for (int y = 0; y < spec_.height; y += spec_.tile_height) {
        for (int x = 0; x < spec_.width; x += spec_.tile_width) {
            if (!input_->read_native_tile(page_, 0, spec_.x + x, spec_.y + y, 0, tile.get()))
                return false;
            const int rows = std::min(spec_.tile_height, spec_.height - y);
            const int columns = std::min(spec_.tile_width, spec_.width - x);
            for (int row = 0; row < rows; ++row) {
                const std::byte* from = tile.get() + std::size_t(row) * tileRow;
                std::byte* into = to + std::size_t(y + row) * imageRow + std::size_t(x) * wanted;
                for (int column = 0; column < columns; ++column, from += stored, into += wanted)
                    std::memcpy(into, from, wanted);
            }
        }
    }
    return true;
}

bool ImageFile::readPixels(int channels, OIIO::TypeDesc type, void* to) {
    const bool mixed = !spec_.channelformats.empty();
    if (mixed) return input_->read_image(page_, 0, 0, channels, type, to);
    if (spec_.format == type) return readNative(channels, to);
    const std::size_t rowValues = std::size_t(spec_.width) * std::size_t(channels);
    const std::size_t rowBytes = rowValues * spec_.format.size();
    const auto native = std::make_unique<std::byte[]>(rowBytes * std::size_t(spec_.height));
    if (!readNative(channels, native.get())) return false;
    for (std::size_t row = 0; row < std::size_t(spec_.height); ++row) {
        OIIO::convert_pixel_values(spec_.format, native.get() + row * rowBytes, type,
                                   static_cast<std::byte*>(to) + row * rowValues * type.size(),
                                   int(rowValues));
    }
    return true;
}

void ImageFile::read(int channels, OIIO::TypeDesc type, void* to) {
    const SilentStderr silent;
    const ClearedMemory cleared;
    const bool done = readPixels(channels, type, to);
    // Some readers fill in missing pixels and only leave an error message.
    const std::string complaint = input_->geterror();
    if (!done || !complaint.empty()) refuse(file_, complaint, "a whole image");
}

}  // namespace deltasplat
