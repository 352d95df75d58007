// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "options/command_line.h"

namespace deltasplat {

/// Declares one subcommand in the program; its options wait for Subcommand::declareOptions.
using AddSubcommand = Subcommand (*)(CLI::App& program);

/// Parses the arguments (the first is the program's name), runs the subcommand they name and
/// returns the exit code. Whatever goes wrong becomes one line on standard error.
int runProgram(const std::vector<std::string>& arguments,
               const std::vector<AddSubcommand>& addSubcommands);

}  // namespace deltasplat
