// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "render/render_batch.h"
#include "render/render_input.h"
#include "render/render_options.h"
#include "render/render_sequence.h"
#include "render/render_stats.h"

namespace deltasplat {

/// The share of the progress that reading takes, measured on the engine data set.
inline constexpr double kReadShare = 0.3;

/// A picture and what there is to say of it.
struct MadePicture {
    RenderResult result;
    RenderTimes times;
    DeepStats deep;
    std::string codeBook;
    PictureFacts facts;
};

/// Reads the scene, unless it is there already.
/// @throw as readScene
ReadScene sceneOf(const RenderCommand& command, const SequencePart& part, const Listener& listener);

/// Reads, renders and writes one picture, and its stats.
MadePicture makePicture(const CLI::App& app, const RenderCommand& command, const Session& session,
                        const SequencePart& part, const Listener& listener);

/// Writes what stands for a frame that there is none of.
void makeBlack(const RenderCommand& command, const Session& session, const SequencePart& part);

}  // namespace deltasplat
