// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "render/render_options.h"

namespace deltasplat {

/// Declares the options that say which channels are wanted beside a picture's own.
void addAovOptions(CLI::App& app, RenderCommand& command);

/// Refuses channels where there can be none.
/// @throw Error(kUsage)
void checkAovs(const RenderCommand& command);

/// Warns of options that were given and change nothing.
void warnOfUnusedAovOptions(const CLI::App& app, const RenderCommand& command,
                            ProgressDisplay& display);

/// Adds the mattes of layers of which nothing is active, which are no part of the medium: a
/// sequence has the same channels in each of its pictures.
std::vector<ImageChannel> withEmptyMattes(const MediumChoice& medium, const Optics& optics,
                                          std::vector<ImageChannel> channels);

/// Says that depths are by what hides something, and fire hides nothing.
void warnOfDepths(const ChannelChoice& channels, const Optics& optics, const Listener& listener);

}  // namespace deltasplat
