// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command_line.h"
#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Declares the options that say how an input is to be read.
void addInputOptions(CLI::App& app, ReadOptions& options);

}  // namespace deltasplat
