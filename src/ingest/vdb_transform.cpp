// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb_transform.h"

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
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0));
    glm::dmat4 matrix(1.0);
    matrix[3] = {origin.x(), origin.y(), origin.z(), 1};
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d unit(0);
        unit[axis] = 1;
        const openvdb::Vec3d step = transform.indexToWorld(unit) - origin;
        matrix[axis] = {step.x(), step.y(), step.z(), 0};
    }
    return matrix;
}

}  // namespace deltasplat
