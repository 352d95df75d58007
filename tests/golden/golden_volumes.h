// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "deltasplat/ingest/volume.h"

namespace deltasplat::test {

/// Returns small volumes by name: what `deltasplat synth` makes, and some that are chosen for their
/// numbers. All go through a file, as a user's do.
std::map<std::string, Volume> goldenVolumes();

}  // namespace deltasplat::test
