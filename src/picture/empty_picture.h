// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/affine.h"
#include "base/text.h"
#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Returns what is said of a picture that shows nothing of a volume though it has something to
/// show.
/// @param tooSmall  what of it may also be the reason: "is far smaller than a pixel"
inline std::string emptyPictureText(const Volume& volume, const std::string& tooSmall) {
    const WorldBox world = worldBox(volume.box, volume.worldFromIndex);
    return "picture: empty, for what can be seen of the volume lies outside of it, before the near "
           "plane, or " +
           tooSmall + "; the volume lies in the world from " + numberText(world.min) + " to " +
           numberText(world.max);
}

/// Returns what is said of a picture that shows something that nobody will see.
inline std::string faintPictureText() {
    return "picture: looks empty, for no pixel is opaque to a half of 1/255: what can be seen of "
           "the volume is far thinner than a pixel, or hardly opaque; `cropIndex` shows a part of "
           "it larger, and `extinctionScale` makes it denser";
}

}  // namespace deltasplat
