// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "deltasplat/progress.h"
#include "deltasplat/view/camera.h"
#include "deltasplat/view/factorization.h"
#include "picture/prepared_axis.h"
#include "splat/sheet.h"

namespace deltasplat {

/// Volumes of fewer active voxels are drawn slice by slice: a few milliseconds are all that could
/// be saved. Tests make it less.
inline std::atomic<std::uint64_t> leastVoxelsJoined{std::uint64_t{1} << 23};

/// How one view of a picture is drawn: one of parallel lines of sight, or a region of an eye's.
struct ViewPlan {
    Factorization view;         ///< of the volume's own voxels
    Factorization thin;         ///< of what these are divided into, or joined to
    AxisPlan axis;              ///< of the words that slabs are rendered from
    double steps = 1;           ///< as stepsOf(view): that the picture's colours are for
    Footprint footprint;        ///< of one of those voxels
    SheetLayout sheet;          ///< of all slices, of four channels; empty for an empty volume
    double slopeSpacing = 0.0;  ///< from an eye: from a pixel of the base plane to the next
};

/// What a picture's words and layers are used for.
enum class DrawnFor {
    kPixels,  ///< one picture, perhaps with words of a few slabs at a time
    kSlabs,   ///< slabs that are rendered one by one
    kDepths   ///< cuts in depth: each slice has to be drawn by itself
};

/// How a picture is drawn. Made once for a scene and a camera, and changed by nobody.
struct DrawPlan {
    std::vector<ViewPlan> views;  ///< one, or one for each region of what an eye sees

    /// Slices that are drawn as one.
    int joined() const { return views.front().axis.key.parts.joined; }
};

/// @throw Error(kUsage) for options out of range, a division that is asked for and cannot be made,
///        and a camera that makeCamera did not return; Error(kFailed) for a volume too wide
DrawPlan planPicture(const PreparedScene::Impl& scene, const Camera& camera, DrawnFor drawnFor,
                     const Listener& listener);

/// Of a view, how long the way from one slice to the next is that colours are for, as a multiple of
/// the straight one; from an eye, each pixel has its own.
double stepsOf(const Factorization& view, const Volume& volume);

/// Returns the index position (x, y, z) that lines of sight of a view begin at.
/// @param eye  as Factorization::eye
glm::dvec3 indexOfEye(const glm::dvec3& eye, int sliceAxis);

}  // namespace deltasplat
