// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "deltasplat/optics/presets.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// What --tf takes: a file, of ParaView or of labels, `FILE:NAME` for one of several in a file, or
/// the name of a preset. A file comes before all else of its name; of several that `FILE:NAME` may
/// mean, the one with the longest name.
struct TransferFunctionOption {
    std::filesystem::path file;      ///< empty: a preset
    std::string name;                ///< within the file; empty: the first
    const Preset* preset = nullptr;  ///< null: a file
};

/// Returns what the text stands for; of an empty one nothing.
/// @throw Error(kUsage) if it is neither a file nor a preset, and looks like no file's name, or
/// names a file and behind a colon nothing
TransferFunctionOption parseTransferFunction(const std::filesystem::path& given);

/// Reads or makes what the option stands for.
/// @throw Error(kInput) as readTransferFunction; Error(kUsage) as parseTransferFunction, or if one
/// of several in a table of labels is asked for
TransferFunction readTransferFunctionOption(const std::filesystem::path& given,
                                            const Listener& listener);

/// Whether it is for labels: a table of them, or a preset. What cannot be read is not.
bool isForLabels(const std::filesystem::path& given);

/// Returns what a table of labels calls them; of anything else no names.
/// @throw as readTransferFunctionOption
std::map<int, std::string> labelNames(const std::filesystem::path& given);

}  // namespace deltasplat
