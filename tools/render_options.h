// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec4.hpp>
#include <optional>

#include "command_line.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/render.h"

namespace deltasplat {

/// What `deltasplat render` was asked to do.
struct RenderCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path stats;             ///< empty: none
    std::filesystem::path transferFunction;  ///< empty: the grey ramp
    std::optional<glm::vec4> background;
    std::string projection = "ortho";
    std::string mode = "composite";
    ReadOptions read;
    RenderOptions render;
    ImageFileOptions image;
};

void addRenderOptions(CLI::App& app, RenderCommand& command);

/// Checks what can be checked before anything is read.
/// @throw Error(kUsage) or, for a folder that cannot be written to, Error(kOutput)
void validate(const RenderCommand& command);

}  // namespace deltasplat
