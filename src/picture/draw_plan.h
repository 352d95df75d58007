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

/// Volumes with fewer active voxels are drawn slice by slice, at little cost. Tests lower it.
inline std::atomic<std::uint64_t> leastVoxelsJoined{std::uint64_t{1} << 23};

/// Plan of one view: of parallel lines of sight, or of a region seen by an eye.
struct ViewPlan {
    Factorization view;         ///< of the volume's own voxels
    Factorization thin;         ///< of divided or joined voxels
    AxisPlan axis;              ///< of the words for the slabs
    double steps = 1;           ///< stepsOf(view), for the colours
    Footprint footprint;        ///< of a divided or joined voxel
    SheetLayout sheet;          ///< of all slices, with four channels; empty for an empty volume
    double slopeSpacing = 0.0;  ///< from an eye: slope between pixels of the base plane
};

enum class DrawnFor {
    kPixels,  ///< one picture, perhaps with words of a few slabs at a time
    kSlabs,   ///< slabs that are rendered one by one
    kDepths   ///< cuts in depth: each slice is drawn by itself
};

/// How a picture is drawn: constant for a scene and a camera.
struct DrawPlan {
    std::vector<ViewPlan> views;  ///< one, or one for each region seen by an eye

    int joined() const { return views.front().axis.key.parts.joined; }
};

/// @throw Error(kUsage) for options out of range, an impossible division, or a camera not from
///        makeCamera; Error(kFailed) for a volume too wide
DrawPlan planPicture(const PreparedScene::Impl& scene, const Camera& camera, DrawnFor drawnFor,
                     const Listener& listener);

/// Length of the view's steps for colours, in straight steps. From an eye, each pixel has its own.
double stepsOf(const Factorization& view, const Volume& volume);

/// Returns the index position (x, y, z) of a view's eye.
/// @param eye  as Factorization::eye
glm::dvec3 indexOfEye(const glm::dvec3& eye, int sliceAxis);

}  // namespace deltasplat
