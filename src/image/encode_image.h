// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {

/// Adds what is said about how the picture was made, each thing by its name.
void addMetadata(const ImageFileOptions& options, OIIO::ImageSpec& spec);

/// Returns a picture of red, green, blue and alpha.
OIIO::ImageSpec rgbaSpec(glm::ivec2 size, OIIO::TypeDesc type);
/// The same in an .exr, with all that it has.
OIIO::ImageSpec exrSpec(glm::ivec2 size, const ImageFileOptions& options);

/// Adds what every .exr has: metadata, matrices, light's colour space, and no clock time.
void addExrAttributes(const ImageFileOptions& options, OIIO::ImageSpec& spec);

/// Encodes in memory, so that what can go wrong with the disk goes wrong in one place.
/// @param file         for messages
/// @param writePixels  false if the output's error says why not
std::string encodeInMemory(const std::filesystem::path& file, const char* formatName,
                           const OIIO::ImageSpec& spec,
                           const std::function<bool(OIIO::ImageOutput&)>& writePixels);

/// The same of an .exr of several parts.
/// @param writePart  writes the part of this number
std::string encodeParts(const std::filesystem::path& file,
                        const std::vector<OIIO::ImageSpec>& specs,
                        const std::function<bool(OIIO::ImageOutput&, std::size_t)>& writePart);

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

/// Says where in the display window the stored part of a picture lies.
/// @param first  its first pixel in the picture
void setWindows(const ExrOptions& options, glm::ivec2 sizePixels, glm::ivec2 first,
                OIIO::ImageSpec& spec);

}  // namespace deltasplat
