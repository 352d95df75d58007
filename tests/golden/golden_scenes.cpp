// SPDX-License-Identifier: Apache-2.0
#include "golden/golden_scenes.h"

namespace deltasplat::test {
namespace {

// Colours and opacities over 0..1 of the range, in sRGB.
TransferFunction colored() {
    TransferFunction function;
    function.normalized = true;
    function.colors = {{0, {0.1, 0.2, 0.9}}, {0.4, {0.9, 0.6, 0.3}}, {1, {1, 1, 0.8}}};
    function.opacities = {{0.05, 0, 0.5, 0}, {0.5, 0.1, 0.3, 0}, {1, 0.9, 0.5, 0}};
    return function;
}

TransferFunction oneColor(double opacity) {
    TransferFunction function;
    function.normalized = true;
    function.linearColors = true;
    function.colors = {{0, {0.9, 0.5, 0.2}}};
    function.opacities = {{0, 0, 0.5, 0}, {1, opacity, 0.5, 0}};
    return function;
}

// Midpoints and sharpnesses off the middle.
TransferFunction bent() {
    TransferFunction function = colored();
    function.opacities = {{0, 0, 0.3, 0.4}, {0.45, 0.3, 0.8, 0.75}, {1, 1, 0.5, 1}};
    return function;
}

// Light from a thousandth to a thousand.
TransferFunction bright() {
    TransferFunction function = colored();
    function.linearColors = true;
    function.colors = {{0, {1e-3, 2e-3, 1e-3}}, {0.5, {1, 30, 2}}, {1, {1e3, 400, 10}}};
    return function;
}

CameraOptions cameraOf(const std::string& view, glm::ivec2 size = {64, 48}) {
    CameraOptions camera;
    camera.view = view;
    camera.sizePixels = size;
    return camera;
}

CameraOptions turned(double azimuth, double elevation, double roll = 0) {
    CameraOptions camera = cameraOf("front", {72, 56});
    camera.azimuthDegrees = azimuth;
    camera.elevationDegrees = elevation;
    camera.rollDegrees = roll;
    return camera;
}

CameraOptions along(const glm::dvec3& direction, const glm::dvec3& up) {
    CameraOptions camera = cameraOf("front", {61, 67});
    camera.direction = direction;
    camera.up = up;
    return camera;
}

class Scenes {
  public:
    RenderOptions& add(const std::string& name, const std::string& volume,
                       const CameraOptions& camera, const TransferFunction& function) {
        scenes_.push_back({name, volume, {}, {}});
        scenes_.back().options.camera = camera;
        scenes_.back().options.optics.transferFunction = function;
        return scenes_.back().options;
    }
    RenderOptions& add(const std::string& name, const std::string& volume,
                       const CameraOptions& camera, Mode mode) {
        RenderOptions& options = add(name, volume, camera, colored());
        options.mode = mode;
        return options;
    }
    // Of media of several grids, of which the other is given besides.
    RenderOptions& addMedium(const std::string& name, const std::string& volume,
                             const std::string& part, const CameraOptions& camera) {
        add(name, volume, camera, bent());
        scenes_.back().part = part;
        scenes_.back().options.optics.parts.resize(1);
        return scenes_.back().options;
    }
    void addJoined(const std::string& name, const std::string& volume, const CameraOptions& camera,
                   const TransferFunction& function, int joined = 2, int within = 1) {
        add(name, volume, camera, function).splat.mostJoined = joined;
        scenes_.back().joined = joined;
        scenes_.back().joinedWithin = within;
    }
    std::vector<GoldenScene> take() { return std::move(scenes_); }

  private:
    std::vector<GoldenScene> scenes_;
};

void addViews(Scenes& scenes) {
    for (const char* view : {"front", "back", "left", "right", "top", "bottom", "iso"}) {
        scenes.add(std::string("view-") + view, "engine", cameraOf(view), colored());
    }
    scenes.add("turned", "engine", turned(33, 21), colored());
    scenes.add("rolled", "engine", turned(-100, 40, 17), colored());
    scenes.add("near-diagonal", "cloud", turned(44.9, 0), oneColor(0.3));
    scenes.add("past-diagonal", "cloud", turned(45.1, 0), oneColor(0.3));
    scenes.add("direction", "shepp-logan", along({0.3, -0.8, 0.5}, {0, 0, 1}), colored());
    CameraOptions near = turned(20, 10);
    near.targetWorld = glm::dvec3(20, 18, 22);
    near.frameWidthWorld = 9;
    scenes.add("magnified", "engine", near, colored());
    near.frameWidthWorld = 300;
    scenes.add("far-away", "engine", near, colored());
    scenes.add("wide", "vessels", cameraOf("iso", {150, 20}), colored());
}

void addFunctions(Scenes& scenes) {
    scenes.add("one-color-thin", "cloud", turned(30, 10), oneColor(0.02));
    scenes.add("one-color-dense", "cloud", turned(30, 10), oneColor(1));
    for (const PictureFilter filter :
         {PictureFilter::kMitchell, PictureFilter::kGauss, PictureFilter::kBox}) {
        const std::string name = "filter-" + pictureFilterName(filter);
        scenes.add(name, "engine", turned(40, 20), colored()).splat.filter = filter;
        CameraOptions eye = turned(40, 20);
        eye.projection = Projection::kPerspective;
        scenes.add(name + "-eye", "engine", eye, colored()).splat.filter = filter;
    }
    scenes.add("bent", "hydrogen", turned(12, 34), bent());
    scenes.add("bent-axis", "marschner-lobb", cameraOf("left"), bent());
    scenes.add("bright", "marschner-lobb", turned(-50, 25), bright());
    scenes.add("bright-few", "few", turned(70, -30), bright());
    scenes.add("fog-beside-rock", "fog", turned(15, 5), oneColor(1));
    scenes.add("decades", "decades", turned(60, 15), colored());
    scenes.add("faintest", "faintest", turned(60, 15), colored());
    scenes.add("stretched", "slab", turned(20, 0), oneColor(0.1));
    scenes.add("vessels", "vessels", turned(30, 15), colored());
    TransferFunction dim = oneColor(0.2);
    dim.colors = {{0, {1e-40, 3e-39, 1e-42}}};
    scenes.add("denormal-light", "cloud", turned(25, 25), dim);
}

void addOptions(Scenes& scenes) {
    scenes.add("sigma-narrow", "engine", turned(10, 20), colored()).splat.sigma = 0.25;
    scenes.add("sigma-wide", "engine", turned(10, 20), colored()).splat.sigma = 0.9;
    scenes.add("sigma-very-wide", "few", turned(-20, 50), colored()).splat.sigma = 2.5;
    for (const int resolution : {1, 2, 3, 5}) {
        scenes
            .add("resolution-" + std::to_string(resolution), "shepp-logan", turned(-25, 12),
                 colored())
            .splat.resolution = resolution;
    }
    scenes.add("tolerance", "noisy", turned(35, 20), colored()).splat.tolerance.relative = 0.1;
    scenes.add("tolerance-value", "noisy", turned(35, 20), colored()).splat.tolerance.value = 4;
    scenes.add("extinction", "noisy", turned(35, 20), oneColor(0.05)).optics.extinctionScale = 7;
    scenes.add("unit-distance", "hydrogen", turned(5, 75), colored()).optics.unitDistance = 0.3;
    scenes.add("range", "marschner-lobb", cameraOf("iso"), colored()).optics.range =
        glm::dvec2(9000, 51000);
    scenes.add("traditional", "few", turned(55, 35), colored()).splat.method = Method::kTraditional;
    scenes.add("sparse", "few", turned(54, 35), colored()).splat.method = Method::kSparse;
    scenes.add("delta", "few", turned(53, 35), colored()).splat.method = Method::kDelta;
}

void addRays(Scenes& scenes) {
    scenes.add("xray", "engine", turned(33, 21), Mode::kXray);
    scenes.add("xray-axis", "shepp-logan", cameraOf("top"), Mode::kXray);
    scenes.add("xray-decades", "decades", turned(-40, 30), Mode::kXray);
    scenes.add("xray-faintest", "faintest", turned(10, 5), Mode::kXray);
    scenes.add("xray-stretched", "hydrogen", turned(120, 30), Mode::kXray);
    scenes.add("mip", "vessels", turned(33, 21), Mode::kMip);
    scenes.add("mip-axis", "marschner-lobb", cameraOf("right"), Mode::kMip);
    scenes.add("mip-decades", "decades", cameraOf("iso"), Mode::kMip);
    scenes.add("mip-colors", "hydrogen", turned(80, 10), Mode::kMip).mipColors = true;
    scenes.add("mip-depth", "vessels", turned(33, 21), Mode::kMip).depthShade = 0.7;
    scenes.add("min", "marschner-lobb", turned(-40, 30), Mode::kMin);
    scenes.add("average", "engine", turned(-40, 30), Mode::kAverage);
    scenes.add("drr", "engine", turned(33, 21), Mode::kDrr).drr.muWater = 0.01;
    CameraOptions camera = turned(33, 21);
    camera.projection = Projection::kPerspective;
    camera.fovDegrees = 40;
    scenes.add("xray-perspective", "engine", camera, Mode::kXray);
    scenes.add("mip-depth-perspective", "vessels", camera, Mode::kMip).depthShade = 0.7;
    scenes.add("average-perspective", "cloud", camera, Mode::kAverage);
    scenes.add("drr-perspective", "hydrogen", camera, Mode::kDrr).drr.photons = 1e4;
    camera.distanceWorld = 6;
    camera.fovDegrees = 110;
    scenes.add("min-inside", "noisy", camera, Mode::kMin);
}

void addEyes(Scenes& scenes) {
    CameraOptions camera = turned(33, 21);
    camera.projection = Projection::kPerspective;
    camera.fovDegrees = 40;
    scenes.add("perspective", "engine", camera, colored());
    scenes.add("perspective-one-color", "cloud", camera, oneColor(0.3));
    camera.fovDegrees = 110;
    camera.distanceWorld = 6;
    scenes.add("perspective-inside", "shepp-logan", camera, colored());
    camera.nearWorld = 3.3;
    scenes.add("perspective-near", "fog", camera, oneColor(1));
    CameraOptions panorama = turned(33, 21);
    panorama.projection = Projection::kLatlong;
    panorama.sizePixels = {120, 60};
    scenes.add("panorama", "engine", panorama, colored());
    scenes.add("panorama-decades", "decades", panorama, colored());
}

// Of slices that are drawn as one: pictures are so small that voxels cover half a pixel or less.
void addJoined(Scenes& scenes) {
    CameraOptions camera = turned(33, 21);
    camera.sizePixels = {11, 9};
    scenes.addJoined("joined", "engine", camera, colored());
    scenes.addJoined("joined-one-color", "cloud", camera, oneColor(0.3));
    CameraOptions smaller = camera;
    smaller.sizePixels = {15, 13};
    scenes.addJoined("joined-many", "engine", smaller, colored(), 16);
    smaller.sizePixels = {8, 7};
    scenes.addJoined("joined-many-one-color", "cloud", smaller, oneColor(0.3), 16);
    smaller.sizePixels = {7, 6};
    scenes.addJoined("joined-squares", "engine", smaller, colored(), 16, 2);
    scenes.addJoined("joined-squares-one-color", "cloud", smaller, oneColor(0.3), 16, 2);
    camera.projection = Projection::kPerspective;
    camera.fovDegrees = 30;
    scenes.addJoined("joined-perspective", "engine", camera, colored());
    scenes.addJoined("joined-perspective-one-color", "cloud", camera, oneColor(0.3));
}

// Of voxels that have looks of their own.
void addLooks(Scenes& scenes) {
    scenes.add("color-by-index", "engine", turned(33, 21), colored()).optics.colorBy =
        ColorBy::kIndex;
    Shading shading;
    shading.lights.push_back({LightFrame::kWorld, {1, -2, 0.5}, {1, 0.8, 0.3}, 0.7});
    shading.lights.push_back({LightFrame::kView, {-1, -1, -1}, {0.2, 0.3, 1}, 0.5});
    scenes.add("shaded", "engine", turned(33, 21), colored()).optics.shading = shading;
    scenes.add("shaded-decades", "decades", turned(33, 21), colored()).optics.shading = shading;
    RenderOptions& divided = scenes.add("shaded-divided", "cloud", turned(10, 50), bent());
    divided.optics.shading = shading;
    divided.splat.between = 1;
    CameraOptions camera = turned(33, 21);
    camera.projection = Projection::kPerspective;
    camera.fovDegrees = 60;
    scenes.add("shaded-perspective", "engine", camera, colored()).optics.shading = shading;
    for (const int between : {0, 1}) {
        RenderOptions& surface =
            scenes.add("surface-" + std::to_string(between), "engine", turned(33, 21), colored());
        surface.optics.surface = Surface{90, {0.8, 0.6, 0.5}};
        surface.optics.shading = shading;
        surface.splat.between = between;
    }
    scenes.add("gradient-opacity", "cloud", turned(10, 50), bent()).optics.gradientOpacity = {
        {0, 0.1}, {0.02, 0.9}};
    Scattering scattering{glm::dvec3(0.9, 0.8, 0.7), 0.6, -0.3, 0.25, 2, glm::dvec3(0.02), {}};
    scattering.lights = {{LightFrame::kWorld, {1, -2, 0.5}, {1, 0.8, 0.3}, 4},
                         {LightFrame::kWorld, {-0.3, -0.2, 1}, {0.2, 0.3, 1}, 3}};
    scenes.add("scattered", "cloud", turned(10, 50), bent()).optics.scattering = scattering;
    scenes.add("scattered-perspective", "fog", camera, colored()).optics.scattering = scattering;
    RenderOptions& fire = scenes.addMedium("fire", "cloud", "engine", turned(10, 50));
    fire.optics.scattering = scattering;
    fire.optics.parts[0].kelvinScale = 20;
    MediumPart& veil = scenes.addMedium("veiled", "engine", "cloud", camera).optics.parts[0];
    veil.kind = MediumPart::Kind::kAbsorption;
    veil.transferFunction = oneColor(0.2);
    Light inside{LightFrame::kWorld};
    inside.color = {1, 0.7, 0.4};
    inside.strength = 200;
    inside.positionWorld = glm::dvec3(9, 13, 11);
    inside.radiusWorld = 1;
    scattering.lights.push_back(inside);
    scenes.add("scattered-point", "cloud", turned(10, 50), bent()).optics.scattering = scattering;
    scenes.add("scattered-point-perspective", "fog", camera, colored()).optics.scattering =
        scattering;
}

}  // namespace

std::vector<GoldenScene> goldenScenes() {
    Scenes scenes;
    addViews(scenes);
    addFunctions(scenes);
    addOptions(scenes);
    addRays(scenes);
    addEyes(scenes);
    addJoined(scenes);
    addLooks(scenes);
    return scenes.take();
}

}  // namespace deltasplat::test
