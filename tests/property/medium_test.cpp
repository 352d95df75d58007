// SPDX-License-Identifier: Apache-2.0
// Media of several grids: fire in smoke, colours of grids, against closed forms and a plain march.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "support/changed_volume.h"
#include "support/error_of.h"
#include "support/same_picture.h"
#include "support/sight_line.h"
#include "support/some_scene.h"

namespace deltasplat {
namespace {

using test::errorOf;
using test::sightLineOf;

using Field = std::function<double(const glm::dvec3& world)>;

// A grid of values; what is NaN is not active.
Volume gridOf(const glm::ivec3& dims, const glm::dmat4& worldFromIndex, const Field& valueAt) {
    std::vector<float> values;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const glm::dvec3 world(worldFromIndex * glm::dvec4(x, y, z, 1));
                values.push_back(float(valueAt(world)));
            }
        }
    }
    MemoryLayout layout;
    layout.dims = dims;
    layout.worldFromIndex = worldFromIndex;
    layout.background = std::numeric_limits<double>::quiet_NaN();
    Volume volume = makeVolume<float>(values, layout);
    test::changed(volume)->background = 0;
    return volume;
}

std::shared_ptr<const Volume> shared(Volume volume) {
    return std::make_shared<const Volume>(std::move(volume));
}

glm::dmat4 placed(double voxel, const glm::dvec3& first) {
    glm::dmat4 world(voxel);
    world[3] = glm::dvec4(first, 1);
    return world;
}

// Values are opacities over a unit of the world.
TransferFunction ramp(const glm::dvec3& color) {
    TransferFunction function;
    function.colors = {{0, color}};
    function.linearColors = true;
    function.opacities = {{0, 0, 0.5, 0}, {1, 1, 0.5, 0}};
    return function;
}

Optics smokeOptics(const glm::dvec3& color = glm::dvec3(0.5, 0.4, 0.3)) {
    Optics optics;
    optics.transferFunction = ramp(color);
    optics.unitDistance = 1;
    return optics;
}

MediumPart fireOf(std::shared_ptr<const Volume> volume, const glm::dvec3& color,
                  double strength = 1) {
    MediumPart part;
    part.volume = std::move(volume);
    part.kind = MediumPart::Kind::kEmission;
    part.transferFunction = ramp(color);
    part.strength = strength;
    return part;
}

RenderResult renderFrom(const Volume& volume, const Optics& optics, const CameraOptions& camera) {
    RenderOptions options;
    options.optics = optics;
    options.camera = camera;
    return render(volume, options);
}

glm::dvec4 middleOf(const RenderResult& result) {
    const Image& image = result.image;
    const float* rgba = image.pixel(image.size.x / 2, image.size.y / 2);
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

CameraOptions straight() {
    CameraOptions camera;
    camera.direction = glm::dvec3(0, 0, -1);
    camera.up = glm::dvec3(0, 1, 0);
    camera.sizePixels = {24, 24};
    return camera;
}

double opacityOf(double extinction) {
    return -std::expm1(-extinction);
}

TEST(Medium, glowOfASlabIsDimmedByIt) {
    // 16 world units thick.
    const auto world = placed(0.5, {0, 0, 0.25});
    const auto constant = [](double value) { return [=](const glm::dvec3&) { return value; }; };
    for (const double extinction : {0.01, 0.3, 3.0}) {
        const Volume smoke = gridOf(glm::ivec3(32), world, constant(opacityOf(extinction)));
        Optics optics = smokeOptics(glm::dvec3(0));
        optics.parts = {
            fireOf(shared(gridOf(glm::ivec3(32), world, constant(0.5))), {8, 2, 0.1}, 3)};
        const glm::dvec4 pixel = middleOf(renderFrom(smoke, optics, straight()));
        const double length = opacityOf(16 * extinction) / extinction;
        for (int c = 0; c < 3; ++c) {
            const double glow = 3 * 0.5 * glm::dvec3(8, 2, 0.1)[c];
            EXPECT_NEAR(pixel[c] / (glow * length), 1, 1e-3) << extinction;
        }
        EXPECT_NEAR(pixel.a, opacityOf(16 * extinction), 1e-3);
    }
}

TEST(Medium, glowWhereNothingElseIs) {
    const auto world = placed(0.5, {0, 0, 0.25});
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    // Smoke below, fire on both sides of its end.
    const Volume smoke =
        gridOf(glm::ivec3(32), world, [&](const glm::dvec3& p) { return p.y < 6 ? 0.1 : nothing; });
    const auto fire = shared(gridOf(glm::ivec3(32), world, [&](const glm::dvec3& p) {
        return p.y > 3 && p.y < 13 ? 0.5 : nothing;
    }));
    Optics optics = smokeOptics();
    optics.parts = {fireOf(fire, {2, 1, 0.5})};
    CameraOptions camera = straight();
    camera.targetWorld = glm::dvec3(8, 10, 8);
    const glm::dvec4 pixel = middleOf(renderFrom(smoke, optics, camera));
    EXPECT_NEAR(pixel.r, 16, 0.02);
    EXPECT_NEAR(pixel.b, 4, 0.005);
    EXPECT_EQ(pixel.a, 0);
    // It is within the picture that nobody framed.
    const RenderResult whole = renderFrom(smoke, optics, straight());
    const Camera& framed = whole.camera;
    EXPECT_NEAR(framed.targetWorld.y, 0.5 * (0 + 12.5), 0.3);
}

TEST(Medium, ofNothingButFire) {
    const auto world = placed(1, {0, 0, 0});
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const Volume smoke = gridOf(glm::ivec3(16), world, [&](const glm::dvec3&) { return nothing; });
    ASSERT_TRUE(smoke.empty());
    Optics optics = smokeOptics();
    optics.parts = {fireOf(
        shared(gridOf(glm::ivec3(16), world, [](const glm::dvec3&) { return 1.0; })), {1, 1, 1})};
    EXPECT_NEAR(middleOf(renderFrom(smoke, optics, straight())).g, 16, 0.02);
}

// Density and temperature of a smooth plume.
double densityAt(const glm::dvec3& p) {
    return 0.25 * std::exp(-glm::dot(p - glm::dvec3(0, 4, 0), p - glm::dvec3(0, 4, 0)) / 60);
}
double heatAt(const glm::dvec3& p) {
    return std::exp(-glm::dot(p + glm::dvec3(1, 5, 2), p + glm::dvec3(1, 5, 2)) / 40);
}

constexpr glm::dvec3 kSmokeColor(0.2, 0.3, 0.4);
constexpr glm::dvec3 kFireColor(3, 1, 0.2);

glm::dvec4 marched(const test::SightLine& line, double otherExtinction) {
    constexpr double kStep = 0.02;
    glm::dvec3 sum(0);
    double depth = 0;
    for (double t = kStep / 2; t < 120; t += kStep) {
        const glm::dvec3 p = line.start + t * line.ray;
        const double own = densityAt(p);
        const double other = otherExtinction * heatAt(p);
        const double left = std::exp(-depth - (own + other) * kStep / 2);
        sum +=
            left * kStep *
            (own * kSmokeColor + (otherExtinction > 0 ? other : opacityOf(heatAt(p))) * kFireColor);
        depth += (own + other) * kStep;
    }
    return {sum, opacityOf(depth)};
}

double psnrOf(const RenderResult& result, double otherExtinction) {
    double squares = 0;
    double most = 0;
    int count = 0;
    for (int y = 0; y < result.image.size.y; y += 3) {
        for (int x = 0; x < result.image.size.x; x += 3) {
            const auto line = sightLineOf(result.camera, glm::dvec2(x + 0.5, y + 0.5), 50);
            const glm::dvec4 expected = marched(line, otherExtinction);
            for (int c = 0; c < 4; ++c) {
                const double off = result.image.pixel(x, y)[c] - expected[c];
                squares += off * off;
                ++count;
            }
            most = std::max({most, expected.r, expected.g, expected.b});
        }
    }
    EXPECT_GT(most, 0.5);
    return 20 * std::log10(most / std::sqrt(squares / count));
}

std::vector<CameraOptions> plumeCameras() {
    std::vector<CameraOptions> cameras(3);
    for (CameraOptions& camera : cameras) {
        camera.direction = glm::dvec3(-0.4, -0.5, -1);
        camera.targetWorld = glm::dvec3(0);
        camera.sizePixels = {45, 45};
        camera.frameWidthWorld = 30;
    }
    cameras[1].frameWidthWorld.reset();
    cameras[1].projection = Projection::kPerspective;
    cameras[1].fovDegrees = 40;
    cameras[1].distanceWorld = 45;
    cameras[2].direction = glm::dvec3(0, 0, -1);
    return cameras;
}

Volume plumeSmoke() {
    return gridOf(glm::ivec3(80), placed(0.5, glm::dvec3(-19.75)),
                  [](const glm::dvec3& p) { return opacityOf(densityAt(p)); });
}

TEST(Medium, ofAPlumeIsThePlainMarch) {
    const Volume smoke = plumeSmoke();
    const auto fire = shared(gridOf(glm::ivec3(80), placed(0.5, glm::dvec3(-19.75)),
                                    [](const glm::dvec3& p) { return opacityOf(heatAt(p)); }));
    Optics optics = smokeOptics(kSmokeColor);
    for (const CameraOptions& camera : plumeCameras()) {
        optics.parts = {fireOf(fire, kFireColor)};
        EXPECT_GT(psnrOf(renderFrom(smoke, optics, camera), 0), 45);
        // The same grid as something that swallows light.
        optics.parts[0].kind = MediumPart::Kind::kAbsorption;
        EXPECT_GT(psnrOf(renderFrom(smoke, optics, camera), 1), 45);
    }
}

TEST(Medium, readsGridsThatLieOtherwise) {
    const Volume smoke = plumeSmoke();
    Optics optics = smokeOptics(kSmokeColor);
    const auto heat = [](const glm::dvec3& p) { return opacityOf(heatAt(p)); };
    glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3));
    turned = turned * placed(0.8, glm::dvec3(-24));
    const std::vector<std::shared_ptr<const Volume>> fires = {
        // Coarser, moved, turned, finer, moved by whole voxels.
        shared(gridOf(glm::ivec3(30), placed(1.4, glm::dvec3(-20.1, -19, -20.7)), heat)),
        shared(gridOf(glm::ivec3(80), placed(0.5, glm::dvec3(-19.9, -19.65, -19.8)), heat)),
        shared(gridOf(glm::ivec3(60), turned, heat)),
        shared(gridOf(glm::ivec3(160), placed(0.22, glm::dvec3(-18)), heat)),
        shared(gridOf(glm::ivec3(70), placed(0.5, glm::dvec3(-17.25, -18.25, -16.75)), heat)),
    };
    for (const auto& fire : fires) {
        optics.parts = {fireOf(fire, kFireColor)};
        EXPECT_GT(psnrOf(renderFrom(smoke, optics, plumeCameras()[0]), 0), 40);
    }
}

// Two grids of one fog each are the fog of both.
TEST(Medium, extinctionsAddUp) {
    const auto world = placed(1, {0, 0, 0});
    const auto thin = [](const glm::dvec3& p) { return opacityOf(0.02 + 0.001 * p.x); };
    const auto thick = [](const glm::dvec3& p) { return opacityOf(0.04 + 0.002 * p.x); };
    const Volume one = gridOf(glm::ivec3(20), world, thin);
    const Volume both = gridOf(glm::ivec3(20), world, thick);
    Optics optics = smokeOptics();
    const RenderResult expected = renderFrom(both, optics, straight());
    MediumPart part;
    part.volume = shared(one);
    part.kind = MediumPart::Kind::kAbsorption;
    part.transferFunction = optics.transferFunction;
    optics.parts = {part};
    const RenderResult result = renderFrom(one, optics, straight());
    double most = 0;
    for (std::size_t i = 0; i < expected.image.rgba.size(); ++i)
        most = std::max<double>(most, std::abs(result.image.rgba[i] - expected.image.rgba[i]));
    EXPECT_LT(most, 2e-4);
    EXPECT_GT(middleOf(expected).a, 0.5);
}

TEST(Medium, colorsOfGridsAreThoseOfTheFunction) {
    const auto world = placed(1, {0, 0, 0});
    const Volume fog =
        gridOf(glm::ivec3(20), world, [](const glm::dvec3& p) { return 0.01 + 0.002 * p.y; });
    const glm::dvec3 color(0.5, 1.75, 0.2);
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    ColorGrids grids;
    for (std::size_t c = 0; c < 3; ++c) {
        grids[c] = shared(gridOf(glm::ivec3(20), world, [&](const glm::dvec3& p) {
            return p.x > 9.5 ? nothing : color[int(c)];
        }));
    }
    Optics optics = smokeOptics(glm::dvec3(0.5));
    optics.colorGrids = grids;
    const RenderResult result = renderFrom(fog, optics, straight());
    optics.colorGrids.reset();
    const RenderResult plain = renderFrom(fog, optics, straight());
    const auto& rgba = result.image.rgba;
    int coloured = 0;
    for (int y = 2; y < 22; ++y) {
        for (int x = 2; x < 22; ++x) {
            if (x > 9 && x < 14) continue;  // where both meet
            const glm::dvec3 factor = x < 12 ? color : glm::dvec3(1);
            for (int c = 0; c < 3; ++c) {
                const float expected = float(plain.image.pixel(x, y)[c] * factor[c]);
                EXPECT_NEAR(result.image.pixel(x, y)[c], expected, 3e-3 * expected) << x << c;
            }
            EXPECT_EQ(result.image.pixel(x, y)[3], plain.image.pixel(x, y)[3]);
            ++coloured;
        }
    }
    EXPECT_GT(coloured, 200);
    EXPECT_EQ(rgba.size(), plain.image.rgba.size());
}

// What is beside the brightest is as exact as it was.
TEST(Medium, fireDoesNotSpoilSmoke) {
    const auto world = placed(1, {0, 0, 0});
    const Volume fog =
        gridOf(glm::ivec3(24), world, [](const glm::dvec3& p) { return 1e-4 * (1 + p.x); });
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const auto fire = shared(gridOf(glm::ivec3(24), world, [&](const glm::dvec3& p) {
        return p.y < 2.5 && p.x < 2.5 ? 1 : nothing;
    }));
    Optics optics = smokeOptics();
    const RenderResult plain = renderFrom(fog, optics, straight());
    optics.parts = {fireOf(fire, {1, 1, 1}, 1e5)};
    const RenderResult lit = renderFrom(fog, optics, straight());
    EXPECT_GT(lit.image.pixel(1, 22)[0], 1e6);
    for (int x = 8; x < 22; ++x) {
        const float* expected = plain.image.pixel(x, 5);
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(lit.image.pixel(x, 5)[c], expected[c], 1e-3 * expected[c]) << x;
    }
}

// Warm things that nobody sees are left out, whatever the grid says of them.
TEST(Medium, warmAirDoesNotGlow) {
    const auto world = placed(1, {0, 0, 0});
    const auto heat = shared(gridOf(glm::ivec3(64), world, [](const glm::dvec3& p) {
        const glm::dvec3 away = glm::abs(p - 32.0);
        return std::max({away.x, away.y, away.z}) < 4.5 ? 1800.0 : 300.0;
    }));
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const Volume smoke = gridOf(glm::ivec3(64), world, [&](const glm::dvec3& p) {
        return glm::distance(p, glm::dvec3(32)) < 8 ? 1e-6 : nothing;
    });
    Optics optics = smokeOptics();
    MediumPart part;
    part.volume = heat;
    optics.parts = {part};
    const PreparedScene scene({shared(smoke), optics}, {});
    EXPECT_LT(scene.scene().volume->box().dims().x, 18);
    const RenderResult result = renderFrom(smoke, optics, straight());
    // sigma T^4 / pi in megawatts, over nine voxels.
    const double radiance = 5.670374e-14 / M_PI * std::pow(1800.0, 4);
    const glm::dvec4 pixel = middleOf(result);
    EXPECT_NEAR(0.2126 * pixel.r + 0.7152 * pixel.g + 0.0722 * pixel.b, 9 * radiance,
                1e-3 * radiance);
}

// Bit for bit: whatever the method, on however many threads, at every SIMD level.
TEST(Medium, isTheSameHoweverItIsMade) {
    const auto volume = test::someVolume();
    RenderOptions options;
    options.optics = test::someOptics(test::Colors::kFire);
    options.optics.scattering.reset();
    options.optics.colorGrids = ColorGrids{volume, volume, volume};
    MediumPart veil = options.optics.parts[0];
    veil.kind = MediumPart::Kind::kAbsorption;
    veil.transferFunction = options.optics.transferFunction;
    for (const bool isVeiled : {false, true}) {
        if (isVeiled) {
            options.optics.colorGrids.reset();
            options.optics.parts.push_back(veil);
        }
        for (const CameraOptions& camera : test::someCameras()) {
            options.camera = camera;
            test::expectTheSameHoweverItIsMade(*volume, options);
        }
    }
}

TEST(Medium, isRefusedWhereItCannotBe) {
    const Volume fog =
        gridOf(glm::ivec3(4), placed(1, {0, 0, 0}), [](const glm::dvec3&) { return 0.5; });
    const auto errorWith = [&](const std::function<void(Optics&)>& change) {
        Optics optics = smokeOptics();
        optics.parts = {fireOf(shared(fog), {1, 1, 1})};
        change(optics);
        return errorOf([&] { renderFrom(fog, optics, straight()); });
    };
    EXPECT_EQ(errorWith([](Optics& o) { o.shading.emplace(); }).substr(0, 37),
              "usage: `parts`: got `shading` besides");
    EXPECT_NE(errorWith([](Optics& o) { o.parts[0].strength = -1; }).find("strength"),
              std::string::npos);
    EXPECT_NE(errorWith([](Optics& o) { o.parts[0].volume.reset(); }).find("without a volume"),
              std::string::npos);
    EXPECT_NE(errorWith([](Optics& o) { o.parts.resize(4, o.parts[0]); }).find("at most 3"),
              std::string::npos);
    EXPECT_NE(errorWith([](Optics& o) {
                  o.scattering.emplace();
                  o.parts[0].kind = MediumPart::Kind::kAbsorption;
              }).find("swallows light"),
              std::string::npos);
    EXPECT_NE(errorWith([](Optics& o) { o.parts[0].range = glm::dvec2(2, 2); }).find("LO < HI"),
              std::string::npos);
    EXPECT_NE(errorWith([](Optics& o) {
                  o.parts[0].kind = MediumPart::Kind::kBlackbody;
                  o.parts[0].kelvinScale = std::nan("");
              }).find("kelvin"),
              std::string::npos);
}

}  // namespace
}  // namespace deltasplat
