// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/slab_part.h"

#include <algorithm>
#include <cstdio>

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
        if (!picture.scene.options().tolerance.isExact()) of.bound = view.errorBound();
        for (int slab = 0; slab < int(picture.seen[i].size()); ++slab)
            of.slabs.push_back(picture.reachOf({i, slab}));
    }
    return layout;
}

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
    const SlabInput& input = picture.inputOf(place);
    const SeenSlab& seen = picture.seenOf(place);
    double words = 0;
    for (int slice = seen.firstSlice; slice <= seen.lastSlice; ++slice)
        words += double(input.splat.deltas.slice(slice).size());
    constexpr double kWordsOfSlice = 16;
    return words + kWordsOfSlice * (seen.lastSlice - seen.firstSlice + 1);
}

// The slab that a share ends before: slabs are cut where their work passes it.
int endOf(const std::vector<double>& works, int share, int count) {
    double all = 0;
    for (const double work : works) all += work;
    double before = 0;
    for (std::size_t slab = 0; slab < works.size(); ++slab) {
        if (before + 0.5 * works[slab] >= all * share / count) return int(slab);
        before += works[slab];
    }
    return int(works.size());
}

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
    std::vector<double> works;
    for (const LayeredPicture::Impl::Place& place : all.slabs) works.push_back(workOf(all, place));
    const SplatOptions& options = all.scene.options();
    const PartHeader header{share,
                            endOf(works, share.first - 1, share.count),
                            endOf(works, share.last, share.count),
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
