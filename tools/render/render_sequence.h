// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "deltasplat/prepared_scene.h"
#include "render/render_options.h"
#include "render/sequence_sinks.h"
#include "sequence/sequence_look.h"

namespace deltasplat {

/// What a picture of a sequence takes from the sequence; of a single one all is empty.
struct SequencePart {
    const FrameLook* look = nullptr;
    /// What is seen, made ready once for all frames, in place of what would be read.
    const PreparedScene* prepared = nullptr;
    /// Takes the finished picture, linear.
    std::function<void(const Image& image)> take;
    bool isWritten = true;  ///< whether it has a file of its own
    std::optional<int> frame = {};
    bool endsProgram = false;  ///< whether nothing comes after it: what it is of need not be freed
};

/// Makes and writes one picture; an input that is empty is that of a black one.
using MakePicture = std::function<void(const RenderCommand& command, const SequencePart& part,
                                       const Listener& listener)>;

/// Declares the options of sequences that only `render` has, and those that all have.
void addSequenceOptions(CLI::App& app, RenderCommand& command);

/// Gives a turntable its frames, and refuses what frames cannot be made of.
/// @throw Error(kUsage)
void applySequence(const CLI::App& app, RenderCommand& command);

/// Makes the pictures of all frames, several at once, shown alike: by the values of all.
/// @throw as runFrames; Error(kInput) for a --first-pass file of something else
void renderSequence(const RenderCommand& command, SequenceSinks& sinks, const Listener& listener,
                    const MakePicture& makePicture);

}  // namespace deltasplat
