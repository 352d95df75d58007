// SPDX-License-Identifier: Apache-2.0
#include "camera/camera_options.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <string>

#include "base/affine.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/input_files.h"
#include "options/command_line.h"
#include "options/file_and_name.h"
#include "sequence/frame_name.h"
#include "text/short_number.h"

namespace deltasplat {
namespace {

// Of lengths that people read.
constexpr double kShortShare = 1e-4;

std::string shortText(double number) {
    return shortNumberText(number, kShortShare);
}

constexpr const char* kPlaces[] = {"--view", "--azimuth",  "--elevation", "--roll",
                                   "--eye",  "--distance", "--direction", "--target",
                                   "--sid",  "--sdd",      "--detector"};
constexpr const char* kLenses[] = {"--camera-matrix", "--projection",  "--fov",
                                   "--focal",         "--aperture",    "--frame-width",
                                   "--frame-offset",  "--pixel-aspect"};

void requireOnce(const CLI::App& app, const std::string& option, const char* other) {
    if (!isGiven(app, other)) return;
    throw Error(ErrorCode::kUsage, other, "it and " + option, "the camera one way or the other");
}

CameraMotion readOne(const std::filesystem::path& given, const Listener& listener) {
    const std::optional<FileAndName> found = findFileAndName("--camera", given);
    return found ? readCamera(found->file, found->name, listener) : readCamera(given, "", listener);
}

// Reads the files of frames that have one each.
void readEach(const FrameName& name, const FrameChoice& frames, CameraChoice& choice,
              const Listener& listener) {
    for (const int frame : frames.frames) {
        try {
            choice.ofFrames.emplace(frame, readOne(name.at(frame), listener));
        } catch (const Error& error) {
            if (!frames.keepGoing || error.code() != ErrorCode::kInput) throw;
            choice.unread.emplace(frame, error);
        }
    }
    if (choice.ofFrames.empty()) throw choice.unread.begin()->second;
    choice.motion = choice.ofFrames.begin()->second;
}

const CameraMotion& motionOf(const CameraChoice& choice, std::optional<int> frame) {
    if (!frame || choice.ofFrames.empty()) return choice.motion;
    const auto unread = choice.unread.find(*frame);
    if (unread != choice.unread.end()) throw unread->second;
    return choice.ofFrames.at(*frame);
}

FilmCamera filmAt(const CameraChoice& choice, std::optional<int> frame) {
    const CameraMotion& motion = motionOf(choice, frame);
    if (frame) return motion.at(*frame);
    return motion.at(motion.frames.empty() ? 0 : motion.frames.front());
}

// Reads where a C-arm stands, which says all of the camera but its target.
void usePoses(const CLI::App& app, PictureOptions& options) {
    for (const char* other : kPlaces)
        if (std::string(other) != "--target") requireOnce(app, "--poses", other);
    for (const char* other : kLenses) requireOnce(app, "--poses", other);
    requireOnce(app, "--poses", "--up");
    requireOnce(app, "--poses", "--camera");
    options.camera.poses = readPoses(options.camera.posesFile);
    applyPose(options.camera.poses.front(), options.render.camera);
}

const CArmPose& poseAt(const CameraChoice& choice, int frame) {
    const auto count = int(choice.poses.size());
    if (frame >= 1 && frame <= count) return choice.poses[std::size_t(frame) - 1];
    throw Error(ErrorCode::kUsage, "--frames", std::to_string(frame),
                "1 to " + std::to_string(count) + ", a line of --poses for each");
}

// Frames before the first key and behind the last.
void warnOfHolding(const CameraChoice& choice, const std::vector<int>& frames,
                   const Listener& listener) {
    const std::vector<double>& keys = choice.motion.frames;
    if (keys.empty()) return;
    const auto isOutside = [&](int frame) { return frame < keys.front() || frame > keys.back(); };
    const auto count = std::count_if(frames.begin(), frames.end(), isOutside);
    if (count == 0) return;
    listener.warn("--camera: its keys are frames " + numberText(keys.front()) + " to " +
                  numberText(keys.back()) + ", and " + std::to_string(count) + " of " +
                  std::to_string(frames.size()) +
                  " frames, which are not between them, are shown by the nearest");
}

}  // namespace

void addCameraFileOptions(CLI::App& app, PictureOptions& options) {
    CameraOptions& camera = options.render.camera;
    OptionGroup group(app, "Camera");
    group.addValue("--camera", "FILE", options.camera.file, anyText(),
                   "Camera of another program in place of the options above but --up\n"
                   "(of --sky and --ground), --near and --size: .json\n"
                   "(docs/cameras.md), .usda (FILE:/World/cam, if it has several) or\n"
                   ".exr (worldToCamera and worldToNDC of a picture). With --frames it\n"
                   "may move, or have #### or $F4 in its name");
    group.addValue("--camera-matrix", "M", camera.worldFromCamera, matrix4(),
                   "Where the camera stands, in place of --view, --eye and the like: 16\n"
                   "numbers, row by row, the translation in the last row, as Houdini,\n"
                   "Maya and USD write camera-to-world (x right, y up, looks along -z)");
    group.addValue("--frame-offset", "X,Y", camera.frameOffset, vector2(kMostFrameOffset),
                   withDefault("How far the middle of the picture lies to the right of and above\n"
                               "the line of sight, in widths and heights of the picture",
                               numberText(camera.frameOffset)));
    group.addValue("--pixel-aspect", "A", camera.pixelAspect,
                   number(kLeastPixelAspect, kMostPixelAspect),
                   withDefault("Width of a pixel over its height", numberText(camera.pixelAspect)));
}

void applyCamera(const CLI::App& app, const FrameChoice& choiceOfFrames, PictureOptions& options,
                 const Listener& listener) {
    const std::vector<int>& frames = choiceOfFrames.frames;
    CameraChoice& choice = options.camera;
    if (!choice.posesFile.empty()) {
        usePoses(app, options);
        for (const int frame : frames) poseAt(choice, frame);
        return;
    }
    if (options.render.camera.worldFromCamera && !choice.asked())
        for (const char* other : kPlaces) requireOnce(app, "--camera-matrix", other);
    if (!choice.asked()) return;
    for (const char* other : kPlaces) requireOnce(app, "--camera", other);
    for (const char* other : kLenses) requireOnce(app, "--camera", other);

    const std::optional<FrameName> name = cameraFiles(options);
    if (name && !frames.empty()) {
        readEach(*name, choiceOfFrames, choice, listener);
    } else {
        choice.file = plainInput(choice.file);
        choice.motion = readOne(choice.file, listener);
    }
    if (frames.empty() && choice.motion.frames.size() > 1)
        listener.warn("--camera: it moves, and is shown where it is at frame " +
                      numberText(choice.motion.frames.front()) + "; --frames shows others");
    warnOfHolding(choice, frames, listener);

    CameraOptions& camera = options.render.camera;
    const FilmCamera film = filmAt(choice, {});
    if (!isGiven(app, "--size")) {
        if (film.projection == Projection::kLatlong) camera.sizePixels = {1024, 512};
        if (film.sizePixels) camera.sizePixels = *film.sizePixels;
    }
    if (!camera.up) camera.up = choice.motion.upWorld;
    choice.isNearGiven = isGiven(app, "--near");
    const auto isRead = [&](int frame) { return !choice.unread.contains(frame); };
    const auto first = std::find_if(frames.begin(), frames.end(), isRead);
    camera = cameraAt(options, first == frames.end() ? std::nullopt : std::optional(*first));
}

std::optional<FrameName> cameraFiles(const PictureOptions& options) {
    const std::filesystem::path& file = options.camera.file;
    if (!hasSigns(file.string()) || findFileAndName("--camera", file)) return {};
    return FrameName::find(file);
}

std::filesystem::path cameraFile(const PictureOptions& options) {
    if (!options.camera.posesFile.empty()) return options.camera.posesFile;
    const std::filesystem::path& given = options.camera.file;
    const std::optional<FileAndName> found = findFileAndName("--camera", given);
    return found ? found->file : given;
}

bool cameraMoves(const PictureOptions& options) {
    return options.camera.moves();
}

CameraOptions cameraAt(const PictureOptions& options, std::optional<int> frame) {
    const CameraOptions& given = options.render.camera;
    if (frame && !options.camera.poses.empty()) {
        CameraOptions posed = given;
        applyPose(poseAt(options.camera, *frame), posed);
        return posed;
    }
    CameraOptions camera = cameraOptions(filmAt(options.camera, frame), given.sizePixels);
    camera.up = given.up;
    if (options.camera.isNearGiven) camera.nearWorld = given.nearWorld;
    return camera;
}

void warnOfClipping(const PictureOptions& options, std::optional<int> frame, const Volume& volume,
                    const Listener& listener) {
    if (!options.camera.asked() || volume.empty()) return;
    const FilmCamera film = filmAt(options.camera, frame);
    const Camera camera = makeCamera(options.render.camera, volume);
    // Lengths of the camera's own, in the world.
    const double scale = glm::length(glm::dvec3(film.worldFromCamera[0]));
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = -nearest;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(volume.box(), corner), 1);
        const glm::dvec3 away = glm::dvec3(volume.worldFromIndex() * index) - camera.eyeWorld();
        nearest = std::min(nearest, glm::dot(away, camera.direction));
        farthest = std::max(farthest, glm::dot(away, camera.direction));
    }
    if (film.farWorld && farthest > scale * *film.farWorld)
        listener.warn("--camera: the volume reaches " + shortText(farthest) +
                      " from the camera, and is seen beyond its far plane at " +
                      shortText(scale * *film.farWorld) + " as well");
    const double near = scale * film.nearWorld;
    if (film.projection == Projection::kOrtho && near > 0 && nearest < near)
        listener.warn("--camera: the volume begins " + shortText(nearest) +
                      " from the camera, and is seen before its near plane at " + shortText(near) +
                      " as well");
}

}  // namespace deltasplat
