// SPDX-License-Identifier: Apache-2.0
#include "ingest/raw/read_npy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>

#include "ingest/choose_volume.h"
#include "ingest/raw/npy_header.h"
#include "ingest/raw/raw_file.h"
#include "ingest/raw/raw_load.h"
#include "memory.h"

namespace deltasplat {
namespace {

// IEEE binary16: a sign, five bits of exponent, ten of fraction.
float floatOfHalf(std::uint16_t bits) {
    const int exponent = bits >> 10 & 0x1f;
    const int fraction = bits & 0x3ff;
    float size = std::ldexp(float(fraction + 0x400), exponent - 25);
    if (exponent == 0) size = std::ldexp(float(fraction), -24);
    if (exponent == 31) {
        size = fraction == 0 ? std::numeric_limits<float>::infinity()
                             : std::numeric_limits<float>::quiet_NaN();
    }
    return (bits & 0x8000) != 0 ? -size : size;
}

// Values that are stored as halves, as floats.
DenseSource fromHalves(DenseSource source) {
    DenseSource result = source;
    result.type = RawType::kFloat32;
    result.bigEndian = std::endian::native == std::endian::big;
    result.rows = nullptr;
    result.forEachLayer = [source = std::move(source)](const DenseSource::LayerUse& use,
                                                       const Listener& listener) {
        const std::size_t pixels = std::size_t(source.dims.x) * std::size_t(source.dims.y);
        const auto most = std::size_t(source.stepSlices());
        requireMemory(source.where, double(pixels) * double(most) * sizeof(float));
        const auto values = std::make_unique<float[]>(pixels * most);
        source.forEachLayer(
            [&](int first, int slices, const std::byte* stored) {
                for (std::size_t i = 0; i < pixels * std::size_t(slices); ++i) {
                    values[i] = floatOfHalf(
                        loadValue<std::uint16_t>(stored + 2 * i, mustSwap(source.bigEndian)));
                }
                use(first, slices, reinterpret_cast<const std::byte*>(values.get()));
            },
            listener);
    };
    return result;
}

}  // namespace

DenseSource openNpy(const std::filesystem::path& path, const ReadOptions& options) {
    const RawFormat& format = options.raw;
    const NpyHeader header = readNpyHeader(path);
    requireGeometry(format);
    RawFile file{path, header.layout, packingOf(path)};
    file.volumes = header.volumes;
    requireRawSize(file);
    file.volume =
        chooseVolume(path.string(), "shape " + header.shape, header.volumes, options.volume);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = glm::scale(glm::translate(glm::dmat4(1), format.origin),
                                       format.spacing.value_or(glm::dvec3(1)));
    return header.half ? fromHalves(std::move(source)) : source;
}

}  // namespace deltasplat
