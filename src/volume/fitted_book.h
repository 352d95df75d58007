// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/source_values.h"
#include "volume/value_survey.h"

namespace deltasplat {

/// How exactly a fitted book is to keep values: each within kRelativeNeed of its magnitude, and
/// values of the bulk within kBulkNeed of its width as well.
inline constexpr double kRelativeNeed = 2e-4;
inline constexpr double kBulkNeed = 0x1p-16;

/// Returns the bulk of the values: from the cell of their 1st to that of their 99th percentile,
/// those that are 0 and the frequent ones left out. Outliers do not move it.
/// @param frequent  with counts that are at most the true ones
glm::dvec2 bulkOf(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent);

/// Fits a book to where values lie: codes go only there. All is asked of every value, but for those
/// next to 0, whose share of themselves is next to nothing; they are allowed an error that is as
/// small as 65536 codes allow. If codes are left over, all errors are made smaller alike; if they
/// do not suffice, some needs are given up, one after the other and each only as far as it takes:
///   1. the hundredth of the values that is nearest to 0 is off by more than kRelativeNeed;
///   2. the bulk is kept no better than other values;
///   3. the tenth of the values that is nearest to 0 is off by more than a thousandth of itself;
///   4. every value is off by up to a thousandth of itself;
///   5. values are off by kBulkNeed of the bulk's width;
///   6. every value is off by a larger share.
/// @param cells     at least one
/// @param frequent  values that are to have a code to themselves; those outside of all cells none
/// @param kind      what the values of codes are to be
CodeBook fitBook(const std::vector<ValueCell>& cells, const std::vector<FrequentValue>& frequent,
                 CodeBook::Values kind);

}  // namespace deltasplat
