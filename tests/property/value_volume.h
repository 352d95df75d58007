// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/ingest/volume.h"
#include "reference/reference_rays.h"
#include "volume/code_tree.h"

namespace deltasplat::test {

/// What the plain reference is told of a volume.
inline reference::ValueVolume plainVolume(const Volume& volume) {
    reference::ValueVolume plain;
    const glm::ivec3 dims = volume.box().dims();
    for (int k = 0; k < 3; ++k) {
        plain.first[k] = volume.box().min[k];
        plain.dims[k] = dims[k];
        for (int i = 0; i < 3; ++i) plain.axes[k][i] = volume.worldFromIndex()[k][i];
        plain.origin[k] = volume.worldFromIndex()[3][k];
    }
    for (int z = volume.box().min.z; z <= volume.box().max.z; ++z) {
        for (int y = volume.box().min.y; y <= volume.box().max.y; ++y) {
            for (int x = volume.box().min.x; x <= volume.box().max.x; ++x) {
                const openvdb::Coord at(x, y, z);
                plain.active.push_back(volume.codes()->tree().isValueOn(at));
                plain.values.push_back(
                    volume.codeBook().valueOf(volume.codes()->tree().getValue(at)));
            }
        }
    }
    return plain;
}

}  // namespace deltasplat::test
