// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

struct BlockSet;

/// Groups of a volume's voxels that lie far apart. Sheets and layers have the size of a box, so the
/// space between groups would cost more than the groups. Each group is therefore drawn as a volume,
/// and the pictures are merged. Planes between groups order them for every camera.
class FarGroups {
  public:
    /// Finds groups; nothing if the volume is better drawn as one: smaller than about 3000 voxels a
    /// side (or 16000 along one), or at less than twice the cost of the groups. Reads no leaf.
    /// @param volume  must outlive the groups
    /// @param more    blocks that a painter adds, or null
    static std::optional<FarGroups> find(const Volume& volume, const BlockSet* more = nullptr);

    std::size_t size() const;
    /// Returns a volume of a group's voxels. Facts about all values remain those of the whole.
    Volume volume(std::size_t group) const;

    /// How a picture shows a group.
    struct Seen {
        PixelBox part;           ///< pixels that may show the group
        glm::dvec2 size{0.0};    ///< of the group's box in the picture, in pixels
        bool isNothing() const;  ///< invisible, or too small for a 32-bit float
    };
    Seen seenBy(const Camera& camera, std::size_t group) const;
    /// Returns the numbers of all groups from front to back.
    std::vector<std::size_t> frontToBack(const Camera& camera) const;
    /// Warns, and returns true, if no group is larger than a dot; says how to see more.
    bool warnOfDots(const Camera& camera, const Listener& listener) const;

  private:
    struct Impl;
    explicit FarGroups(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<const Impl> impl_;
};

}  // namespace deltasplat
