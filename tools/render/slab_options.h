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

/// Returns what reads a volume for the share of a picture's slabs that was asked for: no more than
/// that, where --first-pass says how; empty without it.
VolumeReader slabReader(const CLI::App& app, const RenderCommand& command);

/// Renders and writes the share of a picture's slabs that was asked for, and --first-pass
/// if that is not there.
void writeSlabs(const CLI::App& app, const RenderCommand& command, const ReadScene& scene,
                const Session& session, const Listener& listener);

}  // namespace deltasplat
