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

/// Returns a header with all that is said about a picture, but its channels.
/// @param sizePixels  of the picture
/// @param box         what is stored of it
/// @param usualCompression  where none is asked for
Imf::Header exrHeader(const ImageFileOptions& options, glm::ivec2 sizePixels, const PixelBox& box,
                      const std::string& usualCompression);

/// While this object lives, OpenEXR has as many threads as the library uses for what the calling
/// thread asks of it, or more that others need at the time.
class ExrThreads {
  public:
    ExrThreads();
    ~ExrThreads();
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;
};

/// Writes by OpenEXR, on as many threads as the library has.
/// @param file   for messages
/// @param write  may throw what OpenEXR throws
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

/// Where OpenEXR writes to a string.
class ExrMemoryStream : public Imf::OStream {
  public:
    /// @param file  for messages
    explicit ExrMemoryStream(const std::filesystem::path& file) : OStream(file.c_str()) {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// What has been written. Call it once.
    std::string takeBytes() { return std::move(bytes_); }

  private:
    std::string bytes_;
    std::uint64_t at_ = 0;
};

/// Where OpenEXR writes to a descriptor. No write fails, for OpenEXR says nothing of one that does
/// when it ends a file: problem() does.
class ExrFileStream : public Imf::OStream {
  public:
    /// @param file  for messages
    ExrFileStream(const std::filesystem::path& file, int descriptor)
        : OStream(file.c_str()), descriptor_(descriptor) {}

    void write(const char text[], int size) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    /// What went wrong first, as errno has it, or 0.
    int problem() const { return problem_; }

  private:
    int descriptor_;
    std::uint64_t at_ = 0;
    int problem_ = 0;
};

/// Returns the least box around all pixels of a part that are not clear, or at which a channel
/// tells of something; empty if there are none. Multi-threaded.
PixelBox seenBox(const Image& image, const PixelBox& within,
                 std::span<const ImageChannel> channels);
/// The same of pixels that have samples.
PixelBox seenBox(const DeepImage& image, const PixelBox& within);

/// The same of rows whose first and last pixel seen are known.
/// @param spans  of each row from `first` on pixels [x, y), none if y <= x
PixelBox boxOfRows(int first, std::span<const glm::ivec2> spans);

/// Returns the part of a picture that is stored: all of it, its region, or what is seen of that, at
/// least one pixel.
/// @param seenIn  what is seen in a box
template <typename SeenIn>
PixelBox storedBox(const ImageFileOptions& options, glm::ivec2 size, const SeenIn& seenIn) {
    const PixelBox part = options.region.value_or(PixelBox{{0, 0}, size});
    if (!options.exr.autocrop) return part;
    const PixelBox seen = seenIn(part);
    return seen.empty() ? PixelBox{part.min, part.min + 1} : seen;
}

}  // namespace deltasplat
