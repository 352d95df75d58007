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

/// What the program that wrote a TIFF says of its pages: ImageJ, Bio-Formats and others that write
/// OME-XML, tifffile, MetaMorph.
struct TiffVolume {
    /// Of each slice the number of its page.
    std::vector<std::int64_t> planes;
    /// Whether there is one page only, behind whose pixels those of the other slices lie.
    bool areBehind = false;
    std::int64_t volumes = 1;           ///< in the file, one of which it is
    std::optional<glm::dvec3> spacing;  ///< of voxels; empty: nobody says it
    std::string lengthUnit;             ///< of the spacing, as Volume::lengthUnit
    Rescale rescale;                    ///< of values
    bool isPaletteShown = false;        ///< a palette is how values are shown, not what they are
};

/// Finds the slices of a volume among the pages of a TIFF: all pages, in their order, if nobody
/// says anything else. Pages that are thumbnails, smaller copies or masks of others are left out,
/// which is said.
/// @param isAlone  whether it is no file of a stack: descriptions of several files tell nothing of
///                 one
/// @param chosen   which of several volumes is wanted, from 0 on: channels count fastest, then
///                 times, then pictures
/// @throw Error(kInput) as chooseVolume; if pages are missing that are spoken of; if a volume's
///        slices lie in other files
TiffVolume findTiffVolume(const std::filesystem::path& file, const TiffPages& tiff, bool isAlone,
                          const std::optional<std::int64_t>& chosen, const Listener& listener);

}  // namespace deltasplat
