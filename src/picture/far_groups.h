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

/// Groups of a volume's voxels that lie far apart. Sheets and layers have the size of a box, and
/// what lies between such groups would cost more than they do: each is drawn in a box of its own,
/// as a volume of its voxels alone would be, and one is put behind the other. Planes between groups
/// say which is in front, wherever a camera stands.
class FarGroups {
  public:
    /// Finds them; nothing where a volume is drawn as one: boxes of less than about 3000 voxels a
    /// side, or 16000 along one, and all that cost less than twice what those of groups do. Reads
    /// no leaf.
    /// @param volume  must outlive the groups
    /// @param more    blocks that a painter adds, or null
    static std::optional<FarGroups> find(const Volume& volume, const BlockSet* more = nullptr);

    std::size_t size() const;
    /// Returns a volume of a group's voxels. What is known of all values stays that of the whole.
    Volume volume(std::size_t group) const;

    /// How a picture shows a group.
    struct Seen {
        PixelBox part;           ///< pixels that may show something of it
        glm::dvec2 size{0.0};    ///< of its box in the picture, in pixels
        bool isNothing() const;  ///< nothing of it is seen, or too little for a 32-bit float
    };
    Seen seenBy(const Camera& camera, std::size_t group) const;
    /// Returns the numbers of all groups, those in front first.
    std::vector<std::size_t> frontToBack(const Camera& camera) const;
    /// Says so where a picture shows no group larger than a pixel, and what would; returns whether
    /// it did.
    bool warnOfDots(const Camera& camera, const Listener& listener) const;

  private:
    struct Impl;
    explicit FarGroups(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
    std::shared_ptr<const Impl> impl_;
};

}  // namespace deltasplat
