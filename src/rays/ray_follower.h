// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rays/patch_reader.h"
#include "rays/picture_lines.h"

namespace deltasplat {

/// Result of a line of sight.
struct RayFound {
    double value = 0;    ///< the sum, times slices, or a value
    double slice = 0;    ///< place of a largest value, in positions of the ray
    bool isMet = false;  ///< for values: whether there is any
    double weight = 1;   ///< for means: active voxels met, in slices
};

/// Follows many lines of sight at a time through a volume, eight slices at a time, tile after tile.
/// Results depend only on the volume and the line, but for rounding. Not thread-safe.
class RayFollower {
  public:
    /// @param volume  made for this rule
    RayFollower(const RayVolume& volume, RayRule rule)
        : volume_(volume), rule_(rule), reader_(volume, rule) {}

    /// Limits the next lines to some blocks that they may meet; the default is all.
    /// @param blocks  numbers of the volume's
    void lookAt(std::span<const std::uint32_t> blocks);

    /// Follows lines of sight, best of neighbouring places.
    /// @param found  one per ray
    void follow(std::span<const SightRay> rays, std::span<RayFound> found);

  private:
    /// Intermediate results.
    struct Sums {
        std::vector<float> found, rest, met;
        void reset(std::size_t count, float value);
        void set(std::size_t i, const Sums& other, std::size_t k);
    };
    /// Lines of the same axes, in whole bundles padded with the last line.
    struct Alike {
        std::vector<std::size_t> rays;  // their numbers
        std::vector<double> startU, startV, slopeU, slopeV;
        std::vector<double>
            begins;  // first slice that is seen as a whole, or where the line begins
        std::vector<float> slopesU, slopesV;
    };
    /// Neighbouring bundles.
    struct Group : LineGroup {
        std::size_t best = 0;  ///< layer with the largest values, if there is any
    };
    /// Largest values of a bundle: least result of its lines, farthest place.
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
    std::vector<BlockLayer> layers_;   // in the order that lines meet them
    std::vector<float> tops_;          // of each group in each layer
    std::vector<Best> bests_;          // of bundles
    std::vector<std::size_t> chosen_;  // bundles followed through a layer
    Sums sums_, shares_;               // of `alike_`; for means also shares of active voxels
    std::vector<std::int32_t> wholeU_, wholeV_;
    std::vector<float> u_, v_, firstSlice_;
};

}  // namespace deltasplat
