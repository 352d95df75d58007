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

/// Measures the largest distance between values and their codes. Threads collect parts of their
/// own, and the order in which the meter adds them does not matter.
class ErrorMeter {
  public:
    /// @param bulkMagnitude  relative errors are shares of at least this magnitude
    ErrorMeter(const CodeBook& book, double bulkMagnitude)
        : book_(book), bulkMagnitude_(bulkMagnitude) {}

    class Part {
      public:
        explicit Part(const ErrorMeter& meter)
            : book_(meter.book_),
              table_(book_.table ? book_.table->data() : nullptr),
              bulkMagnitude_(meter.bulkMagnitude_) {}
        /// @param code  a code of the book
        void add(double value, Code code) {
            const double off = std::fabs(value - (table_ ? table_[code] : book_.valueOf(code)));
            found_.absolute = std::max(found_.absolute, off);
            const double magnitude = std::max(std::fabs(value), bulkMagnitude_);
            // Divisions are slow, and hardly any error is the largest so far.
            if (off <= found_.relative * magnitude * (1 - 0x1p-50)) return;
            if (off == 0) return;
            found_.relative = std::max(found_.relative, magnitude > 0 ? off / magnitude : 1);
        }

      private:
        friend ErrorMeter;
        const CodeBook& book_;
        const double* table_;  // null: the book has no table
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

/// Turns finite values into codes of one book, like CodeBook::codeOf but in a few nanoseconds for
/// any kind of book. Half books are exact for halves; other values are rounded through float.
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
        std::int32_t code;  // negative: empty entry
    };
    std::vector<Entry> places_;  // hash table of an exact book's table, open addressing
    /// Stretches of the floats, for an inexact table. A stretch's codes end where the next begins.
    struct Stretch {
        std::int32_t first;
        float codesPerUnit;
    };
    std::vector<Stretch> stretches_;
};

}  // namespace deltasplat
