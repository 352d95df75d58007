// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace deltasplat {
namespace {

// Most voxels of a slice read at a time.
constexpr double kMostVoxels = 128 * 128;

// In voxels: means over less are rounding noise.
constexpr double kLeastShare = 0x1p-10;

// Bundles followed through the same layers: 8x8 lines.
constexpr std::size_t kGroupBundles = 8;
constexpr std::size_t kGroupLines = kGroupBundles * kRayBundle;

constexpr float kNothing = -std::numeric_limits<float>::infinity();

// A slice of a patch that a ray meets, but sees only partly.
struct CutSlice {
    const RayPatch& patch;
    const float* values;  // of the slice; null: 1
    const PatchBox& box;
    const SightRay& ray;

    double at(int u, int v) const {
        if (!values) return 1;
        u = std::clamp(u - box.first.y, 0, box.size.y - 1);
        v = std::clamp(v - box.first.z, 0, box.size.z - 1);
        return double(values[std::ptrdiff_t{u} * patch.sizeV + v]);
    }

    // Reads the slice at a place along the ray.
    double read(double place) const {
        const glm::dvec2 p = ray.start + place * ray.slope;
        const glm::dvec2 whole(std::floor(p.x), std::floor(p.y));
        const glm::dvec2 part = p - whole;
        const int u = int(std::clamp(whole.x, -1e9, 1e9));
        const int v = int(std::clamp(whole.y, -1e9, 1e9));
        const double here = at(u, v) + part.y * (at(u, v + 1) - at(u, v));
        const double next = at(u + 1, v) + part.y * (at(u + 1, v + 1) - at(u + 1, v));
        return here + part.x * (next - here);
    }

    // Integral of the slice's share from a place on: a cubic polynomial between planes of voxels,
    // which Gauss's rule integrates exactly with two readings.
    double from(int slice, double place) const {
        std::vector<double> ends;
        const double last = slice + 1;
        const auto addEnd = [&](double end) {
            if (end > place && end < last) ends.push_back(end);
        };
        addEnd(slice);
        for (int i = 0; i < 2; ++i) {
            if (!(ray.slope[i] > 0)) continue;
            const double first = std::floor(ray.start[i] + place * ray.slope[i]) + 1;
            for (int n = 0; n < 3; ++n) addEnd((first + n - ray.start[i]) / ray.slope[i]);
        }
        ends.push_back(last);
        std::sort(ends.begin(), ends.end());
        double sum = 0;
        for (const double end : ends) {
            const double half = 0.5 * (end - place);
            const double middle = place + half;
            for (const double side : {-1.0, 1.0}) {
                const double at = middle + side * half * std::sqrt(1.0 / 3);
                sum += half * (1 - std::abs(at - slice)) * read(at);
            }
            place = end;
        }
        return sum;
    }
};

// Returns the distance of a position behind a whole voxel, counted from `first`.
float behindWhole(double position, int first, std::int32_t& whole) {
    position = std::clamp(position, -1e9, 1e9);
    auto below = std::int32_t(position);
    below -= position < below;
    whole = below - first;
    return float(position - below);
}

// The first slice that a ray sees and sums up whole.
double firstWhole(const SightRay& ray) {
    return std::ceil(ray.nearest) + 1;
}

}  // namespace

void RayFollower::Sums::reset(std::size_t count, float value) {
    found.assign(count, value);
    rest.assign(count, 0.0f);
    met.assign(count, 0.0f);
}

void RayFollower::Sums::set(std::size_t i, const Sums& other, std::size_t k) {
    found[i] = other.found[k];
    rest[i] = other.rest[k];
    met[i] = other.met[k];
}

void RayFollower::lookAt(std::span<const std::uint32_t> blocks) {
    looksAt_ = layersOf(blocks.size(), [&](std::size_t i) -> const CodeBlock& {
        return volume_.blocks[blocks[i]];
    });
}

void RayFollower::follow(std::span<const SightRay> rays, std::span<RayFound> found) {
    std::vector<bool> isDone(rays.size());
    for (std::size_t first = 0; first < rays.size(); ++first) {
        if (isDone[first]) continue;
        axes_ = rays[first].axes;
        alike_.rays.clear();
        for (std::size_t i = first; i < rays.size(); ++i) {
            if (isDone[i] || !(rays[i].axes == axes_)) continue;
            isDone[i] = true;
            found[i] = RayFound();
            if (rays[i].slices.x <= rays[i].slices.y) alike_.rays.push_back(i);
        }
        if (!alike_.rays.empty()) followAlike(rays, found);
    }
}

void RayFollower::gather(std::span<const SightRay> rays) {
    const std::size_t bundles = (alike_.rays.size() + kRayBundle - 1) / kRayBundle;
    alike_.rays.resize(bundles * kRayBundle, alike_.rays.back());
    for (std::vector<double>* values :
         {&alike_.startU, &alike_.startV, &alike_.slopeU, &alike_.slopeV, &alike_.begins})
        values->resize(alike_.rays.size());
    alike_.slopesU.resize(alike_.rays.size());
    alike_.slopesV.resize(alike_.rays.size());
    for (std::size_t i = 0; i < alike_.rays.size(); ++i) {
        const SightRay& ray = rays[alike_.rays[i]];
        alike_.startU[i] = ray.start.x;
        alike_.startV[i] = ray.start.y;
        alike_.slopeU[i] = ray.slope.x;
        alike_.slopeV[i] = ray.slope.y;
        alike_.begins[i] = isExtreme(rule_) ? ray.nearest : firstWhole(ray);
        alike_.slopesU[i] = float(ray.slope.x);
        alike_.slopesV[i] = float(ray.slope.y);
    }
    sums_.reset(alike_.rays.size(), isExtreme(rule_) ? kNothing : 0.0f);
    if (rule_ == RayRule::kMean) shares_.reset(alike_.rays.size(), 0.0f);
    for (std::vector<float>* values : {&u_, &v_, &firstSlice_}) values->resize(alike_.rays.size());
    wholeU_.resize(alike_.rays.size());
    wholeV_.resize(alike_.rays.size());
    bests_.assign(bundles, {});
    groups_.assign((bundles + kGroupBundles - 1) / kGroupBundles, {});
    for (std::size_t i = 0; i < alike_.rays.size(); ++i)
        groups_[i / kGroupLines].addSlices(rays[alike_.rays[i]].slices);
    for (std::size_t i = 0; i < alike_.rays.size(); ++i) {
        const SightRay& ray = rays[alike_.rays[i]];
        groups_[i / kGroupLines].addLine(ray.start, ray.slope);
    }
}

// Lists the layers of blocks that lines meet, and groups' largest values there.
void RayFollower::listLayers() {
    double from = axes_.count.x;
    double to = -1;
    for (const Group& group : groups_) {
        from = std::min(from, group.slices().x);
        to = std::max(to, group.slices().y);
    }
    const LayerNumbers& layers = looksAt_ ? *looksAt_ : volume_.layers;
    const std::vector<int>& blocks = layers[std::size_t(axes_.order[0])];
    layers_.clear();
    for (std::size_t n = 0; n < blocks.size(); ++n) {
        const int block = blocks[axes_.sign.x > 0 ? n : blocks.size() - 1 - n];
        const int a = axes_.sign.x * (8 * block - axes_.first.x);
        const int b = axes_.sign.x * (8 * block + 7 - axes_.first.x);
        const glm::ivec2 slices(std::max(std::min(a, b), 0),
                                std::min(std::max(a, b), axes_.count.x - 1));
        if (slices.x > to + 1) break;
        if (slices.y >= from - 1) layers_.push_back({block, slices});
    }
    tops_.clear();
    for (Group& group : groups_) {
        float best = kNothing;
        for (std::size_t n = 0; n < layers_.size(); ++n) {
            tops_.push_back(group.meets(layers_[n]) ? group.topOf(volume_.tops, axes_, layers_[n])
                                                    : kNothing);
            if (tops_.back() > best) group.best = n;
            best = std::max(best, tops_.back());
        }
    }
}

// Whether a bundle may find something in a layer of blocks up to `top`: for largest values, a
// larger one, or an equal one at a nearer place.
bool RayFollower::mayFind(std::size_t bundle, float top, const BlockLayer& layer) const {
    const Best& best = bests_[bundle];
    return !best.areMet || top > best.least ||
           (top == best.least && float(layer.slices.x - 1) < best.farthest);
}

void RayFollower::followAlike(std::span<const SightRay> rays, std::span<RayFound> found) {
    gather(rays);
    listLayers();
    // Layers with the largest values first spare most others.
    if (isExtreme(rule_))
        for (std::size_t layer = 0; layer < layers_.size(); ++layer) addLayer(rays, layer, true);
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) addLayer(rays, layer, false);
    for (std::size_t i = 0; i < alike_.rays.size(); ++i) found[alike_.rays[i]] = foundAt(i);
}

// Follows bundles through a layer.
// @param isFirst  largest values: groups with their largest top here, else the remaining ones
void RayFollower::addLayer(std::span<const SightRay> rays, std::size_t number, bool isFirst) {
    const BlockLayer& layer = layers_[number];
    chosen_.clear();
    for (std::size_t group = 0; group < groups_.size(); ++group) {
        const float top = tops_[group * layers_.size() + number];
        if (top == kNothing) continue;
        if (isExtreme(rule_) && isFirst != (groups_[group].best == number)) continue;
        const std::size_t first = group * kGroupBundles;
        const std::size_t last = std::min(first + kGroupBundles, bests_.size());
        for (std::size_t bundle = first; bundle < last; ++bundle)
            if (!isExtreme(rule_) || mayFind(bundle, top, layer)) chosen_.push_back(bundle);
    }
    if (chosen_.empty()) return;
    // Largest values are read between slices too, also before and behind the layer.
    const int around = isExtreme(rule_) ? 1 : 0;
    addSlices(rays, chosen_, layer.slices + glm::ivec2(-around, around));
    if (!isExtreme(rule_)) return;
    for (const std::size_t bundle : chosen_) {
        Best best{std::numeric_limits<float>::infinity(), kNothing, true};
        for (std::size_t i = kRayBundle * bundle; i < kRayBundle * (bundle + 1); ++i) {
            best.least = std::min(best.least, sums_.found[i]);
            best.farthest = std::max(best.farthest, sums_.rest[i]);
            best.areMet = best.areMet && sums_.met[i] > 0;
        }
        bests_[bundle] = best;
    }
}

RayFound RayFollower::foundAt(std::size_t i) const {
    const double found = double(sums_.found[i]);
    if (rule_ == RayRule::kSum) return {found, 0, true};
    if (rule_ == RayRule::kMean) {
        const double share = double(shares_.found[i]);
        const bool isMet = share > kLeastShare;
        return {isMet ? found / share : 0, 0, isMet, share};
    }
    const bool isMet = sums_.met[i] > 0;
    return {isMet ? found : 0, double(sums_.rest[i]), isMet};
}

void RayFollower::addSlices(std::span<const SightRay> rays, Bundles bundles,
                            const glm::ivec2& slices) {
    const PatchBox box = boxOf(bundles, slices);
    if (!reader_.find(axes_, box)) return;
    if (double(box.size.y) * box.size.z <= kMostVoxels) return addPatch(rays, bundles, box);
    if (bundles.size() == 1) return addOneByOne(rays, bundles.front(), slices);
    const std::size_t half = bundles.size() / 2;
    addSlices(rays, bundles.first(half), slices);
    addSlices(rays, bundles.subspan(half), slices);
}

// Follows a bundle of lines that lie far apart, each as its own bundle.
void RayFollower::addOneByOne(std::span<const SightRay> rays, std::size_t bundle,
                              const glm::ivec2& slices) {
    const Alike whole = alike_;
    const Sums sums = sums_, shares = shares_;
    Sums newSums = sums, newShares = shares;
    const std::size_t first = kRayBundle * bundle;
    for (std::size_t k = first; k < first + kRayBundle; ++k) {
        for (std::size_t i = first; i < first + kRayBundle; ++i) {
            alike_.rays[i] = whole.rays[k];
            alike_.startU[i] = whole.startU[k];
            alike_.startV[i] = whole.startV[k];
            alike_.slopeU[i] = whole.slopeU[k];
            alike_.slopeV[i] = whole.slopeV[k];
            alike_.begins[i] = whole.begins[k];
            alike_.slopesU[i] = whole.slopesU[k];
            alike_.slopesV[i] = whole.slopesV[k];
            sums_.set(i, sums, k);
            if (rule_ == RayRule::kMean) shares_.set(i, shares, k);
        }
        const std::size_t alone[] = {bundle};
        const PatchBox box = boxOf(alone, slices);
        if (reader_.find(axes_, box)) addPatch(rays, alone, box);
        newSums.set(k, sums_, k);
        if (rule_ == RayRule::kMean) newShares.set(k, shares_, k);
    }
    alike_ = whole;
    sums_ = newSums;
    shares_ = newShares;
}

// Box of voxels that lines read for some slices, first and last, and between them and their
// neighbours. Lines that leave the volume read beside it.
PatchBox RayFollower::boxOf(Bundles bundles, const glm::ivec2& slices) const {
    PatchBox box;
    box.first.x = slices.x;
    box.size.x = slices.y - slices.x + 1;
    const std::vector<double>* const starts[] = {&alike_.startU, &alike_.startV};
    const std::vector<double>* const slopes[] = {&alike_.slopeU, &alike_.slopeV};
    for (int axis = 0; axis < 2; ++axis) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const std::size_t bundle : bundles) {
            const double* const start = starts[axis]->data() + kRayBundle * bundle;
            const double* const slope = slopes[axis]->data() + kRayBundle * bundle;
            for (std::size_t k = 0; k < kRayBundle; ++k) {
                low = std::min(low, start[k] + (slices.x - 1) * slope[k]);
                high = std::max(high, start[k] + slices.y * slope[k]);
            }
        }
        const double beyond = axes_.count[axis + 1];
        const int first = int(std::floor(std::clamp(low, -4.0, beyond)));
        // Four voxels from there on; the last one, for remainders of less than a voxel.
        const int last = int(std::floor(std::clamp(high, -4.0, beyond))) + 4;
        box.first[axis + 1] = first;
        box.size[axis + 1] = last - first + 1;
    }
    return box;
}

void RayFollower::addPatch(std::span<const SightRay> rays, Bundles bundles, const PatchBox& box) {
    const RayPatch& patch = reader_.read(axes_, box);
    for (const std::size_t bundle : bundles) {
        const std::size_t first = kRayBundle * bundle;
        for (std::size_t i = first; i < first + kRayBundle; ++i) {
            u_[i] = behindWhole(alike_.startU[i] + box.first.x * alike_.slopeU[i], box.first.y,
                                wholeU_[i]);
            v_[i] = behindWhole(alike_.startV[i] + box.first.x * alike_.slopeV[i], box.first.z,
                                wholeV_[i]);
            firstSlice_[i] = float(alike_.begins[i] - box.first.x);
        }
    }
    if (!isExtreme(rule_)) addCuts(rays, bundles, box);
    RayRun lines;
    lines.bundles = bundles.data();
    lines.count = bundles.size();
    lines.wholeU = wholeU_.data();
    lines.wholeV = wholeV_.data();
    lines.u = u_.data();
    lines.v = v_.data();
    lines.slopeU = alike_.slopesU.data();
    lines.slopeV = alike_.slopesV.data();
    lines.firstSlice = firstSlice_.data();
    lines.found = sums_.found.data();
    lines.rest = sums_.rest.data();
    lines.met = sums_.met.data();
    lines.depth = float(box.first.x);
    if (rule_ == RayRule::kMean) {
        lines.share = shares_.found.data();
        lines.shareRest = shares_.rest.data();
    }
    isExtreme(rule_) ? maxSlices(patch, lines) : sumSlices(patch, lines);
}

// Adds slices that lines see only partly.
void RayFollower::addCuts(std::span<const SightRay> rays, Bundles bundles, const PatchBox& box) {
    const double last = box.first.x + box.size.x - 1;
    for (const std::size_t bundle : bundles) {
        for (std::size_t i = kRayBundle * bundle; i < kRayBundle * (bundle + 1); ++i) {
            const double whole = alike_.begins[i];
            if (whole > box.first.x && whole - 2 <= last) addCut(rays[alike_.rays[i]], i, box);
        }
    }
}

void RayFollower::addCut(const SightRay& ray, std::size_t i, const PatchBox& box) {
    const RayPatch& patch = reader_.patch();
    const int last = box.first.x + box.size.x - 1;
    const int end = int(std::min(firstWhole(ray) - 1, double(last)));
    for (int slice = std::max(int(firstWhole(ray)) - 2, box.first.x); slice <= end; ++slice) {
        const std::ptrdiff_t at = (slice - box.first.x) * patch.sliceStep;
        const double from = std::max(ray.nearest, slice - 1.0);
        const auto addTo = [&](const float* values, Sums& sums) {
            const CutSlice cut{patch, values ? values + at : nullptr, box, ray};
            sums.found[i] += float(cut.from(slice, from));
        };
        addTo(patch.values, sums_);
        if (rule_ == RayRule::kMean) addTo(patch.active, shares_);
    }
}

}  // namespace deltasplat
