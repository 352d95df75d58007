// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

#include "deltasplat/ingest/code_book.h"

namespace deltasplat {

/// Returns the smallest and the largest of some codes, at least one.
std::pair<Code, Code> rangeOfCodes(std::span<const Code> codes);

}  // namespace deltasplat
