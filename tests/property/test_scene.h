// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "deltasplat/render.h"
#include "reference/reference_renderer.h"

namespace deltasplat::test {

/// A dense volume of data values 0..255 as a test makes it; 0 is empty.
struct TestVolume {
    glm::ivec3 first{0};  ///< index of the first voxel, may be negative
    glm::ivec3 dims{1};
    std::vector<float> values;  ///< [z][y][x]
    glm::dmat4 worldFromIndex{1.0};

    TestVolume(const glm::ivec3& firstIndex, const glm::ivec3& size);
    float& at(const glm::ivec3& index);
    glm::dvec3 world(const glm::dvec3& index) const;
};

glm::dmat4 spaced(const glm::dvec3& spacing, const glm::dvec3& origin = glm::dvec3(0));

/// Writes the volume to a .vdb file (values other than 0 are active) and reads it by the library.
Volume throughVdb(const TestVolume& volume);
/// Writes bytes to a .raw file and reads it by the library; the transform must be `spaced`, and the
/// first index 0.
Volume throughRaw(const TestVolume& volume, const glm::dvec3& spacing);

/// Opacity rises from 0 at value 0 to `opacity` at 255; colour goes from green to red.
TransferFunction testTransferFunction(double opacity);
/// The same voxels for the reference, by formulas of its own.
reference::Volume referenceVolume(const TestVolume& volume, double opacity, double unitDistance);

/// A camera by plain vectors, told to both renderers alike.
struct TestView {
    glm::dvec3 direction{0, 0, -1};
    glm::dvec3 up{0, 1, 0};
    glm::dvec3 target{0};
    double pixelWorld = 1;
    glm::ivec2 size{64, 64};

    CameraOptions options() const;
    reference::View view() const;
};

/// Peak signal-to-noise ratio over all channels, in dB, of a peak of 1.
double psnr(const Image& image, const reference::Picture& picture);

}  // namespace deltasplat::test
