// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "deltasplat/render.h"
#include "property/test_scene.h"
#include "support/make_volume.h"

namespace deltasplat::test {

// One direction for each slice axis and sign, straight ones, a diagonal.
inline const glm::dvec3 kDirections[] = {
    {1, 0.3, -0.5}, {-1, 0.7, 0.2}, {0.4, 1, 0.6}, {-0.1, -1, 0.8}, {0.5, -0.45, 1}, {0.9, 0.2, -1},
    {1, 0, 0},      {0, -1, 0},     {0, 0, 1},     {1, 1, 1},       {0, 0.5, -1}};

inline TestView viewOf(const Volume& volume, const glm::dvec3& direction) {
    TestView view;
    view.direction = direction;
    view.up = {0.1, 1, 0.2};
    if (glm::length(glm::cross(direction, view.up)) < 0.3) view.up = {0, 0, 1};
    const glm::dvec3 middle = 0.5 * glm::dvec3(volume.box().min + volume.box().max);
    view.target = glm::dvec3(volume.worldFromIndex() * glm::dvec4(middle, 1));
    view.size = {70, 60};
    view.pixelWorld =
        0.55 * std::min({volume.voxelSize().x, volume.voxelSize().y, volume.voxelSize().z});
    return view;
}

inline RenderOptions optionsOf(Mode mode, const TestView& view) {
    RenderOptions options;
    options.mode = mode;
    options.camera = view.options();
    return options;
}

}  // namespace deltasplat::test
