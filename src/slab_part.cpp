// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/slab_part.h"

#include "default_floats.h"
#include "deltasplat/error.h"
#include "layered_views.h"
#include "listener_part.h"
#include "part_header.h"
#include "picture_facts.h"
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
    const SlabFacts facts = factsOf(all);
    const SplatOptions& options = all.scene.options();
    const PartHeader header{share,
                            facts.endOf(share.first - 1, share.count),
                            facts.endOf(share.last, share.count),
                            notes,
                            options.method,
                            options.tolerance,
                            facts.content,
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
