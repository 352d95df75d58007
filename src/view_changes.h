// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "picture_view.h"

namespace deltasplat {

/// What of a view is not what another view showed.
struct ViewChanges {
    /// Rows of the base plane [x, y), outside of which the layers of both have the same bits; none
    /// if y <= x.
    glm::ivec2 differingRows{0};
    glm::ivec2 shownRows{0};      ///< [x, y), outside of which both are zero; none if y <= x
    std::uint64_t differing = 0;  ///< as those of SlabChanges, of all slabs
    std::uint64_t shown = 0;
};

/// Whether another view can be compared with one, and there is so much memory that what that takes
/// and the view's layer may stay until then.
bool mayBeKept(const PictureView& view);

/// Compares all that layers are made of. Of other units of light, all rows differ. Empty if that
/// cannot be told: of another base plane, other sheets or slabs, or light that is everywhere other.
std::optional<ViewChanges> compareViews(const PictureView& before, const PictureView& now);

}  // namespace deltasplat
