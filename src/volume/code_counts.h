// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/threads.h"
#include "volume/code_kernels.h"
#include "volume/code_tree.h"

namespace deltasplat {

/// Counts how often each code occurs. One table per worker, because tables are large.
class CodeCounts {
  public:
    explicit CodeCounts(std::size_t workers) : counts_(workers) {}
    CodeCounts() : CodeCounts(std::size_t(std::max(1, threadCount()))) {}

    std::size_t workers() const { return counts_.size(); }
    /// Allows one call at a time per worker.
    void add(std::size_t worker, std::span<const Code> codes) { addEach(worker, codes); }
    /// Adds codes that all lie in lowest .. highest.
    template <typename T>
    void add(std::size_t worker, std::span<const T> codes, Code lowest, Code highest) {
        if (lowest == highest) return add(worker, lowest, codes.size());
        FewCounts few;
        const std::size_t numbers = countFewCodes(codes, lowest, highest, few);
        if (numbers == 0) return addEach(worker, codes);
        Counts& counts = countsOf(worker, codes.size());
        for (std::size_t n = 0; n < numbers; ++n) counts.few[lowest + n][0] += few[n];
    }
    /// Adds the voxels of a block that lie inside of the volume, and returns their range of codes.
    /// @param codes  in leaf order
    std::pair<Code, Code> addBlock(std::size_t worker, const glm::ivec3& size,
                                   std::span<const Code, 512> codes) {
        const auto addSome = [&](std::span<const Code> some) {
            const auto range = rangeOfCodes(some);
            add(worker, some, range.first, range.second);
            return range;
        };
        if (size == glm::ivec3(8)) return addSome(codes);
        std::pair<Code, Code> all{codes[0], codes[0]};
        for (int x = 0; x < size.x; ++x) {
            for (int y = 0; y < size.y; ++y) {
                const int place = 64 * x + 8 * y;
                const auto [low, high] =
                    addSome(codes.subspan(std::size_t(place), std::size_t(size.z)));
                all = {std::min(all.first, low), std::max(all.second, high)};
            }
        }
        return all;
    }
    void add(std::size_t worker, Code code, std::uint64_t times) {
        constexpr std::uint64_t kFew = 1 << 20;
        Counts& counts = countsOf(worker, times <= kFew ? times : 0);
        if (times <= kFew) {
            counts.few[code][0] += std::uint32_t(times);
        } else {
            if (counts.many.empty()) counts.many.resize(kCodeCount);
            counts.many[code] += times;
        }
    }
    /// Returns the sums, [kCodeCount], and clears the counts.
    std::vector<std::uint64_t> take() {
        std::vector<std::uint64_t> sum(kCodeCount);
        std::erase_if(counts_, [](const Counts& counts) { return counts.few.empty(); });
        constexpr std::size_t kPart = 4096;
        static_assert(kCodeCount % kPart == 0);
        parallelFor(kCodeCount / kPart, [&](std::size_t part) {
            for (const Counts& counts : counts_) {
                for (std::size_t code = part * kPart; code < (part + 1) * kPart; ++code)
                    sum[code] += counts.of(code);
            }
        });
        counts_.clear();
        return sum;
    }

  private:
    // Neighbours are often equal. Several lanes avoid adding to a number that was just written.
    static constexpr std::size_t kLanes = 4;
    // Aligned so that workers do not write to the same cache line.
    struct alignas(64) Counts {
        std::vector<std::array<std::uint32_t, kLanes>> few;  // [kCodeCount]
        std::uint64_t inFew = 0;                             // sum of `few`
        std::vector<std::uint64_t> many;                     // [kCodeCount], or empty

        std::uint64_t of(std::size_t code) const {
            std::uint64_t sum = many.empty() ? 0 : many[code];
            for (const std::uint32_t lane : few[code]) sum += lane;
            return sum;
        }
        // Moves `few` into `many` before a 32-bit lane overflows.
        void takeOver() {
            std::vector<std::uint64_t> all(kCodeCount);
            for (std::size_t code = 0; code < all.size(); ++code) all[code] = of(code);
            many = std::move(all);
            few.assign(kCodeCount, {});
            inFew = 0;
        }
    };

    template <typename T>
    void addEach(std::size_t worker, std::span<const T> codes) {
        Counts& counts = countsOf(worker, codes.size());
        for (; codes.size() >= kLanes; codes = codes.subspan(kLanes))
            for (std::size_t lane = 0; lane < kLanes; ++lane) ++counts.few[codes[lane]][lane];
        for (const T code : codes) ++counts.few[code][0];
    }

    // Each worker allocates its own counts on first use.
    Counts& countsOf(std::size_t worker, std::size_t codes) {
        Counts& counts = counts_[worker];
        if (counts.few.empty()) counts.few.resize(kCodeCount);
        counts.inFew += codes;
        if (counts.inFew > std::numeric_limits<std::uint32_t>::max()) {
            counts.takeOver();
            counts.inFew = codes;
        }
        return counts;
    }

    std::vector<Counts> counts_;
};

/// Counts the active voxels per code, [65536]. Multi-threaded.
std::vector<std::uint64_t> histogramOf(const CodeTree::Tree& tree);

/// Returns the histogram before any cut, so that cutting does not change colours.
inline std::vector<std::uint64_t> uncutHistogram(const Volume& volume) {
    return volume.uncut() ? histogramOf(volume.uncut()->tree()) : volume.histogram();
}

/// Returns the box of the active voxels, whose indices must fit into 32 bits.
IndexBox activeBox(const CodeTree::Tree& tree);

}  // namespace deltasplat
