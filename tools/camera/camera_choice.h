// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "camera/poses.h"
#include "deltasplat/cameras/read_camera.h"
#include "deltasplat/error.h"

namespace deltasplat {

/// A camera that a file describes instead of options.
struct CameraChoice {
    std::filesystem::path file;  ///< perhaps with a prim's path behind a colon; empty: none
    CameraMotion motion;         ///< once it is read
    std::map<int, CameraMotion> ofFrames;  ///< of a file for each frame of a sequence
    std::map<int, Error> unread;           ///< why that of a frame could not be read

    std::filesystem::path posesFile;  ///< of a C-arm in each frame, in place of all that; or empty
    std::vector<CArmPose> poses;      ///< of frames 1, 2, ...; once they are read

    bool isNearGiven = false;  ///< --near counts, not the file's

    bool asked() const { return !file.empty(); }
    bool moves() const { return !motion.frames.empty() || !ofFrames.empty() || !poses.empty(); }
};

}  // namespace deltasplat
