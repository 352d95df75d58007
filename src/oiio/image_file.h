// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "deltasplat/threads.h"
#include "formats/images/tiff_pages.h"

namespace deltasplat {

/// Returns "640x480 uint8, channels: 3".
std::string sizeText(const OIIO::ImageSpec& spec);

/// Whether the first channels are R, G and B.
bool hasColors(const OIIO::ImageSpec& spec);

/// @throw Error(kInput) unless it is flat, has pixels, the file can be long enough to hold them,
///        and OpenImageIO can read such numbers
void requireSane(const std::filesystem::path& file, const OIIO::ImageSpec& spec);

/// How many pages an image file has, and where those of a TIFF are.
class ImagePages {
  public:
    ImagePages() = default;
    /// @throw Error(kInput) if the file is no image, or a TIFF that is not whole
    explicit ImagePages(const std::filesystem::path& file);

    int count() const { return tiff_ ? int(tiff_->pages.size()) : count_; }
    const std::optional<TiffPages>& tiff() const { return tiff_; }
    /// Whether its numbers are those of a palette's colours.
    bool isPalette(int page) const {
        return tiff_ ? tiff_->pages[std::size_t(page)].paletteField != 0 : isPalette_;
    }
    /// Whether smaller values are meant to be shown brighter.
    bool isWhiteZero(int page) const {
        return tiff_ && tiff_->pages[std::size_t(page)].whiteIsZero;
    }

  private:
    std::optional<TiffPages> tiff_;
    int count_ = 1;
    bool isPalette_ = false;
};

/// What is read of a pixel.
enum class Samples {
    kShown,   ///< shares of what is white: numbers of 1 to 7 bits become ones of 8, and so on
    kStored,  ///< numbers of few bits as they are stored
    kNumbers  ///< the same, of a palette not the colours but their numbers
};

class PatchedFile;

/// One page of an image file, open.
class ImageFile {
  public:
    /// @throw Error(kInput) if OpenImageIO refuses it
    ImageFile(const std::filesystem::path& file, const ImagePages& pages, int page,
              Samples samples = Samples::kShown);
    ~ImageFile();
    ImageFile(const ImageFile&) = delete;
    ImageFile& operator=(const ImageFile&) = delete;

    const OIIO::ImageSpec& spec() const { return spec_; }
    /// Reads the first channels of all pixels.
    /// @throw Error(kInput) if OpenImageIO refuses them, or complains of them
    void read(int channels, OIIO::TypeDesc type, void* to);

  private:
    bool readNative(int channels, void* to);
    bool readStored(int channels, void* to);
    bool readTiles(int channels, std::byte* to);
    bool readPixels(int channels, OIIO::TypeDesc type, void* to);

    std::filesystem::path file_;
    std::unique_ptr<PatchedFile> proxy_;  // used by input_
    std::unique_ptr<OIIO::ImageInput> input_;
    OIIO::ImageSpec spec_;
    int page_ = 0;  // as OpenImageIO counts
    bool isPgm_ = false;
    bool isInverted_ = false;  // by OpenImageIO
    int bits_ = 0;             // of a number as it is stored, if OpenImageIO stretches it; else 0
};

/// Makes OpenEXR use as many threads as the library where OpenImageIO reads with it, which would
/// start as many as there are cores. For who writes with it there is ExrThreads
/// (src/image/exr_header.h).
/// @param mayThread  whether there may be several at all: each has memory of its own
inline void limitExrThreads(bool mayThread) {
    constexpr int kNone = -1;  // but the caller
    OIIO::attribute("exr_threads", mayThread && threadCount() > 1 ? threadCount() : kNone);
}

}  // namespace deltasplat
