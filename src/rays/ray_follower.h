// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rays/patch_reader.h"
#include "rays/picture_lines.h"

namespace deltasplat {

/// What a line of sight finds.
struct RayFound {
    double value = 0;    ///< the sum, times slices; or a value
    double slice = 0;    ///< where a largest value is, in positions of the ray
    bool isMet = false;  ///< of values: whether there is any
    double weight = 1;   ///< of means: how much of active voxels is met, in slices
};

/// Follows lines of sight through a volume, many at a time, eight slices at a time. What each finds
/// depends on the volume and on itself alone, but for rounding. Holds what that takes, to be used
/// for one picture's tiles after the other; not thread-safe.
class RayFollower {
  public:
    /// @param volume  made for this rule
    RayFollower(const RayVolume& volume, RayRule rule)
        : volume_(volume), rule_(rule), reader_(volume, rule) {}

    /// Says which blocks the lines may meet that are followed next; without that, it is any.
    /// @param blocks  numbers of the volume's
    void lookAt(std::span<const std::uint32_t> blocks);

    /// Follows lines of sight, best of places beside each other.
    /// @param found  as many
    void follow(std::span<const SightRay> rays, std::span<RayFound> found);

  private:
    /// What lines have found so far.
    struct Sums {
        std::vector<float> found, rest, met;
        void reset(std::size_t count, float value);
        void set(std::size_t i, const Sums& other, std::size_t k);
    };
    /// Lines of the same axes, in whole bundles: the last is there several times.
    struct Alike {
        std::vector<std::size_t> rays;  // which these are
        std::vector<double> startU, startV, slopeU, slopeV;
        std::vector<double> begins;  // the first slice that is seen as a whole, or where they begin
        std::vector<float> slopesU, slopesV;
    };
    /// Bundles beside each other.
    struct Group : LineGroup {
        std::size_t best = 0;  ///< the layer that holds the largest values, where there is any
    };
    /// Of largest values: the least that a line of a bundle has found, the farthest place.
    struct Best {
        float least = 0;
        float farthest = 0;
        bool areMet = false;
    };
    using Bundles = std::span<const std::size_t>;

    void gather(std::span<const SightRay> rays);
    void followAlike(std::span<const SightRay> rays, std::span<RayFound> found);
    void listLayers();
    bool mayFind(std::size_t bundle, float top, const BlockLayer& layer) const;
    void addLayer(std::span<const SightRay> rays, std::size_t number, bool isFirst);
    void addSlices(std::span<const SightRay> rays, Bundles bundles, const glm::ivec2& slices);
    void addOneByOne(std::span<const SightRay> rays, std::size_t bundle, const glm::ivec2& slices);
    PatchBox boxOf(Bundles bundles, const glm::ivec2& slices) const;
    void addPatch(std::span<const SightRay> rays, Bundles bundles, const PatchBox& box);
    void addCuts(std::span<const SightRay> rays, Bundles bundles, const PatchBox& box);
    void addCut(const SightRay& ray, std::size_t i, const PatchBox& box);
    RayFound foundAt(std::size_t i) const;

    const RayVolume& volume_;
    RayRule rule_;
    PatchReader reader_;
    std::optional<LayerNumbers> looksAt_;  // empty: all of the volume's
    RayAxes axes_;
    Alike alike_;
    std::vector<Group> groups_;
    std::vector<BlockLayer> layers_;   // in the order in which lines meet them
    std::vector<float> tops_;          // of each group of each layer
    std::vector<Best> bests_;          // of bundles
    std::vector<std::size_t> chosen_;  // bundles that are followed through a layer
    Sums sums_, shares_;               // of `alike_`; of means also the shares of active voxels
    std::vector<std::int32_t> wholeU_, wholeV_;
    std::vector<float> u_, v_, firstSlice_;
};

}  // namespace deltasplat
