// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "formats/dense/rescale.h"
#include "formats/images/tiff_pages.h"

namespace deltasplat {

/// The volume that a TIFF's metadata describes: ImageJ's, OME-XML, tifffile's or MetaMorph's.
struct TiffVolume {
    std::vector<std::int64_t> planes;   ///< page of each slice
    bool areBehind = false;             ///< the file has one page; other slices follow its pixels
    std::int64_t volumes = 1;           ///< in the file; this is one of them
    std::optional<glm::dvec3> spacing;  ///< of voxels; empty: unknown
    std::string lengthUnit;             ///< of the spacing, as Volume::lengthUnit
    Rescale rescale;
    bool isPaletteShown = false;  ///< the palette is for display only, values are numbers
};

/// Finds a volume's slices among a TIFF's pages: all pages in order unless metadata says otherwise.
/// Skips thumbnails, smaller copies and masks, with a warning.
/// @param isAlone  whether the file is not part of a stack, where only ImageJ's metadata counts
/// @param chosen   the wanted volume, from 0 on: channels fastest, then times, then pictures
/// @throw Error(kInput) as chooseVolume; if named pages are missing, or slices lie in other files
TiffVolume findTiffVolume(const std::filesystem::path& file, const TiffPages& tiff, bool isAlone,
                          const std::optional<std::int64_t>& chosen, const Listener& listener);

}  // namespace deltasplat
