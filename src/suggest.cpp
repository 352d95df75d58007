// SPDX-License-Identifier: Apache-2.0
// Based on: V. I. Levenshtein, "Binary codes capable of correcting deletions, insertions, and
// reversals", 1966; the one-row dynamic programme of Wagner and Fischer, 1974.
#include "suggest.h"

#include <algorithm>
#include <numeric>

namespace deltasplat {
namespace {

std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
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
        const std::size_t distance = editDistance(text, word);
        if (distance >= best) continue;
        best = distance;
        found = word;
    }
    return found.empty() ? "" : " Did you mean '" + found + "'?";
}

}  // namespace deltasplat
