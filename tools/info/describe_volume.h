// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deltasplat/optics/presets.h"
#include "info/info_report.h"

namespace deltasplat {

/// What `info` is to find out besides what is always told.
struct DescribeOptions {
    /// What stamps are predicted for; empty: for all voxels but the guessed background.
    std::optional<TransferFunction> transferFunction;
    const Preset* preset = nullptr;    ///< that it is, or null
    std::string transferFunctionFile;  ///< its name, for people
};

/// Counts and predicts, and lets go of the volume's codes and source.
/// @param plot  whether what a plot needs is counted as well
GridReport describeVolume(Volume volume, const DescribeOptions& options, bool plot);

}  // namespace deltasplat
