// SPDX-License-Identifier: Apache-2.0
// Pictures of seeded random volumes against a renderer that shares no code with the library.
#include "reference/reference_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <ostream>
#include <random>

#include "deltasplat/render.h"
#include "property/test_scene.h"

namespace deltasplat::test {
namespace {

constexpr double kOpacity = 0.5;
constexpr double kLeastDecibels = 60;

struct Case {
    const char* name;
    glm::ivec3 first, dims;
    glm::dmat4 worldFromIndex;
    bool rough;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

// A general affine map: turned, sheared, uneven and far from the origin.
glm::dmat4 sheared() {
    glm::dmat4 matrix(1);
    matrix[0] = {0.8, 0.3, -0.1, 0};
    matrix[1] = {-0.2, 1.1, 0.25, 0};
    matrix[2] = {0.15, -0.3, 0.9, 0};
    matrix[3] = {100, -50, 25, 1};
    return matrix;
}

const Case kCases[] = {
    {"smoothUnit", {0, 0, 0}, {5, 13, 9}, spaced({1, 1, 1}), false},
    {"roughUnit", {-7, -11, -5}, {17, 8, 11}, spaced({1, 1, 1}), true},
    {"smoothFlat", {3, -4, -9}, {17, 8, 11}, spaced({1, 1, 4}), false},
    {"roughTall", {-20, 5, 0}, {5, 13, 9}, spaced({0.1, 0.2, 0.1}, {3, 2, 1}), true},
    {"smoothLarge", {-12, -12, -12}, {24, 24, 24}, spaced({7, 7, 7}), false},
    {"roughLarge", {100, -30, 7}, {24, 24, 24}, spaced({1, 1, 1}), true},
    {"smoothSheared", {-3, -3, -3}, {13, 9, 11}, sheared(), false},
};

// One direction for each slice axis and sign, in index space, none of them straight.
const glm::dvec3 kDirections[] = {{1, 0.3, -0.5},  {-1, 0.7, 0.2},  {0.4, 1, 0.6},
                                  {-0.1, -1, 0.8}, {0.5, -0.45, 1}, {0.9, 0.2, -1}};

// Smooth: a sum of waves that fades to nothing. Rough: two voxels in five are random, the rest
// empty.
TestVolume makeVolume(const Case& c) {
    std::mt19937 random(17);
    TestVolume volume(c.first, c.dims);
    volume.worldFromIndex = c.worldFromIndex;
    const glm::dvec3 middle = 0.5 * glm::dvec3(c.dims - 1);
    float* value = volume.values.data();
    for (int z = 0; z < c.dims.z; ++z) {
        for (int y = 0; y < c.dims.y; ++y) {
            for (int x = 0; x < c.dims.x; ++x, ++value) {
                const glm::dvec3 p = (glm::dvec3(x, y, z) - middle) / (middle + 1.0);
                const double wave = 0.5 + 0.5 * std::sin(4 * p.x + 3 * p.y * p.z + 2 * p.y);
                const double smooth = 255 * wave * std::max(0.0, 1 - glm::dot(p, p));
                const double noise = random() % 5 < 2 ? 1 + random() % 255 : 0;
                *value = float(std::floor(c.rough ? noise : smooth));
            }
        }
    }
    return volume;
}

// Sees `volume` along an index direction with square pixels finer than the raster of `resolution`
// samples a voxel, so that no filter needs widening.
TestView fineView(const TestVolume& volume, const glm::dvec3& directionIndex, int resolution,
                  glm::ivec2 size) {
    const glm::dmat3 linear(volume.worldFromIndex);
    TestView view;
    view.direction = linear * directionIndex;
    view.up = glm::dvec3(0.2, 1, 0.3);
    if (std::abs(directionIndex.y) == 1) view.up = glm::dvec3(1, 0.1, 0.2);
    view.target = volume.world(glm::dvec3(volume.first) + 0.5 * glm::dvec3(volume.dims - 1));
    view.size = size;

    // The fastest that any index coordinate, slid along the ray, moves with the screen.
    const reference::View plain = view.view();
    const glm::dmat3 inverse = glm::inverse(linear);
    double fastest = 0;
    for (const reference::Vector& v : {plain.right, plain.up}) {
        const glm::dvec3 moved = inverse * glm::dvec3(v[0], v[1], v[2]);
        fastest = std::max(fastest, 2 * glm::length(moved));
    }
    view.pixelWorld = 1 / (1.5 * fastest * resolution);
    return view;
}

double unitDistance(const TestVolume& volume) {
    const glm::dmat3 linear(volume.worldFromIndex);
    return std::min({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
}

RenderResult renderTest(const Volume& volume, const TestView& view, double sigma, int resolution) {
    RenderOptions options;
    options.camera = view.options();
    options.optics.transferFunction = testTransferFunction(kOpacity);
    options.splat.sigma = sigma;
    options.splat.resolution = resolution;
    return render(volume, options);
}

// A picture that shows nothing would prove nothing.
double meanAlpha(const reference::Picture& picture) {
    double sum = 0;
    for (const reference::Rgba& pixel : picture) sum += pixel[3];
    return sum / double(picture.size());
}

class Reference : public ::testing::TestWithParam<Case> {};

TEST_P(Reference, fineRastersTendToTheContinuousPicture) {
    const TestVolume volume = makeVolume(GetParam());
    const Volume read = throughVdb(volume);
    const reference::Volume voxels = referenceVolume(volume, kOpacity, unitDistance(volume));
    for (std::size_t i = 0; i < std::size(kDirections); ++i) {
        SCOPED_TRACE(i);
        TestView view = fineView(volume, kDirections[i], 8, {48, 40});
        // Every other view looks at a corner of the volume.
        if (i % 2 == 1)
            view.target = volume.world(glm::dvec3(volume.first) + 0.25 * glm::dvec3(volume.dims));
        const RenderResult result = renderTest(read, view, 0.8, 8);
        const auto expected = reference::renderContinuous(voxels, view.view(), 0.8);
        EXPECT_GE(psnr(result.image, expected), kLeastDecibels);
        EXPECT_GT(meanAlpha(expected), 0.02);
        EXPECT_EQ(result.stats.sliceAxis, int(i) / 2);
    }
}

TEST_P(Reference, coarseRastersGiveThePicturePredictedForThem) {
    const TestVolume volume = makeVolume(GetParam());
    const Volume read = throughVdb(volume);
    const reference::Volume voxels = referenceVolume(volume, kOpacity, unitDistance(volume));
    for (std::size_t i = 0; i < std::size(kDirections); ++i) {
        for (const int resolution : {1, 2}) {
            SCOPED_TRACE(std::to_string(i) + ", resolution " + std::to_string(resolution));
            const TestView view =
                fineView(volume, kDirections[i], resolution, resolution * glm::ivec2(80, 60));
            const RenderResult result = renderTest(read, view, 0.4, resolution);
            const auto expected = reference::renderSampled(voxels, view.view(), 0.4, resolution);
            EXPECT_GE(psnr(result.image, expected), kLeastDecibels);
            EXPECT_GT(meanAlpha(expected), 0.02);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Reference, ::testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace deltasplat::test
