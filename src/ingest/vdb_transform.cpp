// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb_transform.h"

#include <openvdb/math/Maps.h>

#include <memory>

namespace deltasplat {

openvdb::math::Transform::Ptr makeTransform(const glm::dmat4& worldFromIndex) {
    // OpenVDB multiplies row vectors: its rows are GLM's columns.
    openvdb::Mat4d matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column)
            matrix[row][column] = worldFromIndex[row][column];
    }
    const auto affine = std::make_shared<openvdb::math::AffineMap>(matrix);
    return std::make_shared<openvdb::math::Transform>(openvdb::math::simplify(affine));
}

glm::dmat4 matrixOf(const openvdb::math::Transform& transform) {
    const openvdb::Mat4d map = transform.baseMap()->getAffineMap()->getMat4();
    glm::dmat4 matrix(1.0);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column) matrix[row][column] = map[row][column];
    }
    return matrix;
}

namespace {

using openvdb::math::MapBase;

// A map of the type named, or null if this matrix is none of that type.
MapBase::Ptr mapOfType(const std::string& type, const openvdb::Mat4d& matrix) {
    using namespace openvdb::math;
    const openvdb::Vec3d scale(matrix[0][0], matrix[1][1], matrix[2][2]);
    const openvdb::Vec3d translation(matrix[3][0], matrix[3][1], matrix[3][2]);
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

openvdb::math::Transform::Ptr makeTransformOfType(const std::string& mapType,
                                                  const glm::dmat4& worldFromIndex) {
    const openvdb::Mat4d matrix = toOpenVdb(worldFromIndex);
    MapBase::Ptr map = mapOfType(mapType, matrix);
    if (!map || map->getAffineMap()->getMat4() != matrix)
        map = std::make_shared<openvdb::math::AffineMap>(matrix);
    return std::make_shared<openvdb::math::Transform>(map);
}

}  // namespace deltasplat
