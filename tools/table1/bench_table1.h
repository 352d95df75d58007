// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/command_line.h"

namespace deltasplat {

/// Declares `deltasplat bench table1`.
Subcommand addTable1(CLI::App& bench);

}  // namespace deltasplat
