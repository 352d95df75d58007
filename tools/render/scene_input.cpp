// SPDX-License-Identifier: Apache-2.0
#include "render/scene_input.h"

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/file_and_name.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

// Nothing if it is no scene.
std::optional<FileAndName> sceneOf(const std::filesystem::path& input) {
    const std::string text = input.string();
    const std::string ending = lowerCase(input.extension().string());
    const bool isNamed = text.find(".usda:") != std::string::npos;
    if (ending != ".usda" && !isNamed) {
        if (ending != ".usd" && ending != ".usdc" && ending != ".usdz") return {};
        throw Error(ErrorCode::kInput, text, "USD that is no text",
                    ".usda, as usdcat -o x.usda writes it");
    }
    const std::optional<FileAndName> found = findFileAndName("INPUT", input);
    return found ? found : FileAndName{input, ""};
}

// In place of a file that a scene has not: no name of one.
std::filesystem::path missingFile(const SceneChoice& scene) {
    return scene.file / "filePath";
}

UsdVolume volumeAt(const SceneChoice& scene, std::optional<int> frame) {
    const std::vector<double>& frames = scene.motion->frames;
    return scene.motion->at(frame ? *frame : frames.empty() ? 0 : frames.front());
}

// What is up in a scene, y or z, is up for a camera that does not say; who looks straight down or
// up has at the top of the picture what the views top and bottom have.
void takeUp(const glm::dvec3& up, CameraOptions& camera) {
    camera.up = up;
    std::optional<glm::dvec3> direction = camera.direction;
    if (!direction && camera.eyeWorld && camera.targetWorld)
        direction = *camera.targetWorld - *camera.eyeWorld;
    if (!direction) return;
    const double across = glm::length(glm::cross(*direction, up));
    if (across > 1e-9 * glm::length(*direction)) return;
    const glm::dvec3 behind = up.z == 1 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    camera.up = glm::dot(*direction, up) < 0 ? behind : -behind;
}

}  // namespace

bool measuresMillimetres(const RenderOptions& render) {
    return render.mode == Mode::kDrr || render.camera.sourceToDetectorWorld.has_value();
}

Volume placed(const Volume& volume, const PictureOptions& picture, const Listener& listener) {
    const RenderOptions& render = picture.render;
    const double millimetres = millimetresIn(volume.lengthUnit());
    glm::dmat4 place = volume.worldFromIndex();
    std::string unit = volume.lengthUnit();
    if (measuresMillimetres(render) && millimetres > 0 && millimetres != 1) {
        listener.warn(volume.name() + ": lengths are in " + unit +
                      ", and are turned into millimetres, as are those of all options");
        scaleLengths(place, millimetres);
        unit = "mm";
    }
    place = picture.worldFromInput * place;
    requirePlacement(volume.name(), "a place in the scene", place);
    return volume.withPlace(place, volume.space(), unit);
}

void applyScene(const CLI::App& app, const std::vector<int>& frames, RenderCommand& command,
                const Listener& listener) {
    const std::optional<FileAndName> found = sceneOf(command.input);
    if (!found) return;
    SceneChoice& scene = command.scene;
    scene.file = found->file;
    scene.motion = readUsdVolume(found->file, found->name, listener);
    scene.isGridGiven = isGiven(app, "--grid");
    CameraOptions& camera = command.picture.render.camera;
    if (!camera.up && scene.motion->upWorld) {
        command.picture.upWorld = scene.motion->upWorld;
        takeUp(*scene.motion->upWorld, camera);
    }
    if (!frames.empty()) {
        // Each frame has its own; until then the first one's will do.
        showFrame(frames.front(), scene.moves() ? scene.file : std::filesystem::path(), command);
        return;
    }
    if (scene.motion->frames.size() > 1)
        listener.warn(scene.file.string() +
                      ": the volume changes, and is shown as it is at frame " +
                      numberText(scene.motion->frames.front()) + "; --frames shows others");
    showFrame({}, {}, command);
}

void showFrame(std::optional<int> frame, const std::filesystem::path& input,
               RenderCommand& command) {
    if (!input.empty()) command.input = input;
    const SceneChoice& scene = command.scene;
    if (!scene.motion) return;
    const UsdVolume volume = volumeAt(scene, frame);
    if (input.empty()) command.input = volume.file;
    if (command.input.empty() || command.input == missingFile(scene)) {
        throw Error(ErrorCode::kInput, scene.file.string(), "no filePath of a volume", "a .vdb");
    }
    command.picture.worldFromInput = volume.worldFromVolume;
    if (scene.isGridGiven) return;
    command.picture.read.gridName.reset();
    if (!volume.grid.empty()) command.picture.read.gridName = volume.grid;
}

std::vector<FrameFiles> withScene(const SceneChoice& scene, std::vector<FrameFiles> frames) {
    if (!scene.motion) return frames;
    for (FrameFiles& files : frames) {
        files.input = volumeAt(scene, files.frame).file;
        if (files.input.empty()) files.input = missingFile(scene);
    }
    return frames;
}

}  // namespace deltasplat
