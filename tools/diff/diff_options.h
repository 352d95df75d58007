// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>

#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/ingest/read_volume.h"
#include "options/command_line.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// Which differences are let through, beside the thresholds of CompareOptions.
struct DiffLimits {
    double failPercent = 0;  ///< share of voxels that may be over the fail threshold
    double warnPercent = 0;  ///< share of voxels that may be over the warn threshold
    double hardFail = std::numeric_limits<double>::infinity();  ///< no voxel may be over it
    double hardWarn = std::numeric_limits<double>::infinity();  ///< no voxel may be over it
    bool ignoreActive = false;                                  ///< active states do not matter
    bool ignoreMissing = false;  ///< grids that are compared with nothing do not matter
};

struct DiffOptions {
    std::filesystem::path a;
    std::filesystem::path b;
    CompareOptions compare;
    DiffLimits limits;
    ReadOptions read;
    FrameChoice frames;
    bool json = false;
};

/// Declares the options of `diff`, with idiff's names.
void addDiffOptions(CLI::App& app, DiffOptions& options);

}  // namespace deltasplat
