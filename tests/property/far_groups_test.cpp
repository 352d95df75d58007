// SPDX-License-Identifier: Apache-2.0
// Voxels that lie far apart cost what they are, and look as they do alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "deltasplat/ground_shadow.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/openvdb_grid.h"
#include "deltasplat/picture.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/render_aovs.h"
#include "deltasplat/render_deep.h"
#include "deltasplat/slabs.h"
#include "support/same_picture.h"

namespace deltasplat {
namespace {

constexpr int kSide = 11;

// A blob of fog, at several places.
Volume blobsAt(const std::vector<glm::ivec3>& places, int tileAt = -1) {
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::mt19937 random(7);
        for (int n = 0; n < kSide * kSide * kSide; ++n) {
            const glm::ivec3 at =
                places[i] + glm::ivec3(n % kSide, n / kSide % kSide, n / kSide / kSide);
            const float value = float(random() % 9) / 8;
            if (value > 0) grid->tree().setValue({at.x, at.y, at.z}, value);
        }
        // A tile of 8x8x8 voxels beside it.
        if (int(i) == tileAt) {
            const glm::ivec3 at = (places[i] & ~7) + glm::ivec3(16, 0, 0);
            grid->tree().addTile(1, {at.x, at.y, at.z}, 0.5f, true);
        }
    }
    return makeVolume(grid);
}

RenderOptions someOptions(Mode mode = Mode::kComposite) {
    RenderOptions options;
    options.mode = mode;
    options.optics.range = glm::dvec2(0, 1);
    options.optics.transferFunction.colors = {{0, {1, 0.2, 0.1}}, {1, {0.3, 0.9, 1}}};
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {1, 0.6, 0.5, 0}};
    options.camera.sizePixels = {64, 48};
    return options;
}

// Looks at a blob from near, in each projection.
std::vector<CameraOptions> closeUps(const glm::ivec3& place) {
    const glm::dvec3 middle = glm::dvec3(place) + 0.5 * (kSide - 1);
    std::vector<CameraOptions> cameras;
    for (const char* view : {"front", "left", "iso"}) {
        CameraOptions& camera = cameras.emplace_back();
        camera.view = view;
        camera.frameWidthWorld = 17;
        camera.targetWorld = middle;
        camera.sizePixels = {64, 48};
    }
    cameras.push_back(cameras.back());
    cameras.back().azimuthDegrees = 13;
    cameras.back().frameWidthWorld = 170;
    CameraOptions& eye = cameras.emplace_back();
    eye.projection = Projection::kPerspective;
    eye.eyeWorld = middle + glm::dvec3(14, 9, 21);
    eye.targetWorld = middle;
    eye.sizePixels = {64, 48};
    cameras.push_back(eye);
    cameras.back().eyeWorld = middle + glm::dvec3(1, 2, 3);  // from inside
    cameras.push_back(eye);
    cameras.back().projection = Projection::kLatlong;
    cameras.back().sizePixels = {64, 32};
    return cameras;
}

std::vector<glm::ivec3> farPlaces() {
    return {{30000, 31000, 29000},
            {-1000000, 3, 1100000},
            {1 << 20, 700, 0},
            {(1 << 30) - 64, -(1 << 29), (1 << 30) - 100}};
}

// Of all that is asked for memory.
class Limit {
  public:
    explicit Limit(double bytes) { setMemoryLimit(std::uint64_t(bytes)); }
    ~Limit() { setMemoryLimit(0); }
};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kLimit = 4e9;  // a sanitizer keeps what is freed, and shadows of it
#else
constexpr double kLimit = 300e6;
#endif

// Who sees all sides sees a dot of the other one as well.
void expectSame(const Image& picture, const Image& expected, const CameraOptions& camera) {
    const float ofDot = camera.projection == Projection::kLatlong ? 1e-4f : 0;
    ASSERT_EQ(picture.size, expected.size);
    int others = 0;
    float most = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        if (std::abs(picture.rgba[i] - expected.rgba[i]) <= ofDot) continue;
        ++others;
        most = std::max(most, std::abs(picture.rgba[i] - expected.rgba[i]));
    }
    EXPECT_EQ(others, 0) << camera.view << ' ' << int(camera.projection) << ": up to " << most;
}

TEST(FarGroups, lookAsTheyDoAlone) {
    const Limit limit(kLimit);
    for (const glm::ivec3& place : farPlaces()) {
        const Volume both = blobsAt({{2, 5, -3}, place}, 1);
        const Volume alone = blobsAt({place}, 0);
        for (const Mode mode :
             {Mode::kComposite, Mode::kXray, Mode::kMip, Mode::kMin, Mode::kAverage, Mode::kDrr}) {
            for (const CameraOptions& camera : closeUps(place)) {
                RenderOptions options = someOptions(mode);
                options.camera = camera;
                const Image picture = render(both, options).image;
                SCOPED_TRACE(modeName(mode) + std::to_string(place.x));
                expectSame(picture, render(alone, options).image, camera);
                EXPECT_TRUE(std::any_of(picture.rgba.begin(), picture.rgba.end(),
                                        [](float value) { return value != 0; }));
            }
        }
    }
}

TEST(FarGroups, ofAllKindsOfColours) {
    const Limit limit(kLimit);
    const glm::ivec3 place(-40000, 50000, 1 << 20);
    const Volume both = blobsAt({{2, 5, -3}, place});
    const Volume alone = blobsAt({place});
    const auto expectTheSame = [&](const RenderOptions& asked) {
        for (const CameraOptions& camera : closeUps(place)) {
            RenderOptions options = asked;
            options.camera = camera;
            expectSame(render(both, options).image, render(alone, options).image, camera);
        }
    };
    RenderOptions shaded = someOptions();
    shaded.optics.shading = Shading{0.1, 0.6, 0.3, 7, {Light{}}};
    expectTheSame(shaded);
    RenderOptions surface = someOptions();
    surface.optics.surface = Surface{0.5, glm::dvec3(1)};
    surface.optics.shading = Shading{0.1, 0.6, 0.3, 7, {Light{}}};
    expectTheSame(surface);
    RenderOptions divided = someOptions();
    divided.splat.between = 3;
    expectTheSame(divided);
    RenderOptions mip = someOptions(Mode::kMip);
    mip.mipColors = true;
    expectTheSame(mip);
}

// Seen along an axis that light goes along, so that it is read where it was added.
TEST(FarGroups, areLit) {
    const Limit limit(kLimit);
    const glm::ivec3 place(1 << 20, 50000, -70000);
    const Volume both = blobsAt({{2, 5, -3}, place});
    const Volume alone = blobsAt({place});
    RenderOptions options = someOptions();
    options.optics.scattering.emplace();
    options.optics.scattering->lights = {{LightFrame::kWorld, {0, -1, 0}, {1, 0.8, 0.3}, 3},
                                         {LightFrame::kWorld, {0.4, -1, 0.3}, {0.5, 0.8, 1}, 2}};
    for (const CameraOptions& camera : closeUps(place)) {
        options.camera = camera;
        const Image picture = render(both, options).image;
        const Image expected = render(alone, options).image;
        float most = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); ++i)
            most = std::max(most, std::abs(picture.rgba[i] - expected.rgba[i]));
        // A light's plane begins at another place.
        EXPECT_LT(most, 0.02f);
    }
    // A light beside one of them.
    options.optics.scattering->lights.front().positionWorld = glm::dvec3(place) + 40.0;
    options.optics.scattering->lights.front().strength = 1e4;
    options.optics.scattering->lights.resize(1);
    options.camera = closeUps(place)[2];
    EXPECT_EQ(render(both, options).image.rgba, render(alone, options).image.rgba);
}

// By a lamp as far from all as they are from each other: on planes of what is there alone.
TEST(FarGroups, areLitFromFarAway) {
    const Limit limit(kLimit);
    const glm::ivec3 place(50000, 3, -50000);
    RenderOptions options = someOptions();
    options.optics.scattering.emplace();
    options.optics.scattering->ambient = glm::dvec3(0);
    options.optics.scattering->lights = {{LightFrame::kWorld, {0, -1, 0}, {1e6, 8e5, 3e5}, 1e5}};
    Light& lamp = options.optics.scattering->lights.front();
    lamp.positionWorld = glm::dvec3(25000, 60000, -25000);
    options.camera = closeUps(place)[2];
    const Image picture = render(blobsAt({{2, 5, -3}, place}), options).image;
    const Image alone = render(blobsAt({place}), options).image;
    // As the same light from one direction shows it.
    const glm::dvec3 way = glm::dvec3(place) + 5.0 - *lamp.positionWorld;
    lamp.direction = way;
    lamp.strength /= glm::dot(way, way);
    lamp.positionWorld.reset();
    const Image expected = render(blobsAt({place}), options).image;
    float most = 0;
    for (std::size_t i = 0; i < expected.rgba.size(); ++i) {
        // The unit that colours are rounded to goes by all of them.
        EXPECT_NEAR(picture.rgba[i], alone.rgba[i], 1e-3f * alone.rgba[i] + 1e-5f);
        EXPECT_NEAR(picture.rgba[i], expected.rgba[i], 0.08f * expected.rgba[i] + 0.01f);
        if (i % 4 == 0) most = std::max(most, expected.rgba[i]);
    }
    EXPECT_GT(most, 0.5f);
}

// One that is in front of another one dims it, however far that is.
TEST(FarGroups, coverEachOther) {
    const Limit limit(kLimit);
    const glm::ivec3 behind(0, 0, -(1 << 29));
    const Volume both = blobsAt({behind, {0, 0, 1 << 20}});
    const auto pictureOf = [&](const Volume& volume, const char* view) {
        RenderOptions options = someOptions();
        options.camera = closeUps(behind)[0];
        options.camera.view = view;
        return render(volume, options).image;
    };
    for (const char* view : {"front", "back"}) {
        const Image picture = pictureOf(both, view);
        // From either side the same blob is before itself.
        const Image one = pictureOf(blobsAt({behind}), view);
        for (std::size_t i = 0; i < one.rgba.size(); ++i) {
            const float alpha = one.rgba[i | 3];
            EXPECT_NEAR(picture.rgba[i], one.rgba[i] + (1 - alpha) * one.rgba[i], 1e-6f);
        }
    }
}

TEST(FarGroups, shadeEachOther) {
    const Limit limit(kLimit);
    const glm::ivec3 low(3, 0, 5);
    const glm::ivec3 high(3, 1 << 20, 5);
    RenderOptions options = someOptions();
    options.optics.scattering.emplace();
    options.optics.scattering->ambient = glm::dvec3(0);
    options.optics.scattering->lights = {{LightFrame::kWorld, {0, -1, 0}, {1, 1, 1}, 3}};
    options.camera = closeUps(low)[0];
    const auto lightOf = [&](const Volume& volume) {
        const Image picture = render(volume, options).image;
        double sum = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) sum += picture.rgba[i];
        return sum;
    };
    const double alone = lightOf(blobsAt({low}));
    EXPECT_GT(alone, 10);
    EXPECT_LT(lightOf(blobsAt({low, high})), 0.7 * alone);
    // Light that comes from below, and light that passes by.
    options.optics.scattering->lights.front().direction = {0, 1, 0};
    EXPECT_NEAR(lightOf(blobsAt({low, high})), lightOf(blobsAt({low})), 1e-3 * alone);
    options.optics.scattering->lights.front().direction = {0.5, -1, 0};
    EXPECT_NEAR(lightOf(blobsAt({low, high})), lightOf(blobsAt({low})), 0.02 * alone);
    // From a lamp above it.
    const glm::ivec3 nearer(3, 40000, 5);
    Light& lamp = options.optics.scattering->lights.front();
    lamp.positionWorld = glm::dvec3(8, 40060, 10);
    lamp.color = glm::dvec3(1e6);
    lamp.strength = 1e4;
    const double shaded = lightOf(blobsAt({low, nearer}));
    const double free = lightOf(blobsAt({low}));
    EXPECT_GT(free, 10);
    EXPECT_LT(shaded, 0.7 * free);
}

TEST(FarGroups, areTheSameHoweverMade) {
    const glm::ivec3 place(50000, -60000, 30000);
    const Volume both = blobsAt({{2, 5, -3}, place});
    for (const CameraOptions& camera : closeUps(place)) {
        RenderOptions options = someOptions();
        options.camera = camera;
        test::expectTheSameHoweverItIsMade(both, options);
    }
}

TEST(FarGroups, inPartsAndLayersAndDeep) {
    const Limit limit(kLimit);
    const glm::ivec3 behind(0, 0, -(1 << 20));
    const auto both = std::make_shared<const Volume>(blobsAt({behind, {6, 4, 1 << 20}}));
    for (const CameraOptions& camera : {closeUps(behind)[0], closeUps(behind)[4]}) {
        RenderOptions options = someOptions();
        options.camera = camera;
        options.splat.mostJoined = 1;
        const RenderResult whole = render(*both, options);
        const PreparedScene scene({both, options.optics}, options.splat);
        const glm::ivec2 size = whole.camera.sizePixels;
        Picture parted(scene, whole.camera);
        Image half({size.x, size.y / 2});
        parted.show({{0, size.y / 2}, size}, half);
        EXPECT_TRUE(
            std::equal(half.rgba.begin(), half.rgba.end(), whole.image.pixel(0, size.y / 2)));

        const SlabPicture layered(scene, whole.camera);
        std::vector<SlabLayer> layers;
        for (int i = 0; i < layered.slabs(); ++i) layers.push_back(layered.render(i));
        Image folded(size);
        layered.fold(layers).show({{0, 0}, size}, folded);
        EXPECT_EQ(folded.rgba, whole.image.rgba);

        DeepImage deep;
        DeepOptions deepOptions;
        const RenderResult cut = renderDeep(*both, options, deepOptions, deep);
        for (std::size_t i = 0; i < whole.image.rgba.size(); ++i)
            EXPECT_NEAR(cut.image.rgba[i], whole.image.rgba[i], 1e-5f);
        // Depths grow, and reach from one to the other.
        float nearest = 1e30f, farthest = 0;
        for (const DeepRow& row : deep.rows) {
            for (const DeepSample& sample : row.samples) {
                nearest = std::min(nearest, sample.z);
                farthest = std::max(farthest, sample.zBack);
            }
        }
        if (camera.projection == Projection::kOrtho) {
            EXPECT_GT(farthest - nearest, 2e6f);
        }
    }
}

TEST(FarGroups, haveChannels) {
    const Limit limit(kLimit);
    const glm::ivec3 place(1 << 29, 1 << 28, -(1 << 29));
    const Volume both = blobsAt({{2, 5, -3}, place});
    RenderOptions options = someOptions();
    options.camera = closeUps(place)[0];
    const RenderResult result = render(both, options);
    const std::vector<ImageChannel> channels = renderAovs(
        both, options, result.camera, std::vector<Aov>{Aov::kPosition, Aov::kDepth}, AovOptions{});
    int seen = 0;
    for (const ImageChannel& channel : channels) {
        if (channel.name.rfind("P.", 0) != 0) continue;
        const int axis = channel.name.back() - 'X';
        for (std::size_t i = 0; i < channel.values.size(); ++i) {
            if (result.image.rgba[4 * i + 3] < 0.1f) continue;
            ++seen;
            // As near as a 32-bit float comes.
            EXPECT_NEAR(channel.values[i], place[axis] + 5.0, 70.0);
        }
    }
    EXPECT_GT(seen, 300);
}

TEST(FarGroups, throwShadowsOnTheGround) {
    const Limit limit(kLimit);
    const glm::ivec3 place(1 << 20, 0, -(1 << 20));
    RenderOptions options = someOptions();
    options.optics.scattering.emplace();
    options.optics.scattering->lights = {{LightFrame::kWorld, {0.3, -1, 0.2}, {1, 1, 1}, 3}};
    options.camera = closeUps(place)[2];
    options.camera.frameWidthWorld = 60;
    const auto shadowOf = [&](const Volume& volume) {
        const RenderResult result = render(volume, options);
        return renderGroundShadow(volume, options, result.camera,
                                  {{glm::dvec3(place) - glm::dvec3(0, 3, 0)}, {0, 1, 0}});
    };
    const Image shadow = shadowOf(blobsAt({{0, 0, 0}, place}));
    EXPECT_EQ(shadow.rgba, shadowOf(blobsAt({place})).rgba);
    EXPECT_GT(*std::max_element(shadow.rgba.begin(), shadow.rgba.end()), 0.5f);
}

// A frame of all shows no more than dots, and what would show more is said.
TEST(FarGroups, areDotsInAFrameOfAll) {
    const Limit limit(kLimit);
    for (const glm::ivec3& place : farPlaces()) {
        const Volume both = blobsAt({{0, 0, 0}, place});
        for (const Mode mode :
             {Mode::kComposite, Mode::kMip, Mode::kMin, Mode::kAverage, Mode::kXray}) {
            for (const Projection projection :
                 {Projection::kOrtho, Projection::kPerspective, Projection::kLatlong}) {
                RenderOptions options = someOptions(mode);
                options.camera.view = "iso";
                options.camera.projection = projection;
                options.camera.sizePixels = {64, 32};
                std::string said;
                render(both, options, {{}, [&](const std::string& text) { said += text + "\n"; }});
                EXPECT_NE(said.find("no more than dots"), std::string::npos) << said;
                EXPECT_EQ(said.find("picture: empty"), std::string::npos) << said;
                EXPECT_EQ(said.find("`frameWidthWorld`") != std::string::npos,
                          projection == Projection::kOrtho)
                    << said;
                EXPECT_NE(said.find("50 % of the voxels lie in 0:10,0:10,0:10"), std::string::npos)
                    << said;
            }
        }
    }
}

// A picture of all groups that the transfer function hides says so.
TEST(FarGroups, mayAllBeHidden) {
    const Volume both = blobsAt({{0, 0, 0}, {1 << 20, 300, 20}});
    RenderOptions options = someOptions();
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {1, 0, 0.5, 0}};
    options.camera.sizePixels = {64, 32};
    std::string said;
    render(both, options, {{}, [&](const std::string& text) { said += text + "\n"; }});
    EXPECT_NE(said.find("show none of the values"), std::string::npos) << said;
}

// A stray voxel does not change how a cloud is drawn.
TEST(FarGroups, areManyAndFew) {
    const Limit limit(kLimit);
    std::vector<glm::ivec3> places{{0, 0, 0}};
    std::mt19937 random(3);
    for (int i = 0; i < 60; ++i)
        places.push_back({int(random() % 2000000), int(random() % 2000000), 4000 * i + 400000});
    const Volume many = blobsAt(places);
    const Volume alone = blobsAt({places[0]});
    for (const CameraOptions& camera : closeUps(places[0])) {
        if (camera.projection != Projection::kOrtho) continue;
        RenderOptions options = someOptions();
        options.camera = camera;
        EXPECT_EQ(render(many, options).image.rgba, render(alone, options).image.rgba);
    }
}

}  // namespace
}  // namespace deltasplat
