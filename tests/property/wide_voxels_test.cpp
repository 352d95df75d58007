// SPDX-License-Identifier: Apache-2.0
// Voxels that hang together over a wide box cost what they are, and look as they do in one piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "deltasplat/memory_limit.h"
#include "deltasplat/openvdb_grid.h"
#include "deltasplat/picture.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "support/memory_beyond.h"

namespace deltasplat {
namespace {

// Where voxels of a shape of some size lie.
using Shape = std::function<std::vector<glm::ivec3>(int size)>;

std::vector<glm::ivec3> wire(int size) {
    std::vector<glm::ivec3> places;
    for (int i = 0; i < size; ++i) places.push_back({i, i, i});
    return places;
}

std::vector<glm::ivec3> corner(int size) {
    std::vector<glm::ivec3> places;
    for (int i = 0; i < size; ++i) places.insert(places.end(), {{i, 0, 0}, {0, i, 0}, {0, 0, i}});
    return places;
}

// Tilted, so that no axis has it in one slice.
std::vector<glm::ivec3> ring(int size) {
    std::vector<glm::ivec3> places;
    for (int i = 0; i < 4 * size; ++i) {
        const double angle = 1.5707963267948966 * i / size;
        const double x = 0.5 * size * std::cos(angle);
        const double y = 0.5 * size * std::sin(angle);
        places.push_back(
            {int(std::lround(x)), int(std::lround(0.8 * y)), int(std::lround(0.6 * y))});
    }
    return places;
}

// Blocks that go from one to the next, mostly on.
std::vector<glm::ivec3> chain(int size) {
    std::vector<glm::ivec3> places;
    std::mt19937 random(5);
    glm::ivec3 first(0);
    while (std::max({first.x, first.y, first.z}) < size) {
        for (int i = 0; i < 512; ++i)
            places.push_back(first + glm::ivec3(i & 7, i >> 3 & 7, i >> 6));
        first[int(random() % 3)] += random() % 4 == 0 ? -8 : 8;
    }
    return places;
}

float valueAt(const glm::ivec3& at) {
    return 0.25f + float((7 * at.x + 5 * at.y + 3 * at.z) & 7) / 8;
}

// @param isKept  those of its voxels that are there
Volume volumeOf(const std::vector<glm::ivec3>& places,
                const std::function<bool(const glm::ivec3&)>& isKept) {
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (const glm::ivec3& at : places) {
        if (isKept(at)) grid->tree().setValue({at.x, at.y, at.z}, valueAt(at));
    }
    return makeVolume(grid);
}

Volume allOf(const std::vector<glm::ivec3>& places) {
    return volumeOf(places, [](const glm::ivec3&) { return true; });
}

enum class Look { kOneColor, kColors, kShaded };

RenderOptions optionsOf(Look look) {
    RenderOptions options;
    options.optics.range = glm::dvec2(0, 1.2);
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {1, 0.9, 0.5, 0}};
    options.optics.transferFunction.colors = {{0, glm::dvec3(0.7)}};
    if (look != Look::kOneColor)
        options.optics.transferFunction.colors = {{0, {1, 0.2, 0.1}}, {1, {0.3, 0.9, 1}}};
    if (look == Look::kShaded) options.optics.shading = Shading{0.1, 0.6, 0.3, 7, {Light{}}};
    return options;
}

// Sees all of it, in each projection.
std::vector<CameraOptions> camerasOfAll() {
    std::vector<CameraOptions> cameras;
    for (const char* view : {"front", "top", "iso"}) {
        CameraOptions& camera = cameras.emplace_back();
        camera.view = view;
    }
    CameraOptions& turned = cameras.emplace_back();
    turned.view = "back";
    turned.azimuthDegrees = 37;
    turned.elevationDegrees = -21;
    turned.rollDegrees = 30;
    CameraOptions& eye = cameras.emplace_back(turned);
    eye.projection = Projection::kPerspective;
    for (CameraOptions& camera : cameras) camera.sizePixels = {90, 64};
    return cameras;
}

// Looks at a place from near.
std::vector<CameraOptions> closeUps(const glm::ivec3& place) {
    std::vector<CameraOptions> cameras = camerasOfAll();
    for (CameraOptions& camera : cameras) {
        camera.targetWorld = glm::dvec3(place);
        camera.frameWidthWorld = 90;  // a pixel a voxel, so that none is divided
        if (camera.projection == Projection::kOrtho) continue;
        camera.frameWidthWorld.reset();
        camera.eyeWorld = glm::dvec3(place) + glm::dvec3(14, 9, 41);
        camera.rollDegrees = camera.azimuthDegrees = camera.elevationDegrees = 0;
    }
    return cameras;
}

float mostDifference(const Image& a, const Image& b) {
    EXPECT_EQ(a.size, b.size);
    float most = 0;
    for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
        most = std::max(most, std::abs(a.rgba[i] - b.rgba[i]));
    return most;
}

bool showsAnything(const Image& image) {
    return std::any_of(image.rgba.begin(), image.rgba.end(),
                       [](float value) { return value != 0; });
}

class Limit {
  public:
    explicit Limit(std::uint64_t more) { setMemoryLimit(test::memoryBeyond(more)); }
    ~Limit() { setMemoryLimit(0); }
};
constexpr std::uint64_t kLimit = std::uint64_t{1} << 30;

// One that would take gigabytes for its box looks from near as what is near alone, however it is
// coloured.
TEST(WideVoxels, lookFromNearAsWhatIsNear) {
    const Limit limit(kLimit);
    const std::pair<Shape, glm::ivec3> shapes[] = {
        {wire, glm::ivec3(8000)}, {corner, {8000, 0, 0}}, {ring, {0, 6400, 4800}}};
    for (const auto& [shape, place] : shapes) {
        const std::vector<glm::ivec3> places = shape(16000);
        const Volume whole = allOf(places);
        const Volume near = volumeOf(places, [place = place](const glm::ivec3& at) {
            const glm::ivec3 away = glm::abs(at - place);
            return std::max({away.x, away.y, away.z}) < 600;
        });
        for (const Look look : {Look::kOneColor, Look::kColors, Look::kShaded}) {
            for (const CameraOptions& camera : closeUps(place)) {
                // Seen obliquely, a plane's pixels are counted from a volume's first slice.
                if (camera.view != "front" && camera.view != "top") continue;
                RenderOptions options = optionsOf(look);
                options.camera = camera;
                const Image picture = render(whole, options).image;
                EXPECT_TRUE(showsAnything(picture));
                // Places are rounded from another box on.
                EXPECT_LE(mostDifference(picture, render(near, options).image), 2e-6f)
                    << place.x << ' ' << int(look) << ' ' << camera.view;
            }
        }
    }
}

// All of it, and from within.
TEST(WideVoxels, costWhatTheyAre) {
    const Limit limit(kLimit);
    for (const Shape& shape : {Shape(wire), Shape(corner), Shape(ring)}) {
        const Volume volume = allOf(shape(12000));
        for (CameraOptions camera : camerasOfAll()) {
            camera.sizePixels = {256, 256};
            RenderOptions options = optionsOf(Look::kOneColor);
            options.camera = camera;
            EXPECT_TRUE(showsAnything(render(volume, options).image))
                << camera.view << ' ' << int(camera.projection);
        }
    }
}

// A picture that is made to be shown in any parts keeps its planes as they are, in one piece.
TEST(WideVoxels, lookAsTheyDoInOnePiece) {
    const std::tuple<const char*, Shape, Look> shapes[] = {{"wire", wire, Look::kColors},
                                                           {"corner", corner, Look::kColors},
                                                           {"chain", chain, Look::kColors}};
    constexpr int kSize = 2600;
    for (const auto& [name, shape, look] : shapes) {
        const auto volume = std::make_shared<const Volume>(allOf(shape(kSize)));
        const std::vector<CameraOptions> all = camerasOfAll();
        for (const CameraOptions& camera : {all[0], all[3], all[4], closeUps({0, 0, 0}).back()}) {
            RenderOptions options = optionsOf(look);
            options.camera = camera;
            const RenderResult result = render(*volume, options);
            Picture parted(PreparedScene({volume, options.optics}, options.splat), result.camera);
            Image whole(result.image.size);
            parted.show({{0, 0}, whole.size}, whole);
            EXPECT_EQ(mostDifference(result.image, whole), 0)
                << name << ' ' << camera.view << ' ' << int(camera.projection);
        }
    }
}

// Lines of sight that meet no block are not followed; none that does is left out.
TEST(WideVoxels, haveTheirSums) {
    constexpr int kSize = 1000;
    const auto ramp = [](int size) {
        std::vector<glm::ivec3> places;
        for (int i = 0; i < size; ++i) places.push_back({i, i / 2, -i / 3});
        return places;
    };
    for (const Shape& shape : {Shape(ramp), Shape(corner)}) {
        const std::vector<glm::ivec3> places = shape(kSize);
        const Volume volume = allOf(places);
        double held = 0;
        for (const glm::ivec3& at : places) held += double(valueAt(at));
        if (volume.activeCount() < places.size()) held -= 2 * double(valueAt({0, 0, 0}));
        for (CameraOptions camera : camerasOfAll()) {
            if (camera.projection != Projection::kOrtho) continue;
            camera.sizePixels = {256, 256};
            camera.frameWidthWorld = 2 * kSize;
            RenderOptions options;
            options.mode = Mode::kXray;
            options.camera = camera;
            const RenderResult result = render(volume, options);
            double shown = 0;
            for (std::size_t i = 0; i < result.image.rgba.size(); i += 4)
                shown += double(result.image.rgba[i]);
            const double pixel = result.camera.pixelWorld() * result.camera.pixelHeightWorld();
            // A square of lines has a twentieth of what there is.
            EXPECT_NEAR(shown * pixel / held, 1, 2e-2) << camera.view;
        }
    }
}

// What is too thin to be seen is said to be; a larger picture shows it.
TEST(WideVoxels, maySeemEmpty) {
    const Volume volume = allOf(wire(8000));
    const auto saidOf = [&](const glm::ivec2& size) {
        RenderOptions options = optionsOf(Look::kOneColor);
        options.camera = camerasOfAll().front();
        options.camera.sizePixels = size;
        std::string said;
        render(volume, options, {{}, [&](const std::string& text) { said += text; }});
        return said;
    };
    EXPECT_NE(saidOf({16, 16}).find("picture: looks empty"), std::string::npos);
    EXPECT_EQ(saidOf({400, 400}), "");
}

// The same bits on one thread, and with every slice splatted anew or not.
TEST(WideVoxels, areTheSameOnAnyThreads) {
    const Volume volume = allOf(chain(2600));
    for (const std::size_t i : {3, 4}) {
        const CameraOptions camera = camerasOfAll()[i];
        RenderOptions options = optionsOf(Look::kColors);
        options.camera = camera;
        const Image picture = render(volume, options).image;
        options.splat.method = Method::kDelta;
        EXPECT_EQ(picture.rgba, render(volume, options).image.rgba) << camera.view;
        options.splat.method = Method::kSparse;
        const ThreadLimit limit(1);
        EXPECT_EQ(picture.rgba, render(volume, options).image.rgba) << camera.view;
    }
}

}  // namespace
}  // namespace deltasplat
