// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat {

/// Reads a .raw or .raw.gz file; as readVolume.
Volume readRaw(const std::filesystem::path& file, const ReadOptions& options,
               const Listener& listener);

/// Reads one scalar grid of a .vdb file, or with `all` (and no grid name) every one; as
/// forEachVolume.
void readVdb(const std::filesystem::path& file, const ReadOptions& options, bool all,
             const VolumeVisitor& visitor, const Listener& listener);

/// @throw Error(kInput) if `high - low` is no finite number: no code book spans it
void requireFiniteSpan(const std::string& where, double low, double high);

/// @throw Error(kUsage) if `nanValue`, which is to replace a value, is no finite float
void requireFloatNan(double nanValue);

/// Sets activeCount, valueMin and valueMax from the histogram and the code book.
void summarize(Volume& volume);

}  // namespace deltasplat
