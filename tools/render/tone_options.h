// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/image/image.h"
#include "listener.h"
#include "options/command_line.h"
#include "render/render_options.h"

namespace deltasplat {

/// Whether no pixel lets through what lies behind.
bool isOpaque(const Image& image);

/// Declares --exposure and --tone.
void addToneOptions(CLI::App& app, ToneChoice& choice);

/// Warns of --exposure and --tone where they change nothing: an .exr holds light as it is, and
/// modes other than composite show values.
void warnOfUnusedTone(const CLI::App& app, const RenderCommand& command, ProgressDisplay& display);

/// Warns of pixels that are brighter than what the halves of an .exr hold.
void warnOfHalves(const RenderCommand& command, std::size_t pixels, const Listener& listener);

/// Turns a picture of light, background included, into what a file of 8 or 16 bits shows of it, and
/// says so in `file`; leaves all other pictures alone. Warns if a noticeable share of it is
/// clipped.
void applyTone(const RenderCommand& command, Image& image, ImageFileOptions& file,
               const Listener& listener);

}  // namespace deltasplat
