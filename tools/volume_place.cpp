// SPDX-License-Identifier: Apache-2.0
#include "volume_place.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/text.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

// Names of the positive and the negative direction of each world axis.
struct Side {
    const char* positive;
    const char* negative;
};

const Side kPatient[] = {{"the patient's right", "the patient's left"},
                         {"the front", "the back"},
                         {"the head", "the feet"}};
const Side kWorld[] = {{"+x", "-x"}, {"+y", "-y"}, {"+z", "-z"}};

bool isPatient(const std::string& space) {
    return space == "RAS" || space == "LPS";
}

// In LPS, left and back are positive.
std::string sideText(const std::string& space, int axis, bool positive) {
    const Side& side = isPatient(space) ? kPatient[axis] : kWorld[axis];
    const bool turned = space == "LPS" && axis < 2;
    return positive != turned ? side.positive : side.negative;
}

std::string vectorOption(const std::string& name, const glm::dvec3& v) {
    return " --" + name + "=" + joinNumbers({v.x, v.y, v.z}, ",");
}

}  // namespace

Json vectorJson(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

VolumePlace placeOf(const Volume& volume) {
    VolumePlace place;
    const glm::dmat4& matrix = volume.worldFromIndex();
    place.origin = glm::dvec3(matrix[3]);
    for (int axis = 0; axis < 3; ++axis)
        place.directions[axis] = glm::dvec3(matrix[axis]) / volume.voxelSize()[axis];
    place.box = worldBox(volume.box(), matrix);
    return place;
}

std::string spaceText(const std::string& space) {
    if (!isPatient(space)) return "";
    return space + ": x to " + sideText(space, 0, true) + ", y to " + sideText(space, 1, true) +
           ", z to " + sideText(space, 2, true);
}

std::string directionText(const VolumePlace& place, const std::string& space, int axis) {
    const glm::dvec3& direction = place.directions[axis];
    int nearest = 0;
    for (int world = 1; world < 3; ++world) {
        if (std::abs(direction[world]) > std::abs(direction[nearest])) nearest = world;
    }
    const std::string side = sideText(space, nearest, direction[nearest] > 0);
    const double off = std::acos(std::min(1.0, std::abs(direction[nearest])));
    // File formats store directions to about six digits.
    const double degrees = off * 180 / std::numbers::pi;
    if (degrees < 0.05) return "to " + side;
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", degrees);
    return std::string(text) + " degrees off " + side;
}

Json placeJson(const Volume& volume) {
    const VolumePlace place = placeOf(volume);
    const Camera camera = makeCamera(CameraOptions(), volume);
    const glm::dmat3& d = place.directions;
    return {{"world_box", {vectorJson(place.box.min), vectorJson(place.box.max)}},
            {"origin", vectorJson(place.origin)},
            {"directions", {vectorJson(d[0]), vectorJson(d[1]), vectorJson(d[2])}},
            {"space", volume.space().empty() ? Json() : Json(volume.space())},
            {"length_unit", volume.lengthUnit().empty() ? Json() : Json(volume.lengthUnit())},
            {"target", vectorJson(camera.targetWorld)},
            {"frame_width", camera.frameWidthWorld}};
}

std::string cameraOptionsText(const Camera& camera) {
    const glm::ivec2 overscan = camera.overscanPixels;
    if (overscan != glm::ivec2(0)) {
        return cameraOptionsText(camera.withoutOverscan()) + " --overscan " +
               joinNumbers({double(overscan.x), double(overscan.y)}, ",");
    }
    const glm::ivec2 size = camera.sizePixels;
    std::string text = "--projection " + projectionName(camera.projection);
    if (camera.projection == Projection::kOrtho) {
        text += vectorOption("direction", camera.direction) + vectorOption("up", camera.up) +
                vectorOption("target", camera.targetWorld) + " --frame-width " +
                numberText(camera.frameWidthWorld) +
                " --distance=" + numberText(camera.targetDistanceWorld);
    } else {
        text += vectorOption("eye", camera.eyeWorld()) +
                vectorOption("direction", camera.direction) + vectorOption("up", camera.up);
        if (camera.projection == Projection::kPerspective)
            text += " --fov " + numberText(camera.fovDegrees());
        if (camera.nearWorld > 0) text += " --near " + numberText(camera.nearWorld);
    }
    if (camera.frameOffset() != glm::dvec2(0))
        text += " --frame-offset=" + numberText(camera.frameOffset());
    if (camera.pixelAspect != 1) text += " --pixel-aspect " + numberText(camera.pixelAspect);
    return text + " --size " + joinNumbers({double(size.x), double(size.y)}, "x");
}

Json cameraJson(const Camera& whole) {
    const Camera camera = whole.withoutOverscan();
    Json json = {{"projection", projectionName(camera.projection)}};
    if (camera.projection != Projection::kOrtho) {
        json["eye"] = vectorJson(camera.eyeWorld());
        json["near"] = camera.nearWorld;
    }
    if (camera.projection == Projection::kPerspective) json["fov"] = camera.fovDegrees();
    json.update({{"direction", vectorJson(camera.direction)},
                 {"right", vectorJson(camera.right)},
                 {"up", vectorJson(camera.up)},
                 {"target", vectorJson(camera.targetWorld)},
                 {"frame_width", camera.frameWidthWorld},
                 {"frame_offset", {camera.frameOffset().x, camera.frameOffset().y}},
                 {"pixel_aspect", camera.pixelAspect},
                 {"size", {camera.sizePixels.x, camera.sizePixels.y}},
                 {"options", cameraOptionsText(whole)}});
    const glm::ivec2 overscan = whole.overscanPixels;
    if (overscan != glm::ivec2(0)) json["overscan"] = {overscan.x, overscan.y};
    return json;
}

}  // namespace deltasplat
