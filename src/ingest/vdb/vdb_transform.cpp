// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vdb_transform.h"

#include <openvdb/io/Archive.h>
#include <openvdb/math/Maps.h>
#include <openvdb/openvdb.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <sstream>

#include "deltasplat/error.h"
#include "number_text.h"

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
    // OpenVDB multiplies row vectors: its rows are GLM's columns.
    Mat4d matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column)
            matrix[row][column] = worldFromIndex[row][column];
    }
    return std::make_shared<AffineMap>(matrix);
}

}  // namespace

// Transform's constructor takes near numbers for equal and rounds when it simplifies a map. Reading
// one leaves it as it is.
Transform::Ptr makeTransform(const glm::dmat4& worldFromIndex) {
    const glm::dmat4& m = worldFromIndex;
    openvdb::initialize();
    MapBase::Ptr map;
    try {
        map = isScaleAndTranslation(m) ? scaleMap({m[0].x, m[1].y, m[2].z}, glm::dvec3(m[3]))
                                       : affineMap(m);
    } catch (const openvdb::ArithmeticError&) {
        const glm::dvec3 size(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
        throw Error(ErrorCode::kFailed,
                    gotExpected("voxel size", numberText(size),
                                "a volume of at least 3e-15, as .vdb has it (other units?)"));
    }
    std::stringstream stream;
    openvdb::io::setCurrentVersion(stream);
    openvdb::writeString(stream, map->type());
    map->write(stream);
    auto transform = std::make_shared<Transform>();
    transform->read(stream);
    return transform;
}

glm::dmat4 matrixOf(const Transform& transform) {
    const Mat4d affine = transform.baseMap()->getAffineMap()->getMat4();
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) matrix[row][column] = affine[row][column];
    }
    return matrix;
}

namespace {

// A map of the type named, or null if there is none of that type.
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
    return nullptr;
}

}  // namespace

Transform::Ptr makeTransformOfType(const std::string& mapType, const glm::dmat4& worldFromIndex) {
    const MapBase::Ptr affine = affineMap(worldFromIndex);
    MapBase::Ptr map = mapOfType(mapType, worldFromIndex);
    if (!map || map->getAffineMap()->getMat4() != affine->getAffineMap()->getMat4()) map = affine;
    return std::make_shared<Transform>(map);
}

}  // namespace deltasplat
