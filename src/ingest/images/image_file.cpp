// SPDX-License-Identifier: Apache-2.0
#include "ingest/images/image_file.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "deltasplat/error.h"
#include "exr_threads.h"
#include "ingest/files/file_bytes.h"
#include "ingest/files/file_name.h"
#include "ingest/guards/cleared_memory.h"
#include "ingest/guards/silent_stderr.h"
#include "ingest/images/pgm_samples.h"
#include "printable.h"

namespace deltasplat {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

bool isTiff(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    return extension == ".tif" || extension == ".tiff";
}

// OpenImageIO repeats itself on further lines.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& complaint,
                         const std::string& expected) {
    const std::string reason = complaint.empty()
                                   ? "no reason given"
                                   : printable(complaint.substr(0, complaint.find('\n')));
    throw Error(ErrorCode::kInput,
                gotExpected(file.string(), "what OpenImageIO refuses (" + reason + ")", expected));
}

std::unique_ptr<ImageInput> openInput(const std::filesystem::path& file,
                                      OIIO::Filesystem::IOProxy* proxy, ImageSpec& spec) {
    requireRegularFile(file);
    ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // alpha is not asked for, so it must change nothing
    const SilentStderr silent;             // libpng prints what OpenImageIO then reports
    const ClearedMemory cleared;
    // Asked for by the name of a file that its format's reader refuses, OpenImageIO would hand it
    // to all of its readers, those of DICOM and films too.
    limitExrThreads();
    auto input = ImageInput::create(lowerExtension(file).substr(1));
    if (input && proxy != nullptr) input->set_ioproxy(proxy);
    if (!input || !input->open(file.string(), spec, config)) {
        refuse(file, input ? input->geterror() : OIIO::geterror(), "an image");
    }
    return input;
}

// The most bytes that one byte of a file can unpack to. A header that claims more lies.
double mostRatio(const std::filesystem::path& file, const ImageSpec& spec) {
    // OpenImageIO does not name the packing of formats that always pack, such as PNG.
    const std::string extension = lowerExtension(file);
    const bool netpbm = extension.size() == 4 && extension[1] == 'p' && extension[3] == 'm';
    const std::string packing = spec.get_string_attribute("compression", netpbm ? "none" : "");
    if (packing == "none") return 8;  // single bits become bytes
    if (packing.rfind("ccitt", 0) == 0) return 0x1p18;
    return 0x1p13;
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
    // OpenImageIO says that it has read them, and leaves zeros.
    const bool isOneByOne = spec.tile_width > 0 || spec.height == 1;
    if (isTiff(file) && isOneByOne && spec.format.size() == 8) {
        throw Error(ErrorCode::kInput, gotExpected(file.string(),
                                                   "64-bit numbers in tiles or one row, which "
                                                   "OpenImageIO cannot read",
                                                   "float32, or strips of an image of more rows"));
    }
    const bool flat = spec.depth <= 1 && !spec.deep;
    if (!flat || spec.width < 1 || spec.height < 1 || spec.nchannels < 1) {
        const std::string got = sizeText(spec) + (spec.deep ? ", deep" : "");
        throw Error(ErrorCode::kInput, gotExpected(file.string(), got, "a flat image with pixels"));
    }
    const double bytes = double(spec.width) * spec.height * spec.nchannels;
    const double held = double(std::filesystem::file_size(file));
    if (bytes <= (held + 1024) * mostRatio(file, spec)) return;
    throw Error(ErrorCode::kInput,
                gotExpected(file.string(), std::to_string(std::uint64_t(held)) + " bytes",
                            "enough for " + sizeText(spec)));
}

/// A TIFF as if it had one page: libtiff looks for each page from the first one on, which takes the
/// square of their number.
class OnePageProxy : public OIIO::Filesystem::IOProxy {
  public:
    OnePageProxy(const std::filesystem::path& file, const TiffPages& tiff, const TiffPage& page)
        : IOProxy(file.string(), Read),
          bytes_(file),
          bigEndian_(tiff.bigEndian),
          width_(std::size_t(tiff.offsetBytes)),
          firstField_(tiff.firstField),
          page_(page) {}

    const char* proxytype() const override { return "one page"; }
    std::size_t size() const override { return std::size_t(bytes_.size()); }
    std::size_t read(void* to, std::size_t bytes) override {
        const std::size_t got = pread(to, bytes, m_pos);
        m_pos += std::int64_t(got);
        return got;
    }
    std::size_t pread(void* to, std::size_t bytes, std::int64_t place) override {
        const std::size_t got = readPlain(to, bytes, place);
        replace(firstField_, page_.table, std::uint64_t(place), got, to);
        replace(page_.nextField, 0, std::uint64_t(place), got, to);
        return got;
    }

  private:
    // libtiff is C, through which nothing may be thrown.
    std::size_t readPlain(void* to, std::size_t bytes, std::int64_t place) const {
        try {
            return place < 0 ? 0 : bytes_.read(std::uint64_t(place), to, bytes);
        } catch (const Error&) {
            return 0;
        }
    }
    // Writes a number over those of its bytes that have been read.
    void replace(std::uint64_t field, std::uint64_t number, std::uint64_t place, std::size_t got,
                 void* to) const {
        for (std::size_t i = 0; i < width_; ++i) {
            const std::uint64_t at = field + (bigEndian_ ? width_ - 1 - i : i);
            const unsigned char byte = (number >> (8 * i)) & 0xff;
            if (at >= place && at - place < got) {
                std::memcpy(static_cast<char*>(to) + (at - place), &byte, 1);
            }
        }
    }

    FileBytes bytes_;
    bool bigEndian_;
    std::size_t width_;
    std::uint64_t firstField_;
    TiffPage page_;
};

ImagePages::ImagePages(const std::filesystem::path& file) {
    if (isTiff(file)) {
        tiff_ = walkTiff(file);
        return;
    }
    ImageSpec spec;
    const auto input = openInput(file, nullptr, spec);
    while (input->seek_subimage(count_, 0)) ++count_;
    input->geterror();
}

ImageFile::ImageFile(const std::filesystem::path& file, const ImagePages& pages, int page)
    : file_(file) {
    if (pages.tiff()) {
        proxy_ = std::make_unique<OnePageProxy>(file, *pages.tiff(),
                                                pages.tiff()->pages.at(std::size_t(page)));
    } else {
        page_ = page;
    }
    input_ = openInput(file, proxy_.get(), spec_);
    if (page_ > 0) spec_ = input_->spec(page_);
    // What is stored counts, as it does for wider numbers, which OpenImageIO leaves alone.
    isInverted_ = pages.isWhiteZero(page) && spec_.format == OIIO::TypeDesc::UINT8;
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
    if (!isInverted_) return true;
    const std::span bytes(static_cast<std::byte*>(to), values);
    for (std::byte& byte : bytes) byte = ~byte;
    return true;
}

// OpenImageIO's read_image would take, and here clear, 64 MiB for each image.
bool ImageFile::readStored(int channels, void* to) {
    if (spec_.tile_width > 0) return readTiles(channels, static_cast<std::byte*>(to));
    return input_->read_native_scanlines(page_, 0, spec_.y, spec_.y + spec_.height, 0, 0, channels,
                                         to);
}

// One by one, for tiles go over the edges of an image: asked for all of them, OpenImageIO's TIFF
// reader writes over the edges of what it is given.
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
    // Some of its readers fill up what is missing, and only leave a complaint.
    const std::string complaint = input_->geterror();
    if (!done || !complaint.empty()) refuse(file_, complaint, "a whole image");
}

}  // namespace deltasplat
