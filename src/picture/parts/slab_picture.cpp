// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/slab_picture.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/default_floats.h"
#include "base/memory.h"
#include "deltasplat/error.h"
#include "picture/parts/picture.h"

namespace deltasplat {

namespace {

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "layers of a picture", got, expected);
}

std::string boxText(const glm::ivec2& min, const glm::ivec2& max) {
    const glm::i64vec2 size = glm::i64vec2(max) - glm::i64vec2(min);
    return std::to_string(size.x) + "x" + std::to_string(size.y) + " at " + std::to_string(min.x) +
           "," + std::to_string(min.y);
}

// A layer may have come from anywhere.
void requireFits(const SlabLayer& layer, const PlaneBox& box, int channels) {
    if (layer.min != box.min || layer.max != box.max || layer.channels != channels) {
        refuse("one of " + boxText(layer.min, layer.max) + ", channels " +
                   std::to_string(layer.channels),
               boxText(box.min, box.max) + ", channels " + std::to_string(channels) + " for slab " +
                   std::to_string(layer.slab));
    }
    const glm::ivec2 size = box.size();
    const auto isInside = [&](const glm::ivec2& span) {
        return span.x >= span.y || (span.x >= 0 && span.y <= size.x);
    };
    if (layer.values.size() != std::size_t(channels) * std::size_t(size.x) * std::size_t(size.y) ||
        layer.spans.size() != std::size_t(size.y) ||
        !std::all_of(layer.spans.begin(), layer.spans.end(), isInside)) {
        refuse("values or spans of another size than the layer's of slab " +
                   std::to_string(layer.slab),
               "those that were rendered");
    }
}

// All layers by their slabs.
std::vector<const SlabLayer*> ordered(const SlabPicture::Impl& picture,
                                      std::span<const SlabLayer> layers) {
    std::vector<const SlabLayer*> bySlab(picture.slabs.size());
    for (const SlabLayer& layer : layers) {
        picture.placeOf(layer.slab);
        const SlabLayer*& known = bySlab[std::size_t(layer.slab)];
        if (known) refuse("slab " + std::to_string(layer.slab) + " twice", "each once");
        known = &layer;
    }
    const auto missing = std::find(bySlab.begin(), bySlab.end(), nullptr);
    if (missing != bySlab.end()) {
        refuse("none for slab " + std::to_string(missing - bySlab.begin()),
               "one for each of " + std::to_string(bySlab.size()) + " slabs");
    }
    return bySlab;
}

// Keeps the views of a picture, and counts their slabs.
class SlabSink : public ViewSink {
  public:
    explicit SlabSink(SlabPicture::Impl& picture) : picture_(picture) {}

    DrawnFor drawnFor() const override { return DrawnFor::kSlabs; }
    void beginGroup(std::shared_ptr<const PreparedScene::Impl> group, const PixelBox&) override {
        picture_.groups.push_back(std::move(group));
    }
    void endGroup() override {}
    void take(const PlannedView& planned, RenderStats&, const Listener&) override {
        picture_.views.push_back(planned.view(planned.axis));
        picture_.seen.push_back(seenSlabs(picture_.views.back()->slabs()));
        for (int slab = 0; slab < int(picture_.seen.back().size()); ++slab)
            picture_.slabs.push_back({picture_.views.size() - 1, slab});
    }
    // Nobody knows yet.
    bool isAnyBeyond(float) const override { return true; }

  private:
    SlabPicture::Impl& picture_;
};

}  // namespace

SlabPicture::Impl::Impl(const PreparedScene& ofScene, const Camera& ofCamera,
                        const Listener& listener)
    : scene(ofScene), camera(ofCamera) {
    const PreparedScene::Impl& prepared = scene.impl();
    // Looks of more slices have numbers that are others in each process.
    if (prepared.options.mostJoined > 2) {
        throw Error(ErrorCode::kUsage, "`mostJoined`",
                    std::to_string(prepared.options.mostJoined) + " for slabs", "1 or 2");
    }
    SlabSink sink(*this);
    renderViews(prepared, camera, memory, sink, listener);
}

const SlabPicture::Impl::Place& SlabPicture::Impl::placeOf(int slab) const {
    if (slab < 0 || slab >= int(slabs.size())) {
        refuse("slab " + std::to_string(slab),
               "one of " + std::to_string(slabs.size()) + ", counted from 0");
    }
    return slabs[std::size_t(slab)];
}

PlaneBox SlabPicture::Impl::reachOf(const Place& place) const {
    const PlaneBox reach = reachOfSeen(inputOf(place), seenOf(place));
    return reach.empty() ? PlaneBox{} : reach;
}

Layer SlabPicture::Impl::render(int slab, const Listener& listener) const {
    const Place& place = placeOf(slab);
    const SlabInput& input = inputOf(place);
    requireMemory("layer of a slab", layerBytes(reachOf(place), input.layout.channels));
    SlabRenderer renderer(input, {seenOf(place)}, listener);
    renderer.run();
    return renderer.merge();
}

SlabPicture::SlabPicture(const PreparedScene& scene, const Camera& camera,
                         const Listener& listener) {
    const DefaultFloats floats;
    impl_ = std::make_unique<const Impl>(scene, camera, listener);
}
SlabPicture::~SlabPicture() = default;
SlabPicture::SlabPicture(SlabPicture&&) noexcept = default;
SlabPicture& SlabPicture::operator=(SlabPicture&&) noexcept = default;

int SlabPicture::slabs() const {
    return int(impl_->slabs.size());
}

SlabLayer SlabPicture::render(int slab, const Listener& listener) const {
    const DefaultFloats floats;
    const Layer layer = impl_->render(slab, listener);
    SlabLayer result{slab, layer.box.min, layer.box.max, layer.channels, {}, layer.spans};
    result.values.assign(layer.values.begin(), layer.values.end());
    return result;
}

Picture SlabPicture::fold(std::span<const SlabLayer> layers) const {
    const DefaultFloats floats;
    const Impl& picture = *impl_;
    const std::vector<const SlabLayer*> all = ordered(picture, layers);
    for (std::size_t slab = 0; slab < all.size(); ++slab) {
        const Impl::Place& place = picture.slabs[slab];
        requireFits(*all[slab], picture.reachOf(place), picture.inputOf(place).layout.channels);
    }
    auto folded = std::make_unique<Picture::Impl>(picture.camera);
    folded->stats.method = picture.scene.options().method;
    folded->stats.tolerance = picture.scene.options().tolerance;
    folded->stats.slabs = int(picture.slabs.size());
    std::size_t next = 0;
    for (std::size_t number = 0; number < picture.views.size(); ++number) {
        const PictureView& view = *picture.views[number];
        const SlabInput& input = view.slabs();
        const PlaneBox reach = reachOfAll(input, picture.seen[number]);
        requireMemory("layers of a picture", layerBytes(reach, input.layout.channels));
        Layer merged(reach, input.layout.channels, folded->memory);
        for (; next < all.size() && picture.slabs[next].view == number; ++next) {
            const SlabLayer& layer = *all[next];
            for (int y = layer.min.y; y < layer.max.y; ++y) {
                const auto row = std::size_t(y - layer.min.y);
                const auto width = std::size_t(layer.max.x - layer.min.x);
                mergeRowBehind(merged,
                               {layer.values.data() + row * width * std::size_t(layer.channels),
                                layer.min.x, layer.spans[row]},
                               y);
            }
        }
        folded->addBehind(view.plane(), view.errorBound(), std::move(merged));
    }
    return Picture(std::move(folded));
}

}  // namespace deltasplat
