// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "deltasplat/ingest/volume.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// Writes the values of the voxels of a box into values[z][y][x]. To be called from any thread.
template <typename Value>
using ReadBox = std::function<void(const IndexBox& box, Value* values)>;

/// Returns what reads the values of a volume: from its source if there is one, otherwise from its
/// codes. Inactive voxels have the value they hold, or the volume's background if that is NaN or
/// infinite. Integers beyond 2^53 become the nearest double. The volume must outlive it.
ReadBox<double> boxReader(const Volume& volume);

/// Returns what reads integers of 64 bits as they are, unsigned ones by their bits; empty for a
/// volume whose source has none.
ReadBox<std::int64_t> integerReader(const Volume& volume);

/// Stores `count` values one after the other, little endian.
/// @return the largest difference between a value and the one stored
double storeValues(const double* values, std::size_t count, RawType type, std::byte* out);

/// Stores integers of 64 bits, with a sign or without.
/// @return 0
double storeValues(const std::int64_t* values, std::size_t count, RawType type, std::byte* out);

}  // namespace deltasplat
