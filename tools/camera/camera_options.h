// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "deltasplat/progress.h"
#include "render/render_options.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// Declares the options of cameras that other programs have made.
void addCameraFileOptions(CLI::App& app, PictureOptions& options);

/// Refuses what says twice where the camera is, and reads the file of --camera or --poses.
/// @param frames  of a sequence; none: a single picture, which is shown by the first key. With
///                `keepGoing` those whose own file cannot be read fail later, unless all do
/// @throw Error(kUsage), or Error(kInput) for the file
void applyCamera(const CLI::App& app, const FrameChoice& frames, PictureOptions& options,
                 const Listener& listener);

/// Returns the files of a camera that has one for each frame; nothing if all have the one of that
/// very name, or a part of it.
std::optional<FrameName> cameraFiles(const PictureOptions& options);

/// Returns the file that a camera is read from; of several the name that they have in common. Empty
/// without --camera and --poses.
std::filesystem::path cameraFile(const PictureOptions& options);

/// Returns whether the camera is another one in each frame.
bool cameraMoves(const PictureOptions& options);

/// Returns the camera that a file describes, at a frame or, without one, at its first key.
/// @param options  after applyCamera, with --camera or --poses
/// @throw Error(kInput) if that frame's could not be read
CameraOptions cameraAt(const PictureOptions& options, std::optional<int> frame);

/// Warns of a volume that another program would have cut off before or behind its camera, which is
/// seen all the same.
void warnOfClipping(const PictureOptions& options, std::optional<int> frame, const Volume& volume,
                    const Listener& listener);

}  // namespace deltasplat
