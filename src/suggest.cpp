// SPDX-License-Identifier: Apache-2.0
// Based on: V. I. Levenshtein, "Binary codes capable of correcting deletions, insertions, and
// reversals", 1966; the dynamic programme of Wagner and Fischer, 1974, in which neighbours that
// have changed places count once, as in F. J. Damerau, "A technique for computer detection and
// correction of spelling errors", 1964.
#include "suggest.h"

#include <algorithm>
#include <numeric>

namespace deltasplat {
namespace {

std::size_t editDistance(const std::string& a, const std::string& b) {
    using Row = std::vector<std::size_t>;
    Row row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    Row before = row;  // and the one before that
    Row earlier = row;
    for (std::size_t i = 0; i < a.size(); ++i) {
        earlier.swap(before);
        before.swap(row);
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = before[j] + (a[i] == b[j] ? 0 : 1);
            row[j + 1] = std::min({replaced, before[j + 1] + 1, row[j] + 1});
            const bool isSwapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
            if (isSwapped) row[j + 1] = std::min(row[j + 1], earlier[j - 1] + 1);
        }
    }
    return row.back();
}

}  // namespace

std::string suggestion(const std::string& text, const std::vector<std::string>& words) {
    // More than a third of the letters wrong is another word, not a slip.
    std::size_t best = text.size() / 3 + 1;
    std::string found;
    for (const std::string& word : words) {
        const std::size_t longer = std::max(text.size(), word.size());
        if (longer - std::min(text.size(), word.size()) >= best) continue;
        const std::size_t distance = editDistance(text, word);
        if (distance >= best) continue;
        best = distance;
        found = word;
    }
    return found.empty() ? "" : " Did you mean '" + found + "'?";
}

}  // namespace deltasplat
