// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "delta/join_probe.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/view/factorization.h"
#include "view/joined_slants.h"

namespace deltasplat {

/// Judges, for one scene, whether pictures show that slices, or voxels beside each other, become
/// one. Thread-safe.
class JoinJudge {
  public:
    /// Whether it may be seen: if light or opacity changes by more than a 64th on average, or by
    /// more than a 16th from pixel to pixel (JoinedChange), or if that is not known. What is beside
    /// the picture counts as well, so that parts of a picture are drawn alike, and nothing that was
    /// asked before.
    /// @param view  of the volume's own voxels, the first of the picture's
    bool mayBeSeen(const JoinedVoxels& joined, const PreparedScene::Impl& scene,
                   const Factorization& view) const;

  private:
    // What can be seen, in the order of one slice axis.
    struct Axis {
        Axis(const PreparedScene::Impl& scene, int sliceAxis);

        int sliceAxis;
        ClassTable classes;
        JoinProbe probe;
    };
    using Key = std::vector<std::uint64_t>;

    mutable std::mutex mutex_;
    mutable std::unique_ptr<const Axis> axis_;  // that was asked for last
    mutable std::map<Key, bool> known_;
};

}  // namespace deltasplat
