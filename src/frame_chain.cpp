// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/frame_chain.h"

#include <map>
#include <mutex>

#include "deltasplat/error.h"
#include "kept_frame.h"
#include "render_frame.h"

namespace deltasplat {

struct FrameChain::Impl {
    struct Link {
        std::shared_ptr<KeptFrame> frame = std::make_shared<KeptFrame>();
        bool hasEnded = false;
    };

    std::shared_ptr<KeptFrame> frame(std::size_t number) {
        const std::lock_guard lock(mutex);
        return links[number].frame;
    }
    // Lets go of a frame that nobody will ask for any more.
    void release(std::size_t number) {
        if (links[number].hasEnded && links[number + 1].hasEnded) links[number].frame.reset();
    }

    std::mutex mutex;  // guards all below
    std::map<std::size_t, Link> links;
};

FrameChain::FrameChain() : impl_(std::make_unique<Impl>()) {}
FrameChain::~FrameChain() = default;

RenderResult FrameChain::render(std::size_t number, const Volume& volume,
                                const RenderOptions& options, const Listener& listener) {
    if (options.mode != Mode::kComposite) {
        throw Error(ErrorCode::kUsage, gotExpected("mode of a frame after another",
                                                   modeName(options.mode), "composite"));
    }
    const std::shared_ptr<KeptFrame> now = impl_->frame(number);
    const std::shared_ptr<KeptFrame> before = number > 0 ? impl_->frame(number - 1) : nullptr;
    const FrameStep step{before.get(), *now};
    return renderFrame(volume, options, listener, &step);
}

void FrameChain::end(std::size_t number) {
    impl_->frame(number)->end();
    const std::lock_guard lock(impl_->mutex);
    impl_->links[number].hasEnded = true;
    impl_->release(number);
    if (number > 0) impl_->release(number - 1);
}

}  // namespace deltasplat
