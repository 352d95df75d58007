// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/view/factorization.h"
#include "view/base_plane.h"
#include "words/join_probe.h"

namespace deltasplat {

/// Judges, for one scene, whether pictures show that slices, or voxels beside each other, become
/// one. Thread-safe.
class JoinJudge {
  public:
    /// Returns the first of some that is known to change light and opacity little, on average and
    /// from place to place (JoinedChange); else single voxels. Nothing but lines of sight counts,
    /// neither a picture's frame nor what was asked before: so parts of a picture are drawn alike.
    /// @param view  of the volume's own voxels, the first of the picture's
    JoinedVoxels firstUnseen(const std::vector<JoinedVoxels>& some,
                             const PreparedScene::Impl& scene, const Factorization& view) const;

  private:
    // What can be seen, in the order of one slice axis.
    struct Axis {
        Axis(const PreparedScene::Impl& scene, int sliceAxis);

        int sliceAxis;
        const ClassTable& classes;  // of the scene
        JoinProbe probe;
    };
    using Key = std::vector<std::uint64_t>;

    static JoinedVoxels firstUnseen(const std::vector<JoinedVoxels>& some, const Axis& axis,
                                    const Volume& volume, const Factorization& view);

    mutable std::mutex mutex_;
    mutable std::unique_ptr<const Axis> axis_;  // that was asked for last
    mutable std::map<Key, JoinedVoxels> known_;
};

}  // namespace deltasplat
