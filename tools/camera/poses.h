// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "deltasplat/view/camera.h"

namespace deltasplat {

/// How a C-arm stands for one picture. At angles of 0 the source of x-rays is behind the patient,
/// and the detector before the chest.
struct CArmPose {
    /// About the patient's long axis: above 0 the detector goes to the patient's left (LAO), below
    /// 0 to the right (RAO).
    double primaryDegrees = 0;
    /// Then about the axis across the beam: above 0 the detector goes to the head (CRA), below 0 to
    /// the feet (CAU).
    double secondaryDegrees = 0;
    double sourceToIsocenter = 0;  ///< mm, > 0
    double sourceToDetector = 0;   ///< mm, at least that
    double pixel = 0;              ///< mm, > 0: width and height of a pixel of the detector
};

/// Reads poses of frames 1, 2, ... from a text with commas: the columns' names (primary, secondary,
/// sid, sdd, pixel, in any order), then a line for each frame. Empty lines and those that begin
/// with # are passed over.
/// @throw Error(kInput) `<file>:<line>: got X; expected Y`
std::vector<CArmPose> readPoses(const std::filesystem::path& file);

/// Puts a camera where the pose has the source, looking at the target. The picture is seen from
/// there: the patient's right is on its right, as in view "back".
/// @param camera  with the size of the detector in pixels
void applyPose(const CArmPose& pose, CameraOptions& camera);

}  // namespace deltasplat
