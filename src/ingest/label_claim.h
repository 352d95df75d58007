// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace deltasplat {

/// Whether a file that readVolume has read says that its values are labels: a NIfTI file by its
/// intent (NIFTI_INTENT_LABEL), a segmentation of 3D Slicer (.nrrd, .nhdr) by its `Segment0_ID`.
/// Other formats have no way to say it.
/// @throw Error(kInput) if it cannot be read
bool saysLabels(const std::filesystem::path& input);

}  // namespace deltasplat
