// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns the names of a ParaView JSON file's functions, in order; "" if nameless or malformed.
/// @throw Error(kInput) if the file is missing or no JSON, or holds none
std::vector<std::string> transferFunctionNames(const std::filesystem::path& file);

/// Reads the first function of that name, as readTransferFunction; others may be malformed.
/// @throw Error(kInput) likewise, or naming the existing functions
TransferFunction readTransferFunction(const std::filesystem::path& file, const std::string& name,
                                      const Listener& listener = {});

}  // namespace deltasplat
