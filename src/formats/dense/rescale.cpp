// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/rescale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

namespace {

constexpr std::size_t kRun = 4096;

template <typename From>
void rescaleRun(const std::byte* from, std::size_t count, bool swap, const Rescale& rescale,
                double* to) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto stored = double(loadValue<From>(from + i * sizeof(From), swap));
        to[i] = rescale.slope * stored + rescale.intercept;
    }
}

template <typename To>
void storeRun(const double* from, std::size_t count, std::byte* to) {
    for (std::size_t i = 0; i < count; ++i) {
        double number = from[i];
        if constexpr (std::is_integral_v<To>) {
            // 64-bit limits are no doubles: take the largest double below.
            constexpr auto kLow = double(std::numeric_limits<To>::min());
            const double high =
                std::min(double(std::numeric_limits<To>::max()),
                         std::nextafter(std::ldexp(1, std::numeric_limits<To>::digits), 0));
            number = number > kLow ? std::min(number, high) : kLow;
        }
        const auto value = To(number);
        std::memcpy(to + i * sizeof(To), &value, sizeof(To));
    }
}

}  // namespace

RawType rescaledType(RawType type) {
    return rawTypeBytes(type) <= 2 || type == RawType::kFloat32 ? RawType::kFloat32
                                                                : RawType::kFloat64;
}

std::optional<RawType> rescaledWholeType(double least, double most, const Rescale& rescale) {
    const auto isWhole = [](double number) { return number == std::floor(number); };
    if (!isWhole(rescale.slope) || !isWhole(rescale.intercept)) return std::nullopt;
    const double a = rescale.slope * least + rescale.intercept;
    const double b = rescale.slope * most + rescale.intercept;
    const double low = std::min(a, b);
    const double high = std::max(a, b);
    if (low >= -0x1p15 && high < 0x1p15) return RawType::kInt16;
    if (low >= 0 && high < 0x1p16) return RawType::kUint16;
    if (low >= -0x1p31 && high < 0x1p31) return RawType::kInt32;
    return std::nullopt;
}

void rescaleValues(const std::byte* from, std::size_t count, RawType type, bool bigEndian,
                   const Rescale& rescale, RawType toType, std::byte* to) {
    parallelFor((count + kRun - 1) / kRun, [&](std::size_t run) {
        const std::size_t begin = run * kRun;
        const std::size_t length = std::min(kRun, count - begin);
        std::array<double, kRun> values;
        withRawType(type, [&](auto zero) {
            using From = decltype(zero);
            rescaleRun<From>(from + begin * sizeof(From), length, mustSwap(bigEndian), rescale,
                             values.data());
        });
        withRawType(toType, [&](auto zero) {
            using To = decltype(zero);
            storeRun<To>(values.data(), length, to + begin * sizeof(To));
        });
    });
}

DenseSource rescaled(DenseSource source, const Rescale& rescale, std::optional<RawType> type) {
    if (rescale.isIdentity()) return source;
    DenseSource result = source;
    result.type = type.value_or(rescaledType(source.type));
    result.bigEndian = std::endian::native == std::endian::big;
    result.rows = nullptr;
    result.forEachLayer = [source = std::move(source), rescale, type = result.type](
                              const DenseSource::LayerUse& use, const Listener& listener) {
        const auto pixels = std::size_t(source.dims.x) * std::size_t(source.dims.y);
        const auto most = std::size_t(source.stepSlices());
        const std::size_t bytes = pixels * most * std::size_t(rawTypeBytes(type));
        requireMemory(source.where, double(bytes));
        const auto values = std::make_unique_for_overwrite<std::byte[]>(bytes);
        source.forEachLayer(
            [&](int first, int slices, const std::byte* stored) {
                rescaleValues(stored, pixels * std::size_t(slices), source.type, source.bigEndian,
                              rescale, type, values.get());
                use(first, slices, values.get());
            },
            listener);
    };
    return result;
}

}  // namespace deltasplat
