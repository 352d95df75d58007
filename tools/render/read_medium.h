// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "render/render_options.h"
#include "sequence/sequence_look.h"

namespace deltasplat {

/// Puts what layers say into what the volume is read by and shown in.
/// @throw Error(kUsage) for what cannot be besides
void applyLayers(const CLI::App& app, PictureOptions& picture);

/// Reads the grids that are shown besides a volume.
/// @param volume  as it was read; grids that lie voxel by voxel on it are cut as it is
/// @param look    of the sequence that it is a frame of; null: it is none
/// @throw as readVolume; Error(kUsage) for grids that are not there or of the wrong type
void readMedium(const std::filesystem::path& input, const PictureOptions& picture,
                const Volume& volume, Optics& optics, const Listener& listener,
                const FrameLook* look);

}  // namespace deltasplat
