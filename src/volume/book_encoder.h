// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/source_values.h"

namespace deltasplat {

/// Measures how far codes are from values. Those of several threads come together in one meter;
/// the largest of all is the same in any order.
class ErrorMeter {
  public:
    /// @param bulkMagnitude  the least magnitude that differences are taken as a share of
    ErrorMeter(const CodeBook& book, double bulkMagnitude)
        : book_(book), bulkMagnitude_(bulkMagnitude) {}

    /// What one thread has found.
    class Part {
      public:
        explicit Part(const ErrorMeter& meter)
            : book_(meter.book_),
              table_(book_.table ? book_.table->data() : nullptr),
              bulkMagnitude_(meter.bulkMagnitude_) {}
        /// @param code  one that the book has
        void add(double value, Code code) {
            const double off = std::fabs(value - (table_ ? table_[code] : book_.valueOf(code)));
            found_.absolute = std::max(found_.absolute, off);
            const double magnitude = std::max(std::fabs(value), bulkMagnitude_);
            // Divisions take long, and hardly any is the largest.
            if (off <= found_.relative * magnitude * (1 - 0x1p-50)) return;
            if (off == 0) return;
            found_.relative = std::max(found_.relative, magnitude > 0 ? off / magnitude : 1);
        }

      private:
        friend ErrorMeter;
        const CodeBook& book_;
        const double* table_;  // null: it has none
        double bulkMagnitude_;
        CodeError found_;
    };

    void add(const Part& part) {
        raise(absolute_, part.found_.absolute);
        raise(relative_, part.found_.relative);
    }
    CodeError error() const { return {absolute_, relative_}; }

  private:
    static void raise(std::atomic<double>& most, double found) {
        double known = most;
        while (found > known && !most.compare_exchange_weak(known, found)) {
        }
    }

    const CodeBook& book_;
    double bulkMagnitude_;
    std::atomic<double> absolute_ = 0;
    std::atomic<double> relative_ = 0;
};

/// Turns many finite values into codes of one book, as CodeBook::codeOf does, but in a few
/// nanoseconds whatever the book. Half books: exact for halves, otherwise rounded by way of float.
class BookEncoder {
  public:
    explicit BookEncoder(const CodeBook& book);
    Code operator()(double value) const;

  private:
    Code tableCode(double value) const;
    Code nearestCode(double value) const;
    std::size_t firstNotBelow(double value) const;
    void makePlaces();
    void makeStretches();

    CodeBook book_;
    struct Entry {
        std::uint64_t bits;
        std::int32_t code;  // negative: nothing here
    };
    std::vector<Entry> places_;  // an open hash table of the book's table, where that is exact
    /// Where it is not: the codes whose values are in each of many stretches of the floats, up to
    /// the first of the next.
    struct Stretch {
        std::int32_t first;
        float codesPerUnit;
    };
    std::vector<Stretch> stretches_;
};

}  // namespace deltasplat
