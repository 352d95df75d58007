// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/frame_chain.h"

#include <map>
#include <mutex>
#include <utility>

#include "deltasplat/error.h"
#include "kept_frame.h"
#include "render_frame.h"

namespace deltasplat {

struct FrameChain::Impl {
    explicit Impl(std::size_t frameCount) : frames(frameCount) {}

    // Returns a frame, which is asked for by itself and by the one behind it.
    std::shared_ptr<KeptFrame> take(std::size_t number) {
        const std::lock_guard lock(mutex);
        const auto found = taken.find(number);
        if (found == taken.end()) {
            auto frame = std::make_shared<KeptFrame>();
            if (number + 1 < frames) taken.emplace(number, frame);
            return frame;
        }
        std::shared_ptr<KeptFrame> frame = std::move(found->second);
        taken.erase(found);
        return frame;
    }

    const std::size_t frames;
    std::mutex mutex;
    std::map<std::size_t, std::shared_ptr<KeptFrame>> taken;  // by one of the two
};

struct FrameChain::Frame::Impl {
    std::shared_ptr<KeptFrame> before;  // null: there is none
    std::shared_ptr<KeptFrame> now;
};

FrameChain::FrameChain(std::size_t frames) : impl_(std::make_unique<Impl>(frames)) {}
FrameChain::~FrameChain() = default;

FrameChain::Frame FrameChain::begin(std::size_t number) {
    auto frame = std::make_unique<Frame::Impl>();
    if (number > 0) frame->before = impl_->take(number - 1);
    frame->now = impl_->take(number);
    return Frame(std::move(frame));
}

FrameChain::Frame::Frame(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameChain::Frame::Frame(Frame&&) noexcept = default;

FrameChain::Frame::~Frame() {
    if (impl_) impl_->now->end();
}

RenderResult FrameChain::Frame::render(const Volume& volume, const RenderOptions& options,
                                       const Listener& listener) {
    if (options.mode != Mode::kComposite) {
        throw Error(ErrorCode::kUsage, gotExpected("mode of a frame after another",
                                                   modeName(options.mode), "composite"));
    }
    const FrameStep step{std::move(impl_->before), *impl_->now, std::make_shared<KeptMemory>()};
    RenderResult result = renderFrame(volume, options, listener, &step);
    impl_->now->end();
    return result;
}

}  // namespace deltasplat
