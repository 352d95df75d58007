// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/slab_part.h"

#include <bit>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "base/default_floats.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/error.h"
#include "deltasplat/slabs.h"
#include "picture/parts/part_header.h"
#include "picture/parts/slab_file.h"
#include "picture/parts/slab_picture.h"

namespace deltasplat {

namespace {

// 64-bit words multiplied into a state, as MurmurHash3's finalizer mixes (Austin Appleby, public
// domain).
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

}  // namespace

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

namespace {

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

// What the slabs of a picture show, as PartHeader has it.
std::string contentOf(const SlabPicture::Impl& picture) {
    std::string text;
    for (const auto& view : picture.views) {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", (unsigned long long)digestOf(*view));
        text += digits;
    }
    return text;
}

// About how long a slab takes: what is stamped, and slices that are read.
double workOf(const SlabPicture::Impl& picture, const SlabPicture::Impl::Place& place) {
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
    explicit SlabShares(const SlabPicture::Impl& picture) {
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
    throw Error(ErrorCode::kUsage, "`share`", shareText(share),
                "some of at most 10000, counted from 1");
}

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

}  // namespace deltasplat
