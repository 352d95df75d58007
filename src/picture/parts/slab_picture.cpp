// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/slab_picture.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/error.h"
#include "deltasplat/slabs.h"
#include "picture/parts/layout_json.h"
#include "picture/parts/picture.h"
#include "picture/parts/slab_file.h"
#include "picture/picture_view.h"

namespace deltasplat {

namespace {

/// Returns a hash of a view's voxels and colours, not lights. Deterministic; multi-threaded.
std::uint64_t digestOf(const PictureView& view);

// Hashes 64-bit words with MurmurHash3's finalizer (Austin Appleby, public domain).
class Digest {
  public:
    void add(std::uint64_t word) {
        state_ = (state_ ^ word) * 0xff51afd7ed558ccdULL;
        state_ ^= state_ >> 32;
    }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0xc4ceb9fe1a85ec53ULL;
};

void addColors(const ClassTable::Digit& digit, Digest& digest) {
    for (const ClassTable::Color& color : digit.colors)
        digest.add(std::bit_cast<std::uint64_t>(color));
}

std::uint64_t digestOfSlice(const PackedDeltas& deltas, std::size_t slice) {
    Digest digest;
    for (std::size_t i = deltas.begins[slice]; i < deltas.begins[slice + 1]; ++i) {
        const DeltaWord& word = deltas.words[i];
        digest.add(word.visible);
        digest.add(word.changed);
        digest.add(std::uint64_t(std::uint32_t(word.block.x)) << 32 | std::uint32_t(word.block.y));
        for (int voxel = 0; voxel < 64; voxel += 4) {
            std::uint64_t classes = 0;
            for (int next = voxel; next < voxel + 4; ++next)
                classes = classes << 16 | word.classes[next];
            digest.add(classes);
        }
        if (deltas.looks.empty()) continue;
        for (int voxel = 0; voxel < 64; ++voxel)
            digest.add(std::bit_cast<std::uint64_t>(deltas.looks[i][voxel]));
    }
    return digest.value();
}

std::uint64_t digestOf(const PictureView& view) {
    const PackedDeltas& deltas = view.axis().deltas();
    const std::size_t slices = deltas.begins.empty() ? 0 : deltas.begins.size() - 1;
    std::vector<std::uint64_t> ofSlices(slices);
    parallelFor(slices, [&](std::size_t i) { ofSlices[i] = digestOfSlice(deltas, i); });
    Digest digest;
    for (const std::uint64_t slice : ofSlices) digest.add(slice);
    const ClassTable& table = view.slabs().splat.colors.classes();
    for (const ClassTable::Plane& plane : table.planes) {
        addColors(plane.high, digest);
        addColors(plane.low, digest);
    }
    for (int channel = 0; channel < 4; ++channel) digest.add(table.scale[channel]);
    for (const std::int32_t weight : view.plan().footprint.weights)
        digest.add(std::uint64_t(weight));
    return digest.value();
}

PictureLayout layoutOf(const SlabPicture::Impl& picture) {
    PictureLayout layout{picture.camera, {}};
    for (std::size_t i = 0; i < picture.views.size(); ++i) {
        const PictureView& view = *picture.views[i];
        const SlabInput& input = view.slabs();
        ViewLayout& of = layout.views.emplace_back();
        of.place = view.plane().place();
        of.channels = input.layout.channels;
        of.reach = reachOfAll(input, picture.seen[i]);
        if (of.reach.empty()) of.reach = {};
        of.bound = view.errorBound();
        for (int slab = 0; slab < int(picture.seen[i].size()); ++slab)
            of.slabs.push_back(picture.reachOf({i, slab}));
    }
    return layout;
}

// Returns PartHeader::content.
std::string contentOf(const SlabPicture::Impl& picture) {
    std::string text;
    for (const auto& view : picture.views) {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", (unsigned long long)digestOf(*view));
        text += digits;
    }
    return text;
}

// Estimated work for a slab: stamps, and slices that are read.
double workOf(const SlabPicture::Impl& picture, const SlabPicture::Impl::Place& place) {
    constexpr double kWordsOfSlice = 16;
    const SlabInput& input = picture.inputOf(place);
    const SeenSlab& seen = picture.seenOf(place);
    double words = 0;
    for (int slice = seen.firstSlice; slice <= seen.lastSlice; ++slice)
        words += double(input.splat.deltas.slice(slice).size());
    return words + kWordsOfSlice * (seen.lastSlice - seen.firstSlice + 1);
}

// Cuts the slabs of a picture into shares of equal work.
class SlabShares {
  public:
    explicit SlabShares(const SlabPicture::Impl& picture) {
        for (const auto& place : picture.slabs) {
            work_.push_back(workOf(picture, place));
            all_ += work_.back();
        }
    }

    // Returns the end of the slabs of the first `share` parts of `count`.
    int endOf(int share, int count) const {
        double before = 0;
        for (std::size_t slab = 0; slab < work_.size(); ++slab) {
            if (before + 0.5 * work_[slab] >= all_ * share / count) return int(slab);
            before += work_[slab];
        }
        return int(work_.size());
    }

  private:
    std::vector<double> work_;
    double all_ = 0;
};

void check(const SlabShare& share) {
    if (share.first >= 1 && share.first <= share.last && share.last <= share.count &&
        share.count <= kMostSlabShares)
        return;
    throw Error(ErrorCode::kUsage, "`share`", shareText(share),
                "some of at most 10000, counted from 1");
}

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "layers of a picture", got, expected);
}

std::string boxText(const glm::ivec2& min, const glm::ivec2& max) {
    const glm::i64vec2 size = glm::i64vec2(max) - glm::i64vec2(min);
    return std::to_string(size.x) + "x" + std::to_string(size.y) + " at " + std::to_string(min.x) +
           "," + std::to_string(min.y);
}

// Layers are not trusted.
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

// Returns the layers in the order of slabs.
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
    // Not known yet.
    bool isAnyBeyond(float) const override { return true; }

  private:
    SlabPicture::Impl& picture_;
};

}  // namespace

void writeSlabs(const SlabPicture& picture, const SlabShare& share, const PartNotes& notes,
                const std::filesystem::path& file, const Listener& listener) {
    const DefaultFloats floats;
    check(share);
    const SlabPicture::Impl& all = picture.impl();
    const SlabShares shares(all);
    const SplatOptions& options = all.scene.options();
    const PartHeader header{share,
                            shares.endOf(share.first - 1, share.count),
                            shares.endOf(share.last, share.count),
                            notes,
                            options.method,
                            options.tolerance,
                            contentOf(all),
                            layoutOf(all)};
    SlabFileWriter writer(file, headerText(header));
    const double slabs = header.lastSlab - header.firstSlab;
    for (int slab = header.firstSlab; slab < header.lastSlab; ++slab) {
        const double done = slab - header.firstSlab;
        writer.write(all.render(slab, partOf(listener, done / slabs, (done + 1) / slabs)));
    }
    listener.report(1);
    writer.finish();
}

SlabPicture::Impl::Impl(const PreparedScene& ofScene, const Camera& ofCamera,
                        const Listener& listener)
    : scene(ofScene), camera(ofCamera) {
    const PreparedScene::Impl& prepared = scene.impl();
    // Numbers of looks of more than two slices differ between processes.
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
