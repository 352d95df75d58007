// SPDX-License-Identifier: Apache-2.0
#include "render/sequence_window.h"

#include <glm/common.hpp>
#include <mutex>
#include <optional>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "render/render_input.h"
#include "render/value_window.h"
#include "sequence/run_frames.h"

namespace deltasplat {
namespace {

// Of a frame's picture; empty if it shows no values.
std::optional<glm::dvec2> middleOf(const RenderCommand& command, const FrameLook& look,
                                   const Listener& listener) {
    const ReadScene scene = readScene(command.input, command.picture, listener, &look);
    RenderResult result = render(*scene.volume, scene.options, listener);
    readyForGreys(scene.options, *scene.volume, result.camera, result.image);
    return middleValues(scene.options.mode, result.image);
}

}  // namespace

glm::dvec2 sequenceWindow(const std::vector<FrameFiles>& frames,
                          const std::function<RenderCommand(std::size_t i)>& commandOf,
                          SequenceLook& look, int workers, const Listener& listener) {
    std::mutex mutex;
    std::optional<glm::dvec2> all;
    const auto add = [&](std::size_t i, const Listener& part) {
        if (frames[i].input.empty()) return;  // a black one
        Listener silent;
        silent.progress = part.progress;
        std::optional<glm::dvec2> one;
        try {
            one = middleOf(commandOf(i), {look, i}, silent);
        } catch (const Error& error) {
            if (error.code() == ErrorCode::kInterrupted) throw;
        }
        if (!one) return;
        const std::lock_guard lock(mutex);
        all = all ? glm::dvec2(glm::min(all->x, one->x), glm::max(all->y, one->y)) : *one;
    };
    runFrames(frames, true, workers, add, listener);
    return defaultWindow(commandOf(0).picture.render.mode, all);
}

}  // namespace deltasplat
