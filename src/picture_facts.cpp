// SPDX-License-Identifier: Apache-2.0
#include "picture_facts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "ingest/codes/code_tree.h"
#include "ingest/codes/slot_blocks.h"
#include "scene_digest.h"

namespace deltasplat {
namespace {

using Picture = LayeredPicture::Impl;

// @param words  of each view
std::string contentOf(const Picture& picture, const std::vector<std::uint64_t>& words) {
    std::string text;
    for (std::size_t view = 0; view < picture.views.size(); ++view) {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx",
                      (unsigned long long)digestOf(*picture.views[view], words[view]));
        text += digits;
    }
    return text;
}

// About how long a slab takes: what is stamped, and slices that are read.
double workOf(const Picture& picture, const Picture::Place& place) {
    const SlabInput& input = picture.inputOf(place);
    const SeenSlab& seen = picture.seenOf(place);
    double words = 0;
    for (int slice = seen.firstSlice; slice <= seen.lastSlice; ++slice)
        words += double(input.splat.deltas.slice(slice).size());
    constexpr double kWordsOfSlice = 16;
    return words + kWordsOfSlice * (seen.lastSlice - seen.firstSlice + 1);
}

// The blocks of slices that a slab is made of: its own, and one on either side where values are
// mixed.
glm::ivec2 blocksOf(const Picture& picture, const Picture::Place& place) {
    const Subdivision& parts = picture.views[place.view]->axis().parts;
    const PlannedSlab& slab = *picture.seenOf(place).slab;
    const glm::ivec2 slices(slab.firstSlice, slab.firstSlice + slab.sliceCount - 1);
    if (parts.joined > 1)
        return glm::ivec2(parts.joined * slices.x, parts.joined * (slices.y + 1) - 1) >> 3;
    if (!parts.divides()) return slices >> 3;
    const glm::ivec2 blocks = (slices / parts.slices + parts.origin.x) >> 3;
    return {blocks.x - 1, blocks.y + 1};
}

}  // namespace

const SlabFacts* knownFacts(const Picture& picture) {
    if (picture.views.empty()) return nullptr;
    const CodeTree& codes = *picture.scene.impl().scene.volume->codes;
    const SlotBlocks* const blocks = codes.blocksAlong(picture.views.front()->axis().sliceAxis);
    return blocks ? blocks->facts() : nullptr;
}

SlabFacts factsOf(const Picture& picture) {
    if (const SlabFacts* known = knownFacts(picture)) {
        const bool isSame =
            std::equal(picture.slabs.begin(), picture.slabs.end(), known->seen.begin(),
                       known->seen.end(), [&](const auto& place, const SlabFacts::Seen& seen) {
                           return seen.blocks == blocksOf(picture, place);
                       });
        if (isSame && contentOf(picture, {known->words}) == known->content) return *known;
        throw Error(ErrorCode::kInput,
                    gotExpected(known->file, "facts of other colours", "those of this picture"));
    }
    SlabFacts facts;
    std::vector<std::uint64_t> words;
    for (const auto& view : picture.views) words.push_back(digestOfWords(*view));
    facts.content = contentOf(picture, words);
    if (!words.empty()) facts.words = words.front();
    for (const Picture::Place& place : picture.slabs)
        facts.seen.push_back({workOf(picture, place), blocksOf(picture, place)});
    if (picture.views.empty()) return facts;
    const PackedDeltas& deltas = picture.views.front()->axis().deltas();
    facts.slabs = deltas.slabs;
    facts.joined = picture.views.front()->axis().parts.joined;
    const SlabPlanner planner(deltas.box);
    facts.blocksPerSlab = planner.shortest().blocks();
    if (deltas.slabs.size() > 1)
        facts.blocksPerSlab = (deltas.slabs[1].firstSlice >> 3) - (deltas.box.min.x >> 3);
    return facts;
}

bool isReadByParts(const Picture& picture) {
    const PreparedScene::Impl& scene = picture.scene.impl();
    if (picture.views.size() != 1 || scene.far || scene.painter ||
        !scene.options.tolerance.isExact())
        return false;
    const PictureView& view = *picture.views.front();
    return view.slabs().plane.isParallel() && scene.scene.volume->origin &&
           scene.scene.volume->codes->blocksAlong(view.axis().sliceAxis) != nullptr;
}

}  // namespace deltasplat
