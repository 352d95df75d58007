// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <exception>
#include <filesystem>
#include <glm/vec2.hpp>
#include <new>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
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

}  // namespace deltasplat
