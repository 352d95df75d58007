// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/slab_part.h"

#include <cstdio>
#include <string>
#include <vector>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "layered_views.h"
#include "listener_part.h"
#include "part_header.h"
#include "scene_digest.h"
#include "slab_file.h"

namespace deltasplat {
namespace {

PictureLayout layoutOf(const LayeredPicture::Impl& picture) {
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

// What the slabs of a picture show, as PartHeader has it.
std::string contentOf(const LayeredPicture::Impl& picture) {
    std::string text;
    for (const auto& view : picture.views) {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", (unsigned long long)digestOf(*view));
        text += digits;
    }
    return text;
}

// About how long a slab takes: what is stamped, and slices that are read.
double workOf(const LayeredPicture::Impl& picture, const LayeredPicture::Impl::Place& place) {
    constexpr double kWordsOfSlice = 16;
    const SlabInput& input = picture.inputOf(place);
    const SeenSlab& seen = picture.seenOf(place);
    double words = 0;
    for (int slice = seen.firstSlice; slice <= seen.lastSlice; ++slice)
        words += double(input.splat.deltas.slice(slice).size());
    return words + kWordsOfSlice * (seen.lastSlice - seen.firstSlice + 1);
}

// Cuts the slabs of a picture where their work passes each share of all.
class SlabShares {
  public:
    explicit SlabShares(const LayeredPicture::Impl& picture) {
        for (const auto& place : picture.slabs) {
            work_.push_back(workOf(picture, place));
            all_ += work_.back();
        }
    }

    // The slab that the parts up to one of so many end before.
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
    throw Error(ErrorCode::kUsage,
                gotExpected("`share`", shareText(share), "some of at most 10000, counted from 1"));
}

}  // namespace

void writeSlabPart(const LayeredPicture& picture, const SlabShare& share, const PartNotes& notes,
                   const std::filesystem::path& file, const Listener& listener) {
    const DefaultFloats floats;
    check(share);
    const LayeredPicture::Impl& all = picture.impl();
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

}  // namespace deltasplat
