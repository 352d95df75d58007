// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/image/image.h"

namespace deltasplat {

/// What a picture is of.
struct PictureFacts {
    std::string grid;
    glm::ivec3 dims{0};
    std::optional<glm::dvec2> range;  ///< of values; empty: not known
    bool isEmpty = false;             ///< no voxel is active: the picture shows nothing
};

/// What the index of a batch says of one picture.
struct IndexEntry {
    std::filesystem::path input;
    std::filesystem::path folder;  ///< as it is shown
    std::filesystem::path picture;
    PictureFacts facts;
    std::optional<double> seconds;  ///< that it took; empty: it was there already
    std::string thumbnail;          ///< a .jpg; empty: none
    std::string failure;            ///< what went wrong; empty: nothing
};

/// A page of pictures, one file that needs nothing else.
struct Index {
    std::string title;
    std::string commandLine;
    double seconds = 0;   ///< that all of it took
    glm::ivec2 shape{1};  ///< width to height of the pictures
    std::vector<IndexEntry> entries;
};

/// The longer side that thumbnails have at most, in pixels.
inline constexpr int kThumbnailSide = 320;

/// Returns the thumbnail of a picture, over the page's dark.
std::string thumbnailOf(Image image);

/// Returns the page.
/// @param file  where it will be: pictures are linked to from there
std::string indexText(const Index& index, const std::filesystem::path& file);

}  // namespace deltasplat
