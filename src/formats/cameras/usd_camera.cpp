// SPDX-License-Identifier: Apache-2.0
// Based on: Pixar, "Universal Scene Description", UsdGeomCamera: it looks along its -z axis, y is
// up; apertures and focal lengths are tenths of a scene unit.
#include <algorithm>
#include <array>
#include <memory>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/cameras/readers.h"
#include "formats/usd/usd_scene.h"
#include "view/camera_axes.h"

namespace deltasplat {
namespace {

using Kind = UsdValue::Kind;

// What the schema has where a file is silent.
constexpr double kFocal = 50;
constexpr double kHorizontalAperture = 20.955;
constexpr double kVerticalAperture = 15.2908;
constexpr double kUnitsPerTenth = 0.1;

constexpr std::array kLens{"focalLength",
                           "horizontalAperture",
                           "verticalAperture",
                           "horizontalApertureOffset",
                           "verticalApertureOffset",
                           "clippingRange"};

class UsdCamera {
  public:
    UsdCamera(UsdLayer layer, const std::string& name)
        : layer_(std::move(layer)), chain_(choosePrim(layer_, "Camera", name)) {}

    const UsdLayer& layer() const { return layer_; }
    const UsdChain& chain() const { return chain_; }

    std::vector<double> times() const {
        std::vector<double> times;
        addTimes(chain_, times);
        for (const char* name : kLens) addTimes(prim(), name, times);
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
        return times;
    }

    FilmCamera at(double time) const {
        FilmCamera camera;
        camera.worldFromCamera = worldFromPrim(layer_, chain_, time);
        cameraAxes(camera.worldFromCamera, layer_.file.string() + ": " + pathOf(chain_),
                   ErrorCode::kInput);
        camera.projection = projection(time);
        camera.focalMm = positive("focalLength", kFocal, time);
        camera.apertureMm = {positive("horizontalAperture", kHorizontalAperture, time),
                             positive("verticalAperture", kVerticalAperture, time)};
        camera.offsetMm = {number("horizontalApertureOffset", time),
                           number("verticalApertureOffset", time)};
        camera.fit = FilmFit::kOverscan;
        camera.frameWidthWorld = kUnitsPerTenth * camera.apertureMm.x;
        readClipping(camera, time);
        return camera;
    }

    std::optional<glm::dvec3> up() const {
        const auto axis = layer_.root.metadata.find("upAxis");
        if (axis == layer_.root.metadata.end()) return {};
        if (axis->second.text == "Y") return glm::dvec3(0, 1, 0);
        if (axis->second.text == "Z") return glm::dvec3(0, 0, 1);
        fail(axis->second, "upAxis", "\"Y\" or \"Z\"");
    }

  private:
    const UsdPrim& prim() const { return *chain_.back(); }

    [[noreturn]] void fail(const UsdValue& value, const std::string& name,
                           const std::string& expected) const {
        throw Error(ErrorCode::kInput, layer_.file.string() + ":" + std::to_string(value.line),
                    value.quoted() + " for " + name, expected);
    }

    // Null where it is not written or blocked.
    const UsdProperty* find(const char* name, double time) const {
        const UsdProperty* property = prim().find(name);
        return property && valueAt(*property, time).kind != Kind::kNone ? property : nullptr;
    }

    double number(const char* name, double time) const {
        const UsdProperty* property = find(name, time);
        return property ? numbersAt(layer_, *property, time, 1)[0] : 0;
    }

    double positive(const char* name, double otherwise, double time) const {
        const UsdProperty* property = find(name, time);
        if (!property) return otherwise;
        const double number = numbersAt(layer_, *property, time, 1)[0];
        if (!(number > 0)) fail(valueAt(*property, time), name, "a number > 0");
        return number;
    }

    Projection projection(double time) const {
        const UsdProperty* property = find("projection", time);
        if (!property) return Projection::kPerspective;
        const UsdValue value = valueAt(*property, time, false);
        if (value.text == "perspective") return Projection::kPerspective;
        if (value.text == "orthographic") return Projection::kOrtho;
        fail(value, "projection", "\"perspective\" or \"orthographic\"");
    }

    void readClipping(FilmCamera& camera, double time) const {
        const UsdProperty* property = find("clippingRange", time);
        if (!property) return;
        const std::vector<double> range = numbersAt(layer_, *property, time, 2);
        if (!(range[0] >= 0 && range[1] > range[0]))
            fail(valueAt(*property, time), "clippingRange", "two ascending numbers >= 0");
        camera.nearWorld = range[0];
        camera.farWorld = range[1];
    }

    UsdLayer layer_;
    UsdChain chain_;  // into layer_
};

}  // namespace

CameraMotion readUsdCamera(const std::filesystem::path& file, const std::string& name,
                           const Listener& listener) {
    const auto camera = std::make_shared<const UsdCamera>(readUsdLayer(file), name);
    warnOfUsd(camera->layer(), camera->chain(), listener);
    CameraMotion motion;
    motion.frames = camera->times();
    motion.upWorld = camera->up();
    motion.at = [camera](double frame) { return camera->at(frame); };
    // What is wrong with any of them is said before one is used.
    motion.at(0);
    for (const double frame : motion.frames) motion.at(frame);
    return motion;
}

}  // namespace deltasplat
