// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/command_line.h"

namespace deltasplat {

Subcommand addBench(CLI::App& program);
Subcommand addConvert(CLI::App& program);
Subcommand addDelta(CLI::App& program);
Subcommand addDiff(CLI::App& program);
Subcommand addFold(CLI::App& program);
Subcommand addInfo(CLI::App& program);
Subcommand addRender(CLI::App& program);
Subcommand addRestore(CLI::App& program);
Subcommand addSynth(CLI::App& program);

}  // namespace deltasplat
