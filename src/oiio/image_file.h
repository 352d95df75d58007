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

/// @throw Error(kInput) unless the image is flat, has pixels, may fit into its file, and has a
///        sample type that OpenImageIO can read
void requireSane(const std::filesystem::path& file, const OIIO::ImageSpec& spec);

/// The number of pages in an image file, and their places in a TIFF.
class ImagePages {
  public:
    ImagePages() = default;
    /// @throw Error(kInput) if the file is no image, or a damaged TIFF
    explicit ImagePages(const std::filesystem::path& file);

    int count() const { return tiff_ ? int(tiff_->pages.size()) : count_; }
    const std::optional<TiffPages>& tiff() const { return tiff_; }
    /// Whether the page's numbers are palette indices.
    bool isPalette(int page) const {
        return tiff_ ? tiff_->pages[std::size_t(page)].paletteField != 0 : isPalette_;
    }
    bool isWhiteZero(int page) const {
        return tiff_ && tiff_->pages[std::size_t(page)].whiteIsZero;
    }

  private:
    std::optional<TiffPages> tiff_;
    int count_ = 1;
    bool isPalette_ = false;
};

/// Interpretation of a pixel's samples.
enum class Samples {
    kShown,   ///< shares of white; 1 to 7 bits are stretched to 8, and so on
    kStored,  ///< numbers as stored, even of few bits
    kNumbers  ///< as kStored, but palette indices instead of colours
};

class PatchedFile;

/// One open page of an image file.
class ImageFile {
  public:
    /// @throw Error(kInput) if OpenImageIO refuses the file
    ImageFile(const std::filesystem::path& file, const ImagePages& pages, int page,
              Samples samples = Samples::kShown);
    ~ImageFile();
    ImageFile(const ImageFile&) = delete;
    ImageFile& operator=(const ImageFile&) = delete;

    const OIIO::ImageSpec& spec() const { return spec_; }
    /// Reads the first channels of all pixels.
    /// @throw Error(kInput) if OpenImageIO refuses the pixels or reports an error
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
    int page_ = 0;  // OpenImageIO's number
    bool isPgm_ = false;
    bool isInverted_ = false;  // by OpenImageIO
    int bits_ = 0;             // bits per stored number if OpenImageIO stretches it; else 0
};

/// Limits OpenEXR to the library's threads when OpenImageIO reads with it; the default is one per
/// core. Writers use ExrThreads (src/image/exr_header.h).
/// @param mayThread  whether several threads are allowed; each has its own memory
inline void limitExrThreads(bool mayThread) {
    constexpr int kNone = -1;  // only the caller
    OIIO::attribute("exr_threads", mayThread && threadCount() > 1 ? threadCount() : kNone);
}

}  // namespace deltasplat
