// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace deltasplat {

/// out[i] = (rows[0][i] + 3 rows[1][i] + 3 rows[2][i] + rows[3][i]) / 8
void addFourRows(const float* const rows[4], std::size_t count, float* out);

/// The same for pixels 2 i to 2 i + 3 of a row, for each i below `pixels`.
/// @param channels  1 or 4
void addFourColumns(const float* row, int channels, int pixels, float* out);

}  // namespace deltasplat
