// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/default_floats.h"
#include "base/memory.h"
#include "deltasplat/error.h"
#include "deltasplat/slab_part.h"
#include "picture/parts/part_header.h"
#include "picture/parts/slab_file.h"
#include "picture/plane_view.h"
#include "screen/clear_image.h"

namespace deltasplat {
namespace {

// A part that is open, at its layers.
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
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
}

// @return parts in the order of their shares
std::vector<OpenPart> openAll(std::span<const std::filesystem::path> paths) {
    if (paths.empty())
        throw Error(ErrorCode::kUsage,
                    gotExpected("parts of a picture", "none", "all of a picture"));
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

// Every share has to be there once.
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

struct FoldedPicture::Impl {
    struct View {
        PlaneView plane;
        ErrorBound bound;
        Layer layer;
    };

    explicit Impl(std::vector<OpenPart> all) : parts(std::move(all)) {
        const PartHeader& header = parts.front().header;
        stats.method = header.method;
        stats.tolerance = header.tolerance;
        stats.slabs = header.layout.slabs();
    }

    const PartHeader& first() const { return parts.front().header; }
    const PictureLayout& layout() const { return first().layout; }

    void fold(const Listener& listener) {
        double bytes = 0;
        for (const ViewLayout& view : layout().views)
            bytes += layerBytes(view.reach, view.channels);
        requireClaimedMemory(parts.front().path.string() + ": layers of a picture", bytes);
        auto part = parts.begin();
        int slab = 0;
        for (const ViewLayout& view : layout().views) {
            Layer merged(view.reach, view.channels);
            for (const PlaneBox& box : view.slabs) {
                while (slab == part->header.lastSlab) (part++)->file.finish();
                part->file.mergeNext(box, merged);
                listener.report(double(++slab) / stats.slabs);
            }
            views.push_back(
                {PlaneView(layout().camera, view.place), view.bound, std::move(merged)});
            views.back().plane.finish(views.back().layer);
        }
        for (; part != parts.end(); ++part) part->file.finish();
    }

    std::vector<OpenPart> parts;
    RenderStats stats;
    std::vector<View> views;
};

FoldedPicture::FoldedPicture(std::span<const std::filesystem::path> parts) {
    std::vector<OpenPart> all = openAll(parts);
    requireAll(all);
    impl_ = std::make_unique<Impl>(std::move(all));
}
FoldedPicture::~FoldedPicture() = default;
FoldedPicture::FoldedPicture(FoldedPicture&&) noexcept = default;
FoldedPicture& FoldedPicture::operator=(FoldedPicture&&) noexcept = default;

const Camera& FoldedPicture::camera() const {
    return impl_->layout().camera;
}

const PartNotes& FoldedPicture::notes() const {
    return impl_->first().notes;
}

const RenderStats& FoldedPicture::stats() const {
    return impl_->stats;
}

void FoldedPicture::fold(const Listener& listener) {
    const DefaultFloats floats;
    impl_->fold(listener);
}

void FoldedPicture::show(const PixelBox& part, Image& image) {
    const DefaultFloats floats;
    const glm::ivec2 size = camera().sizePixels;
    requirePart(part, size, image);
    clearImage(image);
    RenderStats& stats = impl_->stats;
    for (const Impl::View& view : impl_->views) {
        const bool isFirst = &view == &impl_->views.front();
        Image behind;
        if (!isFirst) behind = clearImage(part.size());
        Image& shown = isFirst ? image : behind;
        const double gain = view.plane.showPart(view.layer, PicturePart(shown, part.min, size));
        if (!isFirst) putBehind(image, {0, 0}, behind);
        stats.errorBoundColor = std::max(stats.errorBoundColor, view.bound.color * gain);
        stats.errorBoundAlpha = std::max(stats.errorBoundAlpha, view.bound.alpha * gain);
    }
}

}  // namespace deltasplat
