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

/// Parts of a future delta grid.
struct TakenDeltas {
    std::shared_ptr<openvdb::TreeBase> deltas;  ///< zigzag deltas as voxels, not yet packed
    DeltaHeader header;                         ///< without the facts of a .vdb source
    InactiveValues inactive;
};

/// Takes the deltas of a volume for DeltaFile::add: of codes or of its values' own bits.
/// Multi-threaded; deterministic.
TakenDeltas takeDeltas(const Volume& volume, const DeltaFileOptions& options,
                       const Listener& listener = {});

}  // namespace deltasplat
