// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "render/render_options.h"
#include "sequence/sequence_look.h"

namespace deltasplat {

/// Returns the options to render with, the transfer function read if one was given.
/// @throw Error(kInput) if it cannot be read
RenderOptions readOptics(const PictureOptions& picture, const Listener& listener);

/// Reads a volume and puts into `options` what depends on it: without a transfer function the grey
/// ramp over its values.
/// @param look  of the sequence that it is a frame of; null: it is none
/// @throw Error(kInput), Error(kUsage) as readVolume
Volume readToRender(const std::filesystem::path& input, const PictureOptions& picture,
                    RenderOptions& options, const Listener& listener,
                    const FrameLook* look = nullptr);

/// Returns the options to render a volume with that is there already: readOptics and what depends
/// on the volume. Not of media, whose other grids are not read.
/// @param look  of the sequence that it is shown in
RenderOptions opticsFor(const Volume& volume, const std::filesystem::path& input,
                        const PictureOptions& picture, const Listener& listener,
                        const FrameLook& look);

/// A scene, ready to be made into a picture.
struct ReadScene {
    RenderOptions options;
    std::shared_ptr<const Volume> volume;
};

/// Reads all of what a picture is made of: readOptics and readToRender.
ReadScene readScene(const std::filesystem::path& input, const PictureOptions& picture,
                    const Listener& listener, const FrameLook* look = nullptr);

/// Returns what is up in the world: --up, else y or, of a patient, the head.
glm::dvec3 upOf(const PictureOptions& picture, const Volume& volume);

}  // namespace deltasplat
