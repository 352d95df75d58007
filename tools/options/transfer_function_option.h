// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "deltasplat/optics/presets.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// What --tf takes: a file, of ParaView or of labels, `FILE:NAME` for one of several in a file, or
/// the name of a preset. A file comes before all else of its name.
struct TransferFunctionOption {
    std::filesystem::path file;      ///< empty: a preset
    std::string name;                ///< within the file; empty: the first
    const Preset* preset = nullptr;  ///< null: a file
};

/// Returns what the text stands for; of an empty one nothing.
TransferFunctionOption parseTransferFunction(const std::filesystem::path& given);

/// Reads or makes what the option stands for.
/// @throw Error(kInput) as readTransferFunction; Error(kUsage) if it is neither a file nor a
/// preset, and looks like no file's name
TransferFunction readTransferFunctionOption(const std::filesystem::path& given,
                                            const Listener& listener);

}  // namespace deltasplat
