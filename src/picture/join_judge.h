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

/// Judges for a scene whether joined slices or voxels look different. Thread-safe.
class JoinJudge {
  public:
    /// Returns the first candidate that changes light and opacity little, on average and locally
    /// (JoinedChange); else single voxels. Depends on lines of sight only, not on a picture's frame
    /// or on earlier calls, so that parts of a picture are drawn alike.
    /// @param view  of the volume's own voxels, the first of the picture
    JoinedVoxels firstUnseen(const std::vector<JoinedVoxels>& some,
                             const PreparedScene::Impl& scene, const Factorization& view) const;

  private:
    // The visible voxels, in the order of one slice axis.
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
    mutable std::unique_ptr<const Axis> axis_;  // of the last call
    mutable std::map<Key, JoinedVoxels> known_;
};

}  // namespace deltasplat
