// SPDX-License-Identifier: Apache-2.0
#include "medium/room.h"

#include <memory>

#include "ingest/codes/code_tree.h"
#include "view/affine.h"

namespace deltasplat {

Volume withRoom(const Volume& volume, const BlockSet& more) {
    Volume wide = volume;
    if (more.positions.empty()) return wide;
    if (!wide.codes) wide.codes = std::make_shared<const CodeTree>();
    if (volume.empty()) wide.activeCount = 1;
    wide.box = volume.empty() ? more.box : boxOfBoth(volume.box, more.box);
    return wide;
}

}  // namespace deltasplat
