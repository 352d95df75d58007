// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/picture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/error.h"
#include "deltasplat/slabs.h"
#include "picture/parts/layout_json.h"
#include "picture/parts/slab_file.h"
#include "picture/render_views.h"
#include "screen/clear_image.h"

namespace deltasplat {

namespace {

class KeepSink : public ViewSink {
  public:
    explicit KeepSink(Picture::Impl& picture) : picture_(picture) {}

    DrawnFor drawnFor() const override { return DrawnFor::kSlabs; }
    void beginGroup(std::shared_ptr<const PreparedScene::Impl>, const PixelBox& part) override {
        group_ = part;
    }
    void endGroup() override { group_.reset(); }
    void take(const PlannedView& planned, RenderStats& stats, const Listener& listener) override {
        const std::unique_ptr<const PictureView> view = planned.view(planned.axis);
        Layer merged =
            renderSlabs(view->slabs(), seenSlabs(view->slabs()), stats, partOf(listener, 0.2, 1));
        picture_.add(view->plane(), view->errorBound(), std::move(merged),
                     group_.value_or(picture_.whole()), group_.has_value());
    }
    bool isAnyBeyond(float least) const override {
        return std::any_of(picture_.views.begin(), picture_.views.end(), [&](const auto& view) {
            return deltasplat::isAnyBeyond(view.layer.values, least);
        });
    }

  private:
    Picture::Impl& picture_;
    std::optional<PixelBox> group_;
};

}  // namespace

Picture::Picture(const PreparedScene& scene, const Camera& camera, const Listener& listener)
    : impl_(std::make_unique<Impl>(camera)) {
    KeepSink sink(*impl_);
    impl_->stats = renderViews(scene.impl(), impl_->camera, impl_->memory, sink, listener);
}
Picture::Picture(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Picture::~Picture() = default;
Picture::Picture(Picture&&) noexcept = default;
Picture& Picture::operator=(Picture&&) noexcept = default;

const Camera& Picture::camera() const {
    return impl_->camera;
}

const RenderStats& Picture::stats() const {
    return impl_->stats;
}

void Picture::show(const PixelBox& part, Image& image) {
    const DefaultFloats floats;
    const glm::ivec2 size = impl_->camera.sizePixels;
    requirePart(part, size, image);
    const Clock::time_point start = Clock::now();
    clearImage(image);
    RenderStats& stats = impl_->stats;
    for (const Impl::View& view : impl_->views) {
        const PixelBox both{glm::max(part.min, view.part.min), glm::min(part.max, view.part.max)};
        if (both.empty()) continue;
        Image behind;
        if (view.coversOthers) behind = clearImage(both.size());
        Image& shown = view.coversOthers ? behind : image;
        const double gain = view.plane.showPart(view.layer, PicturePart(shown, both.min, size));
        if (view.coversOthers) putBehind(image, both.min - part.min, behind);
        addBound(view.bound, gain, stats);
    }
    const double seconds = secondsSince(start);
    stats.warpSeconds += seconds;
    stats.renderSeconds += seconds;
}

namespace {

// An open file of a part, positioned at its layers.
struct OpenPart {
    std::filesystem::path path;
    SlabFileReader file;
    PartHeader header;
};

OpenPart openPart(const std::filesystem::path& path) {
    SlabFileReader file(path);
    try {
        PartHeader header = headerOf(file.header());
        return {path, std::move(file), std::move(header)};
    } catch (const nlohmann::json::exception&) {
    } catch (const Error&) {
    }
    file.refuse("a header that says nothing", "a whole part of a picture's slabs");
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, file.string(), got, expected);
}

// @return the parts in the order of their shares
std::vector<OpenPart> openAll(std::span<const std::filesystem::path> paths) {
    if (paths.empty())
        throw Error(ErrorCode::kUsage, "parts of a picture", "none", "all of a picture");
    std::vector<OpenPart> parts;
    for (const std::filesystem::path& path : paths) {
        parts.push_back(openPart(path));
        const HeaderDifference other = differenceOf(parts.back().header, parts.front().header);
        if (!other.got.empty())
            refuse(path, other.got, other.expected + ", as in " + paths.front().string());
    }
    std::stable_sort(parts.begin(), parts.end(), [](const OpenPart& a, const OpenPart& b) {
        return a.header.share.first < b.header.share.first;
    });
    return parts;
}

// Every share must be there exactly once.
void requireAll(const std::vector<OpenPart>& parts) {
    const int count = parts.front().header.share.count;
    const auto refuseMissing = [&](int first, int last) {
        refuse("parts", "none with " + shareText({first, last, count}),
               "all " + std::to_string(count) + " of a picture");
    };
    int next = 1;
    int slab = 0;
    const OpenPart* before = nullptr;
    for (const OpenPart& part : parts) {
        const PartHeader& header = part.header;
        if (header.share.first > next) refuseMissing(next, header.share.first - 1);
        if (header.share.first < next) {
            refuse(part.path, "part " + shareText(header.share),
                   "each once, and " + before->path.string() + " is part " +
                       shareText(before->header.share));
        }
        if (header.firstSlab != slab)
            refuse(part.path, "slabs that do not follow others",
                   "those of part " + shareText(header.share));
        next = header.share.last + 1;
        slab = header.lastSlab;
        before = &part;
    }
    if (next <= count) refuseMissing(next, count);
    if (slab != parts.front().header.layout.slabs())
        refuse(before->path, "slabs that end too early", "the last ones of a picture");
}

}  // namespace

struct SlabFiles::Impl {
    explicit Impl(std::vector<OpenPart> all) : parts(std::move(all)) {}

    const PartHeader& first() const { return parts.front().header; }

    std::vector<OpenPart> parts;
};

SlabFiles::SlabFiles(std::span<const std::filesystem::path> parts) {
    std::vector<OpenPart> all = openAll(parts);
    requireAll(all);
    impl_ = std::make_unique<Impl>(std::move(all));
}
SlabFiles::~SlabFiles() = default;
SlabFiles::SlabFiles(SlabFiles&&) noexcept = default;
SlabFiles& SlabFiles::operator=(SlabFiles&&) noexcept = default;

const Camera& SlabFiles::camera() const {
    return impl_->first().layout.camera;
}

const PartNotes& SlabFiles::notes() const {
    return impl_->first().notes;
}

Picture SlabFiles::fold(const Listener& listener) {
    const DefaultFloats floats;
    std::vector<OpenPart>& parts = impl_->parts;
    const PartHeader& header = impl_->first();
    double bytes = 0;
    for (const ViewLayout& view : header.layout.views)
        bytes += layerBytes(view.reach, view.channels);
    requireClaimedMemory(parts.front().path.string() + ": layers of a picture", bytes);
    auto picture = std::make_unique<Picture::Impl>(header.layout.camera);
    picture->stats.method = header.method;
    picture->stats.tolerance = header.tolerance;
    picture->stats.slabs = header.layout.slabs();
    auto part = parts.begin();
    int slab = 0;
    for (const ViewLayout& view : header.layout.views) {
        Layer merged(view.reach, view.channels, picture->memory);
        for (const PlaneBox& box : view.slabs) {
            while (slab == part->header.lastSlab) (part++)->file.finish();
            part->file.mergeNext(box, merged);
            listener.report(double(++slab) / picture->stats.slabs);
        }
        picture->addBehind(PlaneView(header.layout.camera, view.place), view.bound,
                           std::move(merged));
    }
    for (; part != parts.end(); ++part) part->file.finish();
    return Picture(std::move(picture));
}

}  // namespace deltasplat
