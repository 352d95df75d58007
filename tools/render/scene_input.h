// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "deltasplat/progress.h"
#include "render/render_options.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// Makes of an INPUT that is a scene (.usda, perhaps with a prim's path behind a colon) the volume
/// that it shows; leaves others alone.
/// @param frames  of a sequence; empty: a single picture, of the first time sample
/// @throw Error(kInput) for the scene
void applyScene(const CLI::App& app, const std::vector<int>& frames, RenderCommand& command,
                const Listener& listener);

/// Puts what a scene shows at a frame into `command`; without a scene only the input.
/// @param input  of the frame; empty: the scene's
/// @throw Error(kInput) if it shows nothing there
void showFrame(std::optional<int> frame, const std::filesystem::path& input,
               RenderCommand& command);

/// Puts the files that a scene shows into frames. Those that it has none for get a name
/// that is none, as a file that is not there.
std::vector<FrameFiles> withScene(const SceneChoice& scene, std::vector<FrameFiles> frames);

/// Whether options are in millimetres: attenuation is that of one, and a C-arm is measured in them.
bool measuresMillimetres(const RenderOptions& render);

/// Moves a volume that was read to where a scene has it. Where options are in millimetres, its
/// world is too, if its unit is known, which is said.
Volume placed(const Volume& volume, const PictureOptions& picture, const Listener& listener = {});

}  // namespace deltasplat
