// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/render_input.h"
#include "render/render_options.h"

namespace deltasplat {

/// Declares --slab-range.
void addSlabOption(CLI::App& app, std::optional<SlabShare>& slabs);

/// @throw Error(kUsage) for options that --slab-range has no use for
void applySlabs(const CLI::App& app, const RenderCommand& command);

/// Renders and writes the share of a picture's slabs that was asked for.
void writeSlabs(const CLI::App& app, const RenderCommand& command, const ReadScene& scene,
                const Session& session, const Listener& listener);

}  // namespace deltasplat
