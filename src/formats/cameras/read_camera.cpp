// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/cameras/read_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string_view>
#include <utility>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/cameras/motion.h"
#include "formats/usd/usd_scene.h"
#include "optics/located_json.h"
#include "view/camera_axes.h"

namespace deltasplat {

namespace {

using Kind = LocatedJson::Kind;

constexpr double kMost = 1e30;

// Fields for the camera's place, and further fields that may vary per key.
constexpr std::array kOfPlace{"matrix", "eye", "target", "direction", "up", "translate", "rotate"};
constexpr std::array kOfLens{"focal", "aperture", "offset", "frame_width", "near", "far"};
constexpr std::array kOfFile{"projection",   "fit",     "pixel_aspect", "size",
                             "rotate_order", "up_axis", "keys"};

template <std::size_t N>
bool isOneOf(const std::array<const char*, N>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

class JsonCamera {
  public:
    explicit JsonCamera(const std::filesystem::path& file)
        : file_(file), json_(readLocatedJson(file, "a camera", "a camera (JSON)")) {}

    CameraMotion read() {
        if (json_.kind != Kind::kObject) fail(json_, json_.quoted(), "an object");
        checkNames(json_, true);
        FilmCamera film;
        readProjection(film);
        readPicture(film);
        readLens(json_, film);
        const bool isPlaced = readPlace(json_, film);
        const LocatedJson* keys = json_.find("keys");
        if (keys) return readKeys(*keys, film, isPlaced);
        if (!isPlaced) failPlace(json_);
        return {{}, [film](double) { return film; }, up()};
    }

  private:
    [[noreturn]] void fail(const LocatedJson& at, const std::string& got,
                           const std::string& expected) const {
        throw Error(ErrorCode::kInput, whereOf(at), got, expected);
    }

    std::string whereOf(const LocatedJson& at) const {
        return file_.string() + ":" + std::to_string(at.line);
    }

    [[noreturn]] void failPlace(const LocatedJson& at) const {
        fail(at, "no place of the camera", R"("matrix", "eye" or "translate")");
    }

    void checkNames(const LocatedJson& json, bool isWhole) const {
        std::vector<std::string> seen;
        for (const LocatedMember& member : json.members) {
            const std::string& name = member.name;
            const bool isKnown = isOneOf(kOfPlace, name) || isOneOf(kOfLens, name) ||
                                 (isWhole ? isOneOf(kOfFile, name) : name == "frame");
            const LocatedJson text{Kind::kString, member.value.line, false, 0, name, {}};
            if (!isKnown)
                fail(member.value, text.quoted(),
                     isWhole ? "a field of a camera" : "a field of a camera's key");
            if (std::find(seen.begin(), seen.end(), name) != seen.end())
                fail(member.value, text.quoted() + " twice", "it once");
            seen.push_back(name);
        }
    }

    // Reads a number in a range that arithmetic can handle.
    double number(const LocatedJson& json, const char* name, double least, double most,
                  const char* expected) const {
        if (json.kind != Kind::kNumber || !(json.number >= least && json.number <= most))
            fail(json, json.quoted() + std::string(" for \"") + name + '"', expected);
        return json.number;
    }

    double positive(const LocatedJson& json, const char* name) const {
        return number(json, name, 1 / kMost, kMost, "a number > 0");
    }

    std::vector<double> numbers(const LocatedJson& json, const char* name, std::size_t count,
                                const char* expected) const {
        std::vector<double> values;
        if (json.kind != Kind::kArray || json.members.size() != count)
            fail(json, json.quoted() + std::string(" for \"") + name + '"', expected);
        for (const LocatedMember& member : json.members)
            values.push_back(number(member.value, name, -kMost, kMost, expected));
        return values;
    }

    glm::dvec3 vector(const LocatedJson& json, const char* name) const {
        const std::vector<double> v = numbers(json, name, 3, "three numbers");
        return {v[0], v[1], v[2]};
    }

    std::string word(const LocatedJson& json, const char* name,
                     const std::vector<std::string>& words) const {
        const bool isKnown = json.kind == Kind::kString &&
                             std::find(words.begin(), words.end(), json.text) != words.end();
        if (isKnown) return json.text;
        std::string all;
        for (const std::string& one : words) all += (all.empty() ? "" : ", ") + one;
        fail(json, json.quoted() + std::string(" for \"") + name + '"', "one of " + all);
    }

    std::optional<glm::dvec3> up() const {
        const LocatedJson* json = json_.find("up_axis");
        if (!json) return {};
        return word(*json, "up_axis", {"y", "z"}) == "y" ? glm::dvec3(0, 1, 0)
                                                         : glm::dvec3(0, 0, 1);
    }

    void readProjection(FilmCamera& film) const {
        const LocatedJson* json = json_.find("projection");
        if (!json) return;
        const std::string name = word(*json, "projection", {"ortho", "perspective", "latlong"});
        film.projection = name == "ortho"     ? Projection::kOrtho
                          : name == "latlong" ? Projection::kLatlong
                                              : Projection::kPerspective;
    }

    void readPicture(FilmCamera& film) const {
        if (const LocatedJson* json = json_.find("pixel_aspect")) {
            film.pixelAspect = number(*json, "pixel_aspect", kLeastPixelAspect, kMostPixelAspect,
                                      "a number from 0.01 to 100");
        }
        if (const LocatedJson* json = json_.find("fit")) {
            std::vector<std::string> names;
            for (int i = 0; i < 5; ++i) names.push_back(filmFitName(FilmFit(i)));
            const std::string name = word(*json, "fit", names);
            film.fit = FilmFit(std::find(names.begin(), names.end(), name) - names.begin());
        }
        const LocatedJson* size = json_.find("size");
        if (!size) return;
        const char* expected = "two whole numbers from 1 to 2147483647";
        const std::vector<double> v = numbers(*size, "size", 2, expected);
        for (const double x : v) {
            if (x != std::floor(x) || x < 1 || x > 2147483647)
                fail(*size, numberText(x) + " for \"size\"", expected);
        }
        film.sizePixels = glm::ivec2(glm::dvec2(v[0], v[1]));
    }

    void readLens(const LocatedJson& json, FilmCamera& film) const {
        if (const LocatedJson* focal = json.find("focal")) film.focalMm = positive(*focal, "focal");
        if (const LocatedJson* aperture = json.find("aperture")) readAperture(*aperture, film);
        if (const LocatedJson* offset = json.find("offset")) {
            const std::vector<double> v = numbers(*offset, "offset", 2, "two numbers");
            film.offsetMm = {v[0], v[1]};
        }
        if (const LocatedJson* width = json.find("frame_width"))
            film.frameWidthWorld = positive(*width, "frame_width");
        if (const LocatedJson* near = json.find("near"))
            film.nearWorld = number(*near, "near", 0, kMost, "a number of at least 0");
        if (const LocatedJson* far = json.find("far")) {
            film.farWorld = positive(*far, "far");
            if (!(*film.farWorld > film.nearWorld)) {
                fail(*far, numberText(*film.farWorld) + " for \"far\"",
                     "more than \"near\", " + numberText(film.nearWorld));
            }
        }
    }

    void readAperture(const LocatedJson& json, FilmCamera& film) const {
        if (json.kind == Kind::kNumber) {
            film.apertureMm = {positive(json, "aperture"), 0};
            return;
        }
        const char* expected = "a width, or a width and a height > 0";
        const std::vector<double> v = numbers(json, "aperture", 2, expected);
        if (!(v[0] > 0 && v[1] > 0))
            fail(json, numberText(v[0]) + "," + numberText(v[1]) + " for \"aperture\"", expected);
        film.apertureMm = {v[0], v[1]};
    }

    // Returns whether the camera has a place.
    bool readPlace(const LocatedJson& json, FilmCamera& film) const {
        const LocatedJson* first = nullptr;
        const char* name = nullptr;
        for (const char* one : {"matrix", "eye", "translate"}) {
            const LocatedJson* found = json.find(one);
            if (found && first)
                fail(*found, std::string("it and \"") + name + '"', "one place of the camera");
            if (!found) continue;
            first = found;
            name = one;
        }
        requireBeside(json, first && name[0] == 'e', "eye", {"target", "direction", "up"});
        requireBeside(json, first && name[0] == 't', "translate", {"rotate"});
        if (!first) return false;
        film.worldFromCamera = name[0] == 'm'   ? matrix(*first)
                               : name[0] == 'e' ? lookFrom(json, *first)
                                                : placed(json, *first);
        cameraAxes(film.worldFromCamera, whereOf(*first) + ": " + name, ErrorCode::kInput);
        return true;
    }

    void requireBeside(const LocatedJson& json, bool isThere, const char* name,
                       const std::vector<const char*>& others) const {
        for (const char* other : others) {
            const LocatedJson* found = json.find(other);
            if (found && !isThere)
                fail(*found, '"' + std::string(other) + "\" without \"" + name + '"',
                     '"' + std::string(name) + "\" besides");
        }
    }

    glm::dmat4 matrix(const LocatedJson& json) const {
        const char* expected = "16 numbers, or four rows of four";
        glm::dmat4 result;
        const bool hasRows = json.kind == Kind::kArray && json.members.size() == 4;
        if (!hasRows) {
            const std::vector<double> v = numbers(json, "matrix", 16, expected);
            for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = v[std::size_t(i)];
            return result;
        }
        for (int row = 0; row < 4; ++row) {
            const std::vector<double> v =
                numbers(json.members[std::size_t(row)].value, "matrix", 4, expected);
            for (int i = 0; i < 4; ++i) result[row][i] = v[std::size_t(i)];
        }
        return result;
    }

    glm::dmat4 lookFrom(const LocatedJson& json, const LocatedJson& eye) const {
        const glm::dvec3 from = vector(eye, "eye");
        const LocatedJson* target = json.find("target");
        const LocatedJson* pointed = json.find("direction");
        if ((target != nullptr) == (pointed != nullptr))
            fail(eye, target ? "\"target\" and \"direction\"" : "an eye that looks nowhere",
                 "one of \"target\" and \"direction\"");
        const glm::dvec3 direction =
            target ? vector(*target, "target") - from : vector(*pointed, "direction");
        const LocatedJson* upwards = json.find("up");
        const glm::dvec3 up = upwards ? vector(*upwards, "up") : glm::dvec3(0, 1, 0);
        const double lengths = glm::length(direction) * glm::length(up);
        const glm::dvec3 right = glm::cross(direction, up);
        if (!(glm::length(right) > 1e-9 * lengths))
            fail(eye, "a line of sight " + numberText(direction) + " along up " + numberText(up),
                 "an up that differs from it");
        const glm::dvec3 back = -glm::normalize(direction);
        const glm::dvec3 across = glm::normalize(right);
        return {glm::dvec4(across, 0), glm::dvec4(glm::cross(back, across), 0), glm::dvec4(back, 0),
                glm::dvec4(from, 1)};
    }

    glm::dmat4 placed(const LocatedJson& json, const LocatedJson& translate) const {
        glm::dvec3 degrees(0);
        if (const LocatedJson* rotate = json.find("rotate")) {
            degrees = vector(*rotate, "rotate");
            for (int i = 0; i < 3; ++i)
                if (!(std::abs(degrees[i]) <= 1e6))
                    fail(*rotate, numberText(degrees) + " for \"rotate\"", "at most 1e6 degrees");
        }
        const LocatedJson* order = json_.find("rotate_order");
        glm::dmat4 result = rotation(
            degrees, order
                         ? word(*order, "rotate_order", {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"})
                         : "xyz");
        result[3] = glm::dvec4(vector(translate, "translate"), 1);
        return result;
    }

    static std::vector<std::string> namesOf(const LocatedJson& key) {
        std::vector<std::string> names;
        for (const LocatedMember& member : key.members) names.push_back(member.name);
        std::sort(names.begin(), names.end());
        return names;
    }

    // A field in only some keys could not be interpolated.
    void requireAlike(const LocatedJson& first, const LocatedJson& key) const {
        const std::vector<std::string> mine = namesOf(key);
        const std::vector<std::string> others = namesOf(first);
        std::vector<std::string> missing;
        std::set_difference(others.begin(), others.end(), mine.begin(), mine.end(),
                            std::back_inserter(missing));
        if (!missing.empty())
            fail(key, "a key without \"" + missing.front() + '"', "it, as in the first key");
        if (mine == others) return;
        std::set_difference(mine.begin(), mine.end(), others.begin(), others.end(),
                            std::back_inserter(missing));
        fail(key, "a key with \"" + missing.front() + '"', "none, as in the first key");
    }

    CameraMotion readKeys(const LocatedJson& keys, const FilmCamera& film, bool isPlaced) const {
        if (keys.kind != Kind::kArray || keys.members.empty())
            fail(keys, keys.kind == Kind::kArray ? "no keys" : keys.quoted(), "a list of keys");
        std::vector<FilmCamera> cameras;
        CameraMotion motion;
        motion.upWorld = up();
        for (const LocatedMember& member : keys.members) {
            const LocatedJson& key = member.value;
            if (key.kind != Kind::kObject) fail(key, key.quoted(), "a key, an object");
            checkNames(key, false);
            const LocatedJson* frame = key.find("frame");
            if (!frame) fail(key, "a key without \"frame\"", "its number");
            const double at = number(*frame, "frame", -1e9, 1e9, "a number");
            if (!motion.frames.empty() && !(at > motion.frames.back()))
                fail(*frame, numberText(at) + " behind " + numberText(motion.frames.back()),
                     "frames that ascend");
            requireAlike(keys.members.front().value, key);
            FilmCamera camera = film;
            readLens(key, camera);
            const bool isKeyPlaced = readPlace(key, camera);
            if (isKeyPlaced && isPlaced)
                fail(key, "a place in it and beside the keys", "one of the two");
            if (!isKeyPlaced && !isPlaced) failPlace(key);
            motion.frames.push_back(at);
            cameras.push_back(camera);
        }
        motion.at = [frames = motion.frames, cameras](double frame) {
            const KeyPlace place = keyPlace(frames, frame);
            const std::size_t next = std::min(place.first + 1, cameras.size() - 1);
            return mixed(cameras[place.first], cameras[next], place.share);
        };
        return motion;
    }

    std::filesystem::path file_;
    LocatedJson json_;
};

}  // namespace

CameraMotion readJsonCamera(const std::filesystem::path& file) {
    return JsonCamera(file).read();
}

bool isCameraName(const std::filesystem::path& file) {
    const std::string ending = lowerCase(file.extension().string());
    return ending == ".json" || ending == ".usda" || ending == ".exr";
}

CameraMotion readCamera(const std::filesystem::path& file, const std::string& name,
                        const Listener& listener) {
    const DefaultFloats floats;
    const std::string ending = lowerCase(file.extension().string());
    if (ending == ".usda") return readUsdCamera(file, name, listener);
    if (!name.empty()) {
        throw Error(ErrorCode::kInput, file.string() + ":" + name, "no .usda",
                    "a name behind a .usda's only");
    }
    if (ending == ".json") return readJsonCamera(file);
    if (ending == ".exr") return readExrCamera(file, listener);
    const bool isOtherUsd = ending == ".usd" || ending == ".usdc" || ending == ".usdz";
    throw Error(ErrorCode::kInput, file.string(),
                isOtherUsd ? "USD that is no text" : "an unknown ending",
                isOtherUsd ? ".usda, as usdcat -o x.usda writes it" : ".json, .usda or .exr");
}

// Based on: Pixar, "Universal Scene Description", UsdGeomCamera: looks along -z, y is up; apertures
// and focal lengths are tenths of a scene unit.
namespace {

using UsdKind = UsdValue::Kind;

// Defaults of the schema.
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

    // Null if the property is absent or blocked.
    const UsdProperty* find(const char* name, double time) const {
        const UsdProperty* property = prim().find(name);
        return property && valueAt(*property, time).kind != UsdKind::kNone ? property : nullptr;
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
    // Reports errors of any frame before one is used.
    motion.at(0);
    for (const double frame : motion.frames) motion.at(frame);
    return motion;
}

}  // namespace deltasplat
