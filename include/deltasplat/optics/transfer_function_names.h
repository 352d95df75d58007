// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Returns the names of a ParaView JSON file's transfer functions, in the file's order; "" for one
/// without a name or malformed.
/// @throw Error(kInput) if the file is missing or no JSON, or holds none
std::vector<std::string> transferFunctionNames(const std::filesystem::path& file);

/// Reads the transfer function of that name, the first of several, as readTransferFunction does,
/// whatever is wrong with the others.
/// @throw Error(kInput) as that, or naming those that there are
TransferFunction readTransferFunction(const std::filesystem::path& file, const std::string& name,
                                      const Listener& listener = {});

}  // namespace deltasplat
