// SPDX-License-Identifier: Apache-2.0
#include "formats/raw/raw_values.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/parallel.h"
#include "formats/raw/raw_format.h"
#include "formats/raw/raw_kernels.h"
#include "volume/code_math.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

template <typename T>
RawScan scanRun(const std::byte* bytes, std::size_t count, bool swap, bool distinct) {
    RawScan scan;
    if (!distinct) scan.census.distinct.giveUp();
    // Neighbours are often equal.
    std::optional<T> last;
    std::uint64_t repeats = 0;
    const auto endRepeats = [&] {
        if (repeats == 0) return;
        scan.census.repeat(double(*last), repeats);
        scan.frequent.add(double(*last), repeats);
        repeats = 0;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const T value = loadValue<T>(bytes + i * sizeof(T), swap);
        if (last && haveSameBits(value, *last)) {
            ++repeats;
            continue;
        }
        if constexpr (std::is_floating_point_v<T>) {
            if (!std::isfinite(value)) {
                if (scan.nonFinite++ == 0) scan.firstNonFinite = i;
                continue;
            }
        }
        endRepeats();
        last = value;
        scan.census.add(value);
        scan.frequent.add(double(value));
    }
    endRepeats();
    return scan;
}

template <typename T>
double finiteOr(T value, double replacement) {
    const auto number = double(value);
    if constexpr (std::is_floating_point_v<T>) return std::isfinite(number) ? number : replacement;
    return number;
}

// The code of an integer book: the low 16 bits suffice.
template <typename T>
struct IntegerCoder {
    Code offset;
    explicit IntegerCoder(const RawCoding& coding)
        : offset(Code(std::uint64_t(std::int64_t(coding.book.offset)))) {}
    Code operator()(T value) const { return Code(Code(value) - offset); }
};

template <typename T>
struct LinearCoder {
    double offset, step, nanValue;
    explicit LinearCoder(const RawCoding& coding)
        : offset(coding.book.offset), step(coding.book.step), nanValue(coding.nanValue) {}
    Code operator()(T value) const { return linearCode(finiteOr(value, nanValue), offset, step); }
};

template <typename T>
struct BookCoder {
    const BookEncoder& encoder;
    double nanValue;
    // Neighbours are often equal.
    mutable double last = 0;
    mutable Code code;
    explicit BookCoder(const RawCoding& coding)
        : encoder(coding.encoder), nanValue(coding.nanValue), code(encoder(last)) {}
    Code operator()(T value) const {
        const double number = finiteOr(value, nanValue);
        if (haveSameBits(number, last)) return code;
        last = number;
        return code = encoder(number);
    }
};

template <typename T, bool kSwap, typename Coder>
inline void encodeBox(const RawBlock& block, const glm::ivec3& size, const Coder& coder,
                      decltype(coder(T{}))* codes) {
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y) {
            const std::byte* row = block.first + z * block.sliceBytes + y * block.rowBytes;
            auto* column = codes + y * 8 + z;
            for (int x = 0; x < size.x; ++x) {
                column[x * 64] = coder(loadValue<T>(row + x * sizeof(T), kSwap));
            }
        }
    }
}

template <typename T, bool kSwap>
void measure(const RawBlock& block, const RawCoding& coding, const Code* codes) {
    ErrorMeter::Part part(*coding.meter);
    for (int z = 0; z < block.size.z; ++z) {
        for (int y = 0; y < block.size.y; ++y) {
            const std::byte* row = block.first + z * block.sliceBytes + y * block.rowBytes;
            const Code* column = codes + y * 8 + z;
            for (int x = 0; x < block.size.x; ++x) {
                const T value = loadValue<T>(row + x * sizeof(T), kSwap);
                part.add(finiteOr(value, coding.nanValue), column[x * 64]);
            }
        }
    }
    coding.meter->add(part);
}

template <typename T, bool kSwap, template <typename> typename Coder>
void encode(const RawBlock& block, const RawCoding& coding, Code* codes) {
    const Coder<T> coder(coding);
    // Nearly all blocks are whole.
    if (block.size == glm::ivec3(8)) {
        if constexpr (std::is_same_v<Coder<T>, IntegerCoder<T>> && sizeof(T) <= 2 && !kSwap) {
            encodeWholeBlock(block, coding.type, coder.offset, codes);
        } else {
            // Constant loop lengths let the compiler unroll.
            encodeBox<T, kSwap>(block, {8, 8, 8}, coder, codes);
        }
    } else {
        encodeBox<T, kSwap>(block, block.size, coder, codes);
    }
    if (coding.meter) measure<T, kSwap>(block, coding, codes);
}

template <typename T, template <typename> typename Coder>
EncodeBlock encoderFor(bool swap) {
    return swap && sizeof(T) > 1 ? &encode<T, (sizeof(T) > 1), Coder> : &encode<T, false, Coder>;
}

}  // namespace

void RawScan::append(const RawScan& next) {
    if (nonFinite == 0) firstNonFinite = census.count + next.firstNonFinite;
    nonFinite += next.nonFinite;
    census.append(next.census);
    frequent.append(next.frequent);
}

RawScan scanRawValues(const std::byte* bytes, std::size_t count, RawType type, bool bigEndian,
                      bool distinct) {
    constexpr std::size_t kRun = std::size_t{1} << 18;
    std::vector<RawScan> runs((count + kRun - 1) / kRun);
    const bool swap = mustSwap(bigEndian);
    parallelFor(runs.size(), [&](std::size_t i) {
        const std::size_t begin = i * kRun;
        const std::size_t length = std::min(kRun, count - begin);
        runs[i] = withRawType(type, [&](auto zero) {
            using T = decltype(zero);
            return scanRun<T>(bytes + begin * sizeof(T), length, swap, distinct);
        });
    });

    RawScan whole;
    for (const RawScan& run : runs) whole.append(run);
    return whole;
}

EncodeBlock blockEncoder(const RawCoding& coding) {
    const bool swap = mustSwap(coding.bigEndian);
    return withRawType(coding.type, [&](auto zero) -> EncodeBlock {
        using T = decltype(zero);
        switch (coding.book.kind) {
            case CodeBook::Kind::kLinear:
                return encoderFor<T, LinearCoder>(swap);
            case CodeBook::Kind::kInteger:
                if constexpr (std::is_integral_v<T>) return encoderFor<T, IntegerCoder>(swap);
                return encoderFor<T, LinearCoder>(swap);
            default:
                return encoderFor<T, BookCoder>(swap);
        }
    });
}

std::vector<std::uint64_t> countEqual(const std::byte* bytes, std::size_t count,
                                      const RawCoding& coding, const std::vector<double>& values) {
    std::vector<std::uint64_t> counts(values.size());
    if (values.empty()) return counts;
    constexpr std::size_t kRun = std::size_t{1} << 18;
    std::vector<std::vector<std::uint64_t>> runs((count + kRun - 1) / kRun, counts);
    const bool swap = mustSwap(coding.bigEndian);
    parallelFor(runs.size(), [&](std::size_t run) {
        withRawType(coding.type, [&](auto zero) {
            using T = decltype(zero);
            const std::size_t end = std::min((run + 1) * kRun, count);
            for (std::size_t i = run * kRun; i < end; ++i) {
                const T value = loadValue<T>(bytes + i * sizeof(T), swap);
                const double number = finiteOr(value, coding.nanValue);
                for (std::size_t k = 0; k < values.size(); ++k)
                    runs[run][k] += number == values[k] ? 1 : 0;
            }
        });
    });
    for (const std::vector<std::uint64_t>& run : runs) {
        for (std::size_t k = 0; k < counts.size(); ++k) counts[k] += run[k];
    }
    return counts;
}

template <typename Out>
void readValues(const RawBlock& block, RawType type, bool bigEndian, std::optional<Out> nanValue,
                Out* values) {
    const bool swap = mustSwap(bigEndian);
    withRawType(type, [&](auto zero) {
        using T = decltype(zero);
        const auto convert = [&](T value) {
            if constexpr (std::is_floating_point_v<T>) {
                if (nanValue && !std::isfinite(value)) return *nanValue;
            }
            return Out(value);
        };
        if (swap) {
            encodeBox<T, true>(block, block.size, convert, values);
        } else {
            encodeBox<T, false>(block, block.size, convert, values);
        }
    });
}

template void readValues(const RawBlock&, RawType, bool, std::optional<float>, float*);
template void readValues(const RawBlock&, RawType, bool, std::optional<double>, double*);
template void readValues(const RawBlock&, RawType, bool, std::optional<std::int32_t>,
                         std::int32_t*);
template void readValues(const RawBlock&, RawType, bool, std::optional<std::int64_t>,
                         std::int64_t*);

}  // namespace deltasplat
