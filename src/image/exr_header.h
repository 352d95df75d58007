// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <exception>
#include <filesystem>
#include <glm/vec2.hpp>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Returns a header with all metadata except the channels.
/// @param box  the stored part of the picture
/// @param usualCompression  used unless the options name one
Imf::Header exrHeader(const ImageFileOptions& options, glm::ivec2 sizePixels, const PixelBox& box,
                      const std::string& usualCompression);

/// While this object lives, OpenEXR has at least as many threads as the library uses for the
/// calling thread; more if other threads need more.
class ExrThreads {
  public:
    ExrThreads();
    ~ExrThreads();
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;
};

/// Writes with OpenEXR, on the library's number of threads.
/// @param write  may throw OpenEXR's exceptions
template <typename Write>
void writeExr(const std::filesystem::path& file, const Write& write) {
    try {
        const ExrThreads threads;
        write();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& problem) {
        throw Error(ErrorCode::kOutput,
                    file.string() + ": cannot be encoded: " + printable(problem.what()));
    }
}

class ExrMemoryStream : public Imf::OStream {
  public:
    explicit ExrMemoryStream(const std::filesystem::path& file) : OStream(file.c_str()) {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// Returns the written bytes. Call it once.
    std::string takeBytes() { return std::move(bytes_); }

  private:
    std::string bytes_;
    std::uint64_t at_ = 0;
};

/// An OpenEXR output stream to a descriptor. Writes never fail, because OpenEXR hides a failure at
/// the end of a file; problem() reports it.
class ExrFileStream : public Imf::OStream {
  public:
    ExrFileStream(const std::filesystem::path& file, int descriptor)
        : OStream(file.c_str()), descriptor_(descriptor) {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// The first failure as an errno, or 0.
    int problem() const { return problem_; }

  private:
    int descriptor_;
    std::uint64_t at_ = 0;
    int problem_ = 0;
};

/// Returns the least box in `within` of pixels with colour or channel data. Multi-threaded.
PixelBox seenBox(const Image& image, const PixelBox& within,
                 std::span<const ImageChannel> channels);
/// Returns the smallest box around pixels with samples.
PixelBox seenBox(const DeepImage& image, const PixelBox& within);

/// Returns the box of rows whose range of seen pixels is known.
/// @param spans  pixels [x, y) per row, from row `first` on; none if y <= x
PixelBox boxOfRows(int first, std::span<const glm::ivec2> spans);

/// Returns the stored part of a picture: all, its region, or the seen part; at least one pixel.
/// @param seenIn  returns the seen part of a box
template <typename SeenIn>
PixelBox storedBox(const ImageFileOptions& options, glm::ivec2 size, const SeenIn& seenIn) {
    const PixelBox part = options.region.value_or(PixelBox{{0, 0}, size});
    if (!options.exr.autocrop) return part;
    const PixelBox seen = seenIn(part);
    return seen.empty() ? PixelBox{part.min, part.min + 1} : seen;
}

}  // namespace deltasplat
