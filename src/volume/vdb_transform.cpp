// SPDX-License-Identifier: Apache-2.0
#include "volume/vdb_transform.h"

#include <openvdb/io/Archive.h>
#include <openvdb/math/Maps.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <sstream>

#include "base/text.h"
#include "deltasplat/error.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using namespace openvdb::math;

bool isScaleAndTranslation(const glm::dmat4& matrix) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 others = matrix[axis];
        others[axis] = 0;
        if (others != glm::dvec3(0)) return false;
    }
    return true;
}

MapBase::Ptr scaleMap(const glm::dvec3& scale, const glm::dvec3& origin) {
    const bool uniform = scale == glm::dvec3(scale.x);
    const Vec3d scales(scale.x, scale.y, scale.z);
    const Vec3d translation(origin.x, origin.y, origin.z);
    if (origin != glm::dvec3(0)) {
        if (uniform) return std::make_shared<UniformScaleTranslateMap>(scale.x, translation);
        return std::make_shared<ScaleTranslateMap>(scales, translation);
    }
    if (uniform) return std::make_shared<UniformScaleMap>(scale.x);
    return std::make_shared<ScaleMap>(scales);
}

MapBase::Ptr affineMap(const glm::dmat4& worldFromIndex) {
    // OpenVDB multiplies row vectors, so its rows are GLM's columns.
    Mat4d matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column)
            matrix[row][column] = worldFromIndex[row][column];
    }
    return std::make_shared<AffineMap>(matrix);
}

}  // namespace

namespace {

// Null if OpenVDB takes a voxel for flat.
MapBase::Ptr mapIfAny(const glm::dmat4& m) {
    try {
        return isScaleAndTranslation(m) ? scaleMap({m[0].x, m[1].y, m[2].z}, glm::dvec3(m[3]))
                                        : affineMap(m);
    } catch (const openvdb::ArithmeticError&) {
        return nullptr;
    }
}

}  // namespace

bool hasMap(const glm::dmat4& worldFromIndex) {
    return mapIfAny(worldFromIndex) != nullptr;
}

MapBase::Ptr makeMapIfAny(const glm::dmat4& worldFromIndex) {
    const MapBase::Ptr map = mapIfAny(worldFromIndex);
    return map ? map : std::make_shared<UniformScaleMap>(1);
}

MapBase::Ptr makeMap(const glm::dmat4& worldFromIndex) {
    const glm::dmat4& m = worldFromIndex;
    const MapBase::Ptr map = mapIfAny(m);
    if (map) return map;
    const glm::dvec3 size(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
    throw Error(ErrorCode::kFailed, "voxel size", numberText(size) + " without a unit of length",
                "a volume of at least 3e-15, as OpenVDB's grids have it (.nrrd has no "
                "such limit)");
}

// Transform's constructor rounds when it simplifies a map. Reading a map keeps its numbers.
Transform::Ptr transformOf(const MapBase& map) {
    openvdb::initialize();
    std::stringstream stream;
    openvdb::io::setCurrentVersion(stream);
    openvdb::writeString(stream, map.type());
    map.write(stream);
    auto transform = std::make_shared<Transform>();
    transform->read(stream);
    return transform;
}

namespace {

const std::map<openvdb::Name, MapBase::Ptr (*)()>& maps() {
    static const std::map<openvdb::Name, MapBase::Ptr (*)()> kMaps{
        {AffineMap::mapType(), AffineMap::create},
        {ScaleMap::mapType(), ScaleMap::create},
        {ScaleTranslateMap::mapType(), ScaleTranslateMap::create},
        {TranslationMap::mapType(), TranslationMap::create},
        {UniformScaleMap::mapType(), UniformScaleMap::create},
        {UniformScaleTranslateMap::mapType(), UniformScaleTranslateMap::create},
        {UnitaryMap::mapType(), UnitaryMap::create},
        {NonlinearFrustumMap::mapType(), NonlinearFrustumMap::create},
    };
    return kMaps;
}

}  // namespace

bool isMapType(const std::string& mapType) {
    return maps().contains(mapType);
}

MapBase::Ptr readMap(std::istream& stream) {
    const openvdb::Name type = openvdb::readString(stream);
    const auto found = maps().find(type);
    if (found == maps().end())
        OPENVDB_THROW(openvdb::KeyError, "Map " << type << " is not registered");
    if (type == NonlinearFrustumMap::mapType()) {
        // A frustum has another map, which it takes from the library, and reads older versions.
        openvdb::initialize();
        openvdb::io::setCurrentVersion(stream);
    }
    MapBase::Ptr map = found->second();
    map->read(stream);
    return map;
}

glm::dmat4 matrixOf(const MapBase& map) {
    const Mat4d affine = map.getAffineMap()->getMat4();
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) matrix[row][column] = affine[row][column];
    }
    return matrix;
}

glm::dmat4 worldFromIndexOf(const MapBase& map, const std::string& where) {
    const auto fail = [&](const std::string& got, const std::string& expected) {
        throw Error(ErrorCode::kInput, where, got, expected);
    };
    if (!map.isLinear()) {
        throw UnreadableGrid(where, "a " + map.type() + " transform", "a linear one (no frustum)");
    }
    glm::dmat4 matrix(0);
    try {
        matrix = matrixOf(map);
    } catch (const openvdb::ArithmeticError&) {
        // OpenVDB throws if a voxel's volume is below 3e-15.
    }
    bool finite = true;
    for (int axis = 0; axis < 4; ++axis) {
        finite = finite && std::isfinite(glm::dot(matrix[axis], matrix[axis]));
    }
    if (!finite || glm::determinant(matrix) == 0) {
        fail("a transform that cannot be inverted", "a finite affine map");
    }
    // A damaged file may hold any matrix, and OpenVDB does not check the last column.
    if (glm::dvec4(matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w) != glm::dvec4(0, 0, 0, 1)) {
        fail("a transform that is a projection", "a finite affine map");
    }
    return matrix;
}

namespace {

// Returns a map of the given type; its matrix may differ.
// @throw an exception of OpenVDB if the type cannot resemble the matrix
MapBase::Ptr mapOfType(const std::string& type, const glm::dmat4& matrix) {
    const Vec3d scale(matrix[0].x, matrix[1].y, matrix[2].z);
    const Vec3d translation(matrix[3].x, matrix[3].y, matrix[3].z);
    if (type == UniformScaleMap::mapType()) return std::make_shared<UniformScaleMap>(scale[0]);
    if (type == ScaleMap::mapType()) return std::make_shared<ScaleMap>(scale);
    if (type == TranslationMap::mapType()) return std::make_shared<TranslationMap>(translation);
    if (type == UniformScaleTranslateMap::mapType())
        return std::make_shared<UniformScaleTranslateMap>(scale[0], translation);
    if (type == ScaleTranslateMap::mapType())
        return std::make_shared<ScaleTranslateMap>(scale, translation);
    if (type == UnitaryMap::mapType())
        return std::make_shared<UnitaryMap>(affineMap(matrix)->getAffineMap()->getMat4());
    return type == AffineMap::mapType() ? affineMap(matrix) : makeMap(matrix);
}

}  // namespace

MapBase::Ptr makeMapOfType(const std::string& mapType, const glm::dmat4& worldFromIndex) {
    try {
        const MapBase::Ptr map = mapOfType(mapType, worldFromIndex);
        if (matrixOf(*map) == worldFromIndex) return map;
    } catch (const openvdb::ArithmeticError&) {
        // The matrix may need another type.
    }
    return makeMapIfAny(worldFromIndex);
}

}  // namespace deltasplat
