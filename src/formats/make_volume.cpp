// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/make_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/dense/dense_source.h"
#include "formats/readers.h"
#include "volume/placement.h"
#include "volume/value_cast.h"

namespace deltasplat {
namespace {

constexpr const char* kWhere = "volume in memory";

[[noreturn]] void refuse(const std::string& what, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kUsage, std::string(kWhere) + ": " + what, got, expected);
}

template <typename T>
constexpr RawType rawTypeOf() {
    if constexpr (std::is_same_v<T, float>) return RawType::kFloat32;
    if constexpr (std::is_same_v<T, double>) return RawType::kFloat64;
    if constexpr (std::is_same_v<T, std::uint8_t>) return RawType::kUint8;
    if constexpr (std::is_same_v<T, std::int8_t>) return RawType::kInt8;
    if constexpr (std::is_same_v<T, std::uint16_t>) return RawType::kUint16;
    if constexpr (std::is_same_v<T, std::int16_t>) return RawType::kInt16;
    if constexpr (std::is_same_v<T, std::uint32_t>) return RawType::kUint32;
    if constexpr (std::is_same_v<T, std::int32_t>) return RawType::kInt32;
    if constexpr (std::is_same_v<T, std::uint64_t>) return RawType::kUint64;
    return RawType::kInt64;
}

std::string textOf(const glm::i64vec3& v, const char* separator) {
    return std::to_string(v.x) + separator + std::to_string(v.y) + separator + std::to_string(v.z);
}

void checkDims(const glm::i64vec3& dims) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    double voxels = 1;
    bool fits = true;
    for (int axis = 0; axis < 3; ++axis) {
        fits = fits && dims[axis] >= 1 && dims[axis] <= kMost;
        voxels *= double(dims[axis]);
    }
    if (fits && voxels < 0x1p60) return;
    refuse("dims", textOf(dims, "x"), "each from 1 to 2^30, fewer than 2^60 voxels together");
}

// Returns the strides, checked against the number of values.
glm::i64vec3 stridesOf(const MemoryLayout& layout, std::size_t values) {
    const glm::i64vec3& dims = layout.dims;
    if (!layout.strides) {
        const auto voxels = std::size_t(dims.x * dims.y * dims.z);
        if (values != voxels) {
            refuse("values", std::to_string(values),
                   std::to_string(voxels) + " (" + textOf(dims, "x") + ")");
        }
        return {1, dims.x, dims.x * dims.y};
    }
    const glm::i64vec3& strides = *layout.strides;
    double needed = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (strides[axis] < 1) refuse("strides", textOf(strides, ","), "each at least 1");
        needed += double(dims[axis] - 1) * double(strides[axis]);
    }
    if (double(values) < needed) {
        refuse("values", std::to_string(values),
               "at least " + numberText(needed) + " (" + textOf(dims, "x") + " with strides " +
                   textOf(strides, ",") + ")");
    }
    return strides;
}

void checkLayout(const MemoryLayout& layout) {
    checkDims(layout.dims);
    const glm::dmat4& matrix = layout.worldFromIndex;
    const bool isAffine =
        matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
    if (!isAffine || !givesPlaces(matrix)) {
        refuse("worldFromIndex", "a matrix that gives no place to voxels",
               "an affine one that can be inverted, lengths from 1e-15 to 1e15");
    }
    if (layout.background && std::isinf(*layout.background))
        refuse("background", numberText(*layout.background), "a finite number or NaN");
    if (layout.space != "" && layout.space != "RAS" && layout.space != "LPS")
        refuse("space", "\"" + layout.space + "\"", "RAS, LPS or nothing");
    if (lengthUnitNamed(layout.lengthUnit) != layout.lengthUnit)
        refuse("lengthUnit", "\"" + layout.lengthUnit + "\"", "km, m, mm, um, nm or nothing");
}

// A background that the integer type cannot hold would match no voxel.
template <typename T>
void checkBackground(const std::optional<double>& background) {
    if (!background || std::isnan(*background)) return;
    if (std::is_floating_point_v<T> || double(valueAs<T>(*background)) == *background) return;
    refuse("background", numberText(*background),
           std::string("a value of type ") + rawTypeName(rawTypeOf<T>()));
}

// Passes on layers of slices, in place if contiguous, else gathered.
template <typename T>
class LayerGiver {
  public:
    LayerGiver(std::span<const T> values, const glm::i64vec3& dims, const glm::i64vec3& strides)
        : values_(values), dims_(dims), strides_(strides) {}

    void operator()(const DenseSource::LayerUse& use, const Listener& listener) const {
        const bool contiguous = strides_ == glm::i64vec3(1, dims_.x, dims_.x * dims_.y);
        std::vector<T> gathered;
        if (!contiguous) {
            const auto layerSlices = std::min<std::int64_t>(DenseSource::kLayerSlices, dims_.z);
            requireMemory(kWhere, double(sizeof(T)) * double(dims_.x * dims_.y * layerSlices));
        }
        for (std::int64_t first = 0; first < dims_.z; first += DenseSource::kLayerSlices) {
            const std::int64_t slices =
                std::min<std::int64_t>(DenseSource::kLayerSlices, dims_.z - first);
            const T* layer = values_.data() + first * strides_.z;
            if (!contiguous) {
                gather(layer, slices, gathered);
                layer = gathered.data();
            }
            use(int(first), int(slices), reinterpret_cast<const std::byte*>(layer));
            listener.report(double(first + slices) / double(dims_.z));
        }
    }

  private:
    void gather(const T* layer, std::int64_t slices, std::vector<T>& gathered) const {
        gathered.resize(std::size_t(dims_.x * dims_.y * slices));
        T* out = gathered.data();
        for (std::int64_t z = 0; z < slices; ++z) {
            for (std::int64_t y = 0; y < dims_.y; ++y) {
                const T* row = layer + z * strides_.z + y * strides_.y;
                for (std::int64_t x = 0; x < dims_.x; ++x) *out++ = row[x * strides_.x];
            }
        }
    }

    std::span<const T> values_;
    glm::i64vec3 dims_;
    glm::i64vec3 strides_;
};

}  // namespace

template <typename T>
Volume makeVolume(std::span<const T> values, const MemoryLayout& layout, const ReadOptions& options,
                  const Listener& listener) {
    const DefaultFloats floats;
    requireFiniteNan(options);
    checkLayout(layout);
    checkBackground<T>(layout.background);
    const glm::i64vec3 strides = stridesOf(layout, values.size());
    DenseSource source;
    source.where = kWhere;
    source.name = layout.name;
    source.dims = layout.dims;
    source.type = rawTypeOf<T>();
    source.bigEndian = std::endian::native == std::endian::big;
    source.worldFromIndex = layout.worldFromIndex;
    source.space = layout.space;
    source.lengthUnit = layout.lengthUnit;
    source.forEachLayer = LayerGiver<T>(values, layout.dims, strides);
    return layout.background ? readSparse(source, *layout.background, options, listener)
                             : readDense(source, options, listener);
}

#define DELTASPLAT_MAKE_VOLUME(T)                                                              \
    template Volume makeVolume<T>(std::span<const T>, const MemoryLayout&, const ReadOptions&, \
                                  const Listener&);
DELTASPLAT_MAKE_VOLUME(std::uint8_t)
DELTASPLAT_MAKE_VOLUME(std::int8_t)
DELTASPLAT_MAKE_VOLUME(std::uint16_t)
DELTASPLAT_MAKE_VOLUME(std::int16_t)
DELTASPLAT_MAKE_VOLUME(std::uint32_t)
DELTASPLAT_MAKE_VOLUME(std::int32_t)
DELTASPLAT_MAKE_VOLUME(std::uint64_t)
DELTASPLAT_MAKE_VOLUME(std::int64_t)
DELTASPLAT_MAKE_VOLUME(float)
DELTASPLAT_MAKE_VOLUME(double)
#undef DELTASPLAT_MAKE_VOLUME

}  // namespace deltasplat
