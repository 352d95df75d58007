// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "convert/value_facts.h"
#include "convert/write_report.h"

namespace deltasplat {

/// Returns the type in which a dense format stores a volume: the type that it had before it was a
/// .vdb (kSourceTypeKey) or its own if that holds every value, otherwise float32 or, if that does
/// not hold every value, float64. Says so where the type is another one.
/// @param wide  whether the format has integers of 64 bits
RawType denseType(const Volume& volume, const ValueFacts& facts, bool wide, Notes& notes);

}  // namespace deltasplat
