// SPDX-License-Identifier: Apache-2.0
#include "ingest/rescale.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "ingest/raw_load.h"
#include "memory.h"
#include "parallel.h"

namespace deltasplat {
namespace {

template <typename From, typename To>
void rescaleRun(const std::byte* from, std::size_t count, bool swap, const Rescale& rescale,
                std::byte* to) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto stored = double(loadValue<From>(from + i * sizeof(From), swap));
        const auto value = To(rescale.slope * stored + rescale.intercept);
        std::memcpy(to + i * sizeof(To), &value, sizeof(To));
    }
}

}  // namespace

RawType rescaledType(RawType type) {
    return rawTypeBytes(type) <= 2 || type == RawType::kFloat32 ? RawType::kFloat32
                                                                : RawType::kFloat64;
}

void rescaleValues(const std::byte* from, std::size_t count, RawType type, bool bigEndian,
                   const Rescale& rescale, RawType toType, std::byte* to) {
    constexpr std::size_t kRun = std::size_t{1} << 16;
    parallelFor((count + kRun - 1) / kRun, [&](std::size_t run) {
        const std::size_t begin = run * kRun;
        const std::size_t length = std::min(kRun, count - begin);
        withRawType(type, [&](auto zero) {
            using From = decltype(zero);
            const std::byte* first = from + begin * sizeof(From);
            if (toType == RawType::kFloat32) {
                rescaleRun<From, float>(first, length, mustSwap(bigEndian), rescale,
                                        to + begin * sizeof(float));
            } else {
                rescaleRun<From, double>(first, length, mustSwap(bigEndian), rescale,
                                         to + begin * sizeof(double));
            }
        });
    });
}

DenseSource rescaled(DenseSource source, const Rescale& rescale) {
    if (rescale.isIdentity()) return source;
    DenseSource result = source;
    result.type = rescaledType(source.type);
    result.bigEndian = std::endian::native == std::endian::big;
    result.forEachLayer = [source = std::move(source), rescale, type = result.type](
                              const DenseSource::LayerUse& use, const Listener& listener) {
        const auto pixels = std::size_t(source.dims.x) * std::size_t(source.dims.y);
        const auto most =
            std::size_t(std::min<std::int64_t>(source.dims.z, DenseSource::kLayerSlices));
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
