// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/threads.h"

namespace deltasplat {

/// Counts how often each code occurs. Counts are large: there is one for each worker, that is, for
/// what goes on at the same time, not for each piece of work.
class CodeCounts {
  public:
    /// @param workers  at least one
    explicit CodeCounts(std::size_t workers) : counts_(workers) {}
    CodeCounts() : CodeCounts(std::size_t(std::max(1, threadCount()))) {}

    std::size_t workers() const { return counts_.size(); }
    /// One call at a time for each worker.
    void add(std::size_t worker, std::span<const Code> codes) {
        std::vector<std::uint64_t>& counts = countsOf(worker);
        for (const Code code : codes) ++counts[code];
    }
    void add(std::size_t worker, Code code, std::uint64_t times) {
        countsOf(worker)[code] += times;
    }
    /// Returns the sums, [kCodeCount], and leaves none.
    std::vector<std::uint64_t> take() {
        std::vector<std::uint64_t> sum = std::move(countsOf(0));
        for (std::size_t worker = 1; worker < counts_.size(); ++worker) {
            const std::vector<std::uint64_t>& counts = counts_[worker];
            for (std::size_t code = 0; code < counts.size(); ++code) sum[code] += counts[code];
        }
        counts_.clear();
        return sum;
    }

  private:
    // Made by who fills it, where it is wanted.
    std::vector<std::uint64_t>& countsOf(std::size_t worker) {
        if (counts_[worker].empty()) counts_[worker].resize(kCodeCount);
        return counts_[worker];
    }

    std::vector<std::vector<std::uint64_t>> counts_;
};

}  // namespace deltasplat
