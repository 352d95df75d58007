// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tree/Tree.h>

#include <memory>

#include "deltasplat/delta/delta_file.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/exact_deltas.h"

namespace deltasplat {

/// What becomes a delta grid.
struct TakenDeltas {
    std::shared_ptr<openvdb::TreeBase>
        deltas;          ///< without sign, as voxels: if asked for, still to be packed
    DeltaHeader header;  ///< but for what a .vdb source says of itself
    InactiveValues inactive;
};

/// Takes the differences of a volume, of codes or of its values' own bits as DeltaFile::add does.
/// Multi-threaded; deterministic.
TakenDeltas takeDeltas(const Volume& volume, const DeltaFileOptions& options,
                       const Listener& listener = {});

}  // namespace deltasplat
