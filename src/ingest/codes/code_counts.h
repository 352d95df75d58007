// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/threads.h"
#include "parallel.h"

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
        std::vector<Count>& counts = countsOf(worker);
        std::size_t i = 0;
        for (; i + 2 <= codes.size(); i += 2) {
            ++counts[codes[i]].even;
            ++counts[codes[i + 1]].odd;
        }
        if (i < codes.size()) ++counts[codes[i]].even;
    }
    void add(std::size_t worker, Code code, std::uint64_t times) {
        countsOf(worker)[code].even += times;
    }
    /// Returns the sums, [kCodeCount], and leaves none.
    std::vector<std::uint64_t> take() {
        std::vector<std::uint64_t> sum(kCodeCount);
        std::erase_if(counts_, [](const std::vector<Count>& counts) { return counts.empty(); });
        constexpr std::size_t kPart = 4096;
        static_assert(kCodeCount % kPart == 0);
        parallelFor(kCodeCount / kPart, [&](std::size_t part) {
            for (const std::vector<Count>& counts : counts_) {
                for (std::size_t code = part * kPart; code < (part + 1) * kPart; ++code)
                    sum[code] += counts[code].even + counts[code].odd;
            }
        });
        counts_.clear();
        return sum;
    }

  private:
    // Neighbours are often alike, and who adds to what was just written waits for it.
    struct Count {
        std::uint64_t even = 0;
        std::uint64_t odd = 0;
    };

    // Made by who fills it, where it is wanted.
    std::vector<Count>& countsOf(std::size_t worker) {
        if (counts_[worker].empty()) counts_[worker].resize(kCodeCount);
        return counts_[worker];
    }

    std::vector<std::vector<Count>> counts_;
};

}  // namespace deltasplat
