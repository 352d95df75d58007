// SPDX-License-Identifier: Apache-2.0
#include "medium/room.h"

#include <glm/common.hpp>
#include <memory>

#include "ingest/codes/code_tree.h"

namespace deltasplat {

Volume withRoom(const Volume& volume, const BlockSet& more) {
    Volume wide = volume;
    if (more.positions.empty()) return wide;
    if (!wide.codes) wide.codes = std::make_shared<const CodeTree>();
    if (volume.empty()) wide.activeCount = 1;
    wide.box = volume.empty() ? more.box
                              : IndexBox{glm::min(volume.box.min, more.box.min),
                                         glm::max(volume.box.max, more.box.max)};
    return wide;
}

}  // namespace deltasplat
