// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "listener.h"
#include "options/command_line.h"

namespace deltasplat {

/// What an input may be, for help texts.
inline constexpr const char* kInputFormats =
    ".vdb .raw .raw.gz .npy .nrrd .nhdr .mhd .mha .nii .nii.gz,\n"
    "a DICOM folder, a multi-page .tif, or images (slice.####.png)";

/// Declares the options that say how an input is to be read.
void addInputOptions(CLI::App& app, ReadOptions& options);

/// Declares --confine, which the former has too.
void addConfineOption(CLI::App& app);

/// Warns of options that were given and are for another kind of file than any of the inputs.
/// @throw Error(kUsage) if these are --volume or --series
void warnOfUnusedInputOptions(const CLI::App& app, const std::vector<std::filesystem::path>& inputs,
                              const Listener& listener);

}  // namespace deltasplat
