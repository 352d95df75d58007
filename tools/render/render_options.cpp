// SPDX-License-Identifier: Apache-2.0
#include "render/render_options.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/text.h"
#include "camera/camera_options.h"
#include "deltasplat/error.h"
#include "deltasplat/splat/footprint.h"
#include "drawing/plot_file.h"
#include "options/input_options.h"
#include "process/print_out.h"
#include "program.h"
#include "render/annotation_options.h"
#include "render/aov_options.h"
#include "render/color_options.h"
#include "render/deep_options.h"
#include "render/exr_options.h"
#include "render/ground_options.h"
#include "render/list_presets.h"
#include "render/preview.h"
#include "render/render_batch.h"
#include "render/render_sequence.h"
#include "render/slab_options.h"
#include "render/tone_options.h"

namespace deltasplat {
namespace {

// One of some values, by their names.
template <typename T, typename NameOf>
Parser<T> named(std::vector<T> values, const NameOf& nameOf) {
    return
        [values = std::move(values), nameOf](const std::string& option, const std::string& text) {
            std::vector<std::string> names;
            for (const T value : values) {
                if (nameOf(value) == text) return value;
                names.push_back(nameOf(value));
            }
            throw Error(ErrorCode::kUsage, option, text,
                        joinWords(names, "or") + afterStop(suggestion(text, names)));
        };
}

Parser<Method> method() {
    return named<Method>({Method::kAuto, Method::kDelta, Method::kSparse, Method::kTraditional},
                         methodName);
}

Parser<PictureFilter> pictureFilter() {
    return named<PictureFilter>({PictureFilter::kCatmullRom, PictureFilter::kMitchell,
                                 PictureFilter::kGauss, PictureFilter::kBox},
                                pictureFilterName);
}

Parser<Mode> mode() {
    return named<Mode>(
        {Mode::kComposite, Mode::kXray, Mode::kMip, Mode::kMin, Mode::kAverage, Mode::kDrr},
        modeName);
}

Parser<Projection> projection() {
    return named<Projection>({Projection::kOrtho, Projection::kPerspective, Projection::kLatlong},
                             projectionName);
}

Parser<ColorBy> colorBy() {
    return named<ColorBy>({ColorBy::kValue, ColorBy::kX, ColorBy::kY, ColorBy::kZ, ColorBy::kIndex},
                          colorByName);
}

Parser<std::int64_t> bits() {
    return [](const std::string& option, const std::string& text) {
        return choice({"8", "16"})(option, text) == "8" ? 8 : 16;
    };
}

Parser<double> resolution() {
    return [](const std::string& option, const std::string& text) {
        if (text == "1/2" || text == "1/4" || text == "1/8" || text.starts_with("0."))
            throw Error(ErrorCode::kUsage, option, text,
                        "1 or more: voxels that share a pixel are softer, not faster; "
                        "a smaller --size is");
        return double(wholeNumber(1, kMaxResolution)(option, text));
    };
}

Parser<int> sliceCount() {
    return [](const std::string& option, const std::string& text) {
        return std::stoi(choice({"1", "2", "4", "8", "16", "32"})(option, text));
    };
}

Parser<bool> zeroOrOne() {
    return [](const std::string& option, const std::string& text) {
        return choice({"0", "1"})(option, text) == "1";
    };
}

// All of a value could not be held: what is left of it would be nothing.
Parser<double> relativeTolerance() {
    return [](const std::string& option, const std::string& text) {
        const double value = number(0)(option, text);
        if (value < 1) return value;
        throw Error(ErrorCode::kUsage, option, text,
                    "a finite number of at least 0 and less than 1");
    };
}

// What is there already may be the volume that the rest of the command line is about.
void listPresets(const std::string& file, bool isMoreGiven) {
    if (file.empty()) return printOut(presetList());
    std::error_code ignored;
    if (isMoreGiven && std::filesystem::exists(file, ignored)) {
        throw Error(ErrorCode::kUsage, "--list-tf", file + " (a file that exists)",
                    "a new one, or no other options");
    }
    writeDrawing(file, presetSwatches());
}

// A few to a line.
std::string presetNames() {
    constexpr std::size_t kMostInLine = 60;
    std::string text, line;
    for (const Preset& preset : presets()) {
        if (line.size() + preset.name.size() > kMostInLine) {
            text += "\n" + line;
            line.clear();
        }
        line += (line.empty() ? "" : " ") + preset.name;
        if (&preset != &presets().back()) line += ",";
    }
    return text + "\n" + line;
}

void addOutputOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    group.addValue("-o,--output", "FILE", command.output, anyText(),
                   "Picture to write: .exr (scene-linear, premultiplied) or .png, .tif\n"
                   "or .jpg (sRGB; a .jpg without alpha: over --background or black);\n"
                   "has to be given, but for a --movie; with --slab-range a .slabs");
    addStorageOptions(app, command.image);
    group.addValue("--stats", "FILE", command.stats, anyText(),
                   "JSON file to write: what was done, how long it took in seconds");
    addPreviewOption(app, command);
    addSlabOption(app, command.slabs);
}

void addModeOption(CLI::App& app, Mode& chosen) {
    OptionGroup group(app, "Optics");
    group.addValue("--mode", "NAME", chosen, mode(),
                   withDefault("composite (emission and absorption), xray (integral of the value\n"
                               "in world units), mip, min or average (largest or smallest value\n"
                               "along the line of sight, or the mean of active ones) or drr\n"
                               "(radiograph of a CT scan in Hounsfield units: which share of\n"
                               "x-rays gets through): all but the first interpolate values\n"
                               "trilinearly (xray and drr integrate that exactly; a pixel larger\n"
                               "than a voxel has the mean of its square), store them as\n"
                               "32-bit floats in an .exr, and are shown as greys elsewhere (mip,\n"
                               "min and average in the colours of --tf, if that is given; drr\n"
                               "white where little gets through)",
                               modeName(chosen)));
}

void addWindowOption(CLI::App& app, std::optional<glm::dvec2>& window) {
    OptionGroup group(app, "Optics");
    group.addValue("--window", "LO,HI", window, interval(),
                   "Values that black and white stand for in pictures, .exr aside, of\n"
                   "--mode xray (data units times world units), drr (attenuation,\n"
                   "-ln of the share that gets through), mip, min or average\n"
                   "(default: the 0.5th and the 99.5th percentile of the picture's;\n"
                   "for xray and drr black is at most 0)");
}

void addRayOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Optics");
    RenderOptions& options = command.picture.render;
    group.addFlag("--drr", command.drr, "The same as --mode drr");
    group.addValue(
        "--mu-water", "M", options.drr.muWater, positiveLength(),
        withDefault("drr: attenuation of water in 1/mm (of a voxel M (1 + HU / 1000), at\n"
                    "least 0), of photons of 50 to 60 keV",
                    numberText(options.drr.muWater)));
    group.addValue("--photons", "N", options.drr.photons, positiveLength(),
                   "drr: photons that a pixel of an .exr would get past nothing, > 0:\n"
                   "pixels count photons, without noise (default: shares, 0 to 1)");
    group.addValue("--depth-shade", "S", options.depthShade, number(0, 1),
                   withDefault("mip: how much darker the farthest place of the volume is shown\n"
                               "than the nearest, 0 to 1",
                               numberText(options.depthShade)));
}

void addMethodOption(CLI::App& app, Method& chosen) {
    OptionGroup group(app, "Splatting");
    group.addValue("--method", "NAME", chosen, method(),
                   withDefault("auto, delta, sparse or traditional: the same picture, bit for\n"
                               "bit, in different times",
                               methodName(chosen)));
}

}  // namespace

void addStorageOptions(CLI::App& app, ImageFileOptions& image) {
    OptionGroup group(app, "Output");
    group.addFlag("--float", image.floatExr,
                  "Store 32-bit floats in an .exr, not halves; numbers (--mode xray,\n"
                  "mip, min, average, drr) in a .tif as well, as .npy, .nrrd and .mha do");
    group.addValue(
        "--bits", "8|16", image.bits, bits(),
        withDefault("Bits per channel of a .png or .tif; of a .jpg 8", std::to_string(image.bits)));
    group.addValue("--dither", "0|1", image.dither, zeroOrOne(),
                   withDefault("Round up and down in a fixed pattern in pictures of 8 bits, so\n"
                               "that slow ramps show no steps",
                               image.dither ? "1" : "0"));
}

void addBackgroundOption(OptionGroup& group, std::optional<glm::vec4>& background) {
    group.addValue("--background", "R,G,B[,A]", background, color(),
                   "Scene-linear colour behind the volume (default: transparent)");
}

void addCameraOptions(CLI::App& app, PictureOptions& options) {
    CameraOptions& camera = options.render.camera;
    OptionGroup group(app, "Camera");
    group.addValue("--projection", "NAME", camera.projection, projection(),
                   withDefault("ortho (parallel lines of sight), perspective (from an eye) or\n"
                               "latlong (from an eye to all sides, twice as wide as high)",
                               projectionName(camera.projection)));
    group.addValue("--view", "NAME", camera.view, anyText(),
                   withDefault("Where the camera is, y up: front (+z) back (-z) right (+x)\n"
                               "left (-x) top (+y) bottom (-y) or iso (+x +y +z). Where the file\n"
                               "says how a patient lies (RAS, LPS): up is the head's direction,\n"
                               "front looks at the face, left and right at the patient's",
                               camera.view));
    group.addValue("--azimuth", "DEG", camera.azimuthDegrees, angle(),
                   withDefault("Turns the camera to its right, about the up axis through the\n"
                               "target, or through --eye, if that is given",
                               numberText(camera.azimuthDegrees)));
    group.addValue(
        "--elevation", "DEG", camera.elevationDegrees, angle(),
        withDefault("Then raises it over the target", numberText(camera.elevationDegrees)));
    group.addValue("--roll", "DEG", camera.rollDegrees, angle(),
                   withDefault("Then turns it clockwise about the line of sight",
                               numberText(camera.rollDegrees)));
    group.addValue("--direction", "X,Y,Z", camera.direction, vector3(),
                   "The way the line of sight travels, in world space; replaces\n"
                   "--view");
    group.addValue("--up", "X,Y,Z", camera.up, vector3(),
                   "What is up, in world space: views turn with it (default: 0,1,0, or\n"
                   "a patient's head)");
    group.addValue("--target", "X,Y,Z", camera.targetWorld, vector3(),
                   "World position in the middle of the picture (default: the\n"
                   "middle of the volume)");
    group.addValue("--frame-width", "W", camera.frameWidthWorld, positiveLength(),
                   "Width of the picture in world units (default: the volume fits)");
    group.addValue("--fov", "DEG", camera.fovDegrees, angleOfView(),
                   "perspective: vertical angle of view, less than 180 (default: " +
                       numberText(kDefaultFov) + ")");
    group.addValue("--focal", "MM", camera.focalMm, positiveLength(),
                   "perspective: focal length, instead of --fov (default with\n"
                   "--aperture: " +
                       numberText(kDefaultFocalMm) + ")");
    group.addValue("--aperture", "MM", camera.apertureMm, positiveLength(),
                   "perspective: width of the film back (default with --focal: " +
                       numberText(kDefaultApertureMm) + ")");
    group.addValue("--eye", "X,Y,Z", camera.eyeWorld, vector3(),
                   "perspective, latlong: world position of the eye, which looks at\n"
                   "the target, or in --direction (default: --distance from the\n"
                   "target; latlong: the target)");
    group.addValue("--distance", "D", camera.distanceWorld, number(-1e30, 1e30),
                   "perspective: from the eye to the target, in world units\n"
                   "(default: the volume fits); ortho: from where depths begin, which\n"
                   "moves no pixel (default: before the volume)");
    group.addValue("--sid", "D", camera.sourceToIsocenterWorld, positiveLength(),
                   "C-arm: from the source of x-rays (the eye) to the isocenter (the\n"
                   "target) in mm; with --sdd and --detector, implies --projection\n"
                   "perspective (plastimatch's --sad)");
    group.addValue("--sdd", "D", camera.sourceToDetectorWorld, positiveLength(),
                   "C-arm: from the source to the detector in mm, at least --sid\n"
                   "(plastimatch's --sid)");
    group.addValue("--detector", "WxH", camera.detectorWorld, lengthPair(),
                   "C-arm: width and height of the detector in mm; its pixels, as many\n"
                   "as --size says, must be square");
    group.addValue("--near", "D", camera.nearWorld, number(0),
                   withDefault("perspective, latlong: what is nearer to the eye is not seen",
                               numberText(camera.nearWorld)));
    group.addValue(
        "--size", "WxH", camera.sizePixels, pixelSize(),
        withDefault("Width and height in pixels; latlong 1024x512", dimsText(camera.sizePixels)));
    addCameraFileOptions(app, options);
}

void addOpticsOptions(CLI::App& app, PictureOptions& options) {
    Optics& optics = options.render.optics;
    OptionGroup group(app, "Optics");
    group.addValue("--tf", "FILE|PRESET", options.transferFunction, anyText(),
                   "Transfer function: a ParaView JSON file, FILE:NAME for one of\n"
                   "several in it, a table of labels (3D Slicer's .ctbl, ITK-SNAP's\n"
                   ".txt or .label; with --frames one for each, as tf.####.json), or a\n"
                   "preset:" +
                       presetNames() + "\n(default: " + kScanPreset +
                       " for CT scans, in Hounsfield units of a\n"
                       "patient, labels for files that say they hold some; else a ramp over the\n"
                       "1st to 99th percentile of the values: white for fog, and from the\n"
                       "background on; blue below and red above 0 where most values are near\n"
                       "0; else from black to white)");
    group.addQuestion("--list-tf", "FILE", listPresets,
                      "Only list the presets, or draw them to FILE (.png or .svg; with\n"
                      "other options a new one)");
    group.addValue("--range", "LO,HI", optics.range, interval(),
                   "Data values that 0 and 1 of a normalized transfer function\n"
                   "stand for (default: 0,255 for uint8, else all values; of a\n"
                   "preset the 1st to 99th percentile), or without --tf the ends of\n"
                   "the ramp");
    group.addValue("--unit-distance", "U", optics.unitDistance, positiveLength(),
                   "World units over which a voxel has the transfer function's\n"
                   "opacity (default: the smallest voxel size)");
    group.addValue("--extinction", "S", optics.extinctionScale, number(0, 1e30),
                   withDefault("Scales the extinction", numberText(optics.extinctionScale)));
    group.addValue("--density-scale", "S", optics.densityScale, number(0, 1e30),
                   "Extinction of a world unit of what has the value 1, to which it is\n"
                   "proportional, in place of the transfer function's opacity");
    group.addValue("--color-by", "WHAT", optics.colorBy, colorBy(),
                   withDefault("Where colours come from: value, the transfer function, or to find\n"
                               "one's way by x, y, z, from blue to red along the world's axis, or\n"
                               "index, which grows along i, j and k in red, green and blue",
                               colorByName(optics.colorBy)));
    addBackgroundOption(group, options.background);
}

void addPartOptions(CLI::App& app, PictureOptions& options) {
    addCutOptions(app, options.parts);
    addLabelOptions(app, options.parts.labels);
}

void addSplattingOptions(CLI::App& app, PictureOptions& picture) {
    RenderOptions& options = picture.render;
    OptionGroup group(app, "Splatting");
    group.addValue("--tolerance", "T", options.splat.tolerance.relative, relativeTolerance(),
                   withDefault("Stamp less: keep what a voxel was while it is within T times the\n"
                               "true one, 0 <= T < 1; how far the picture may be off is proved\n"
                               "(render --method auto: only of what is lit)",
                               numberText(options.splat.tolerance.relative)));
    group.addValue("--tolerance-value", "V", options.splat.tolerance.value, number(0),
                   withDefault("The same within V data units, which bounds no picture",
                               numberText(options.splat.tolerance.value)));
    group.addValue("--sigma", "V", options.splat.sigma, number(kMinSigma, kMaxSigma),
                   "Standard deviation of the footprint in voxels, " + numberText(kMinSigma) +
                       " to " + numberText(kMaxSigma) +
                       "\n(default: with one sheet pixel each, voxels, or what they are divided\n"
                       "into, are seen in it alone where they cover less than 3 pixels; else\n" +
                       numberText(kLeastSigma) + " of a voxel, growing to " +
                       numberText(kMostSigma) + " with what it covers)");
    group.addValue(
        "--between", "N", options.splat.between, wholeNumber(0, kMostBetween),
        "Slices put between two neighbouring ones, 0 to " + std::to_string(kMostBetween) +
            ", values mixed;\nif any, each voxel is also divided into 2x2 within its "
            "slice\n(default: 1 where a voxel covers 1.5 pixels or more and no\n"
            "--resolution is given, but not for thin fog (opacities up to\n0.25 a voxel), "
            "labels and colours that jump, nor more\nthan " +
            std::to_string(kMostDivided) + " blocks of voxels; else 0, and slices may\nbe joined)");
    group.addFlag("--keep-lone", options.splat.keepsLone,
                  "Of divided voxels, draws as a whole one that would hardly be seen between\n"
                  "its neighbours, so that no speck fades and thin things look thicker (else\n"
                  "as dense as it is on average, as ray casters show it)");
    group.addValue(
        "--join", "N", picture.join, sliceCount(),
        "Slices that may be drawn as one, 1, 2, 4, 8, 16 or 32, where a\nvoxel of a large volume "
        "covers half a pixel or less, and none of\nthe splatting options but --method and "
        "--filter is given (default:\n32, as far as so many voxels in a row cover four pixels; 2 "
        "where a\ncamera moves, frames show one volume, or parts are made with\n--slab-range); of "
        "16 or more also 2x2 voxels beside each other where one covers\n3/16 of a pixel or less, "
        "of 32 4x4 of at most 1/16, if it hardly shows");
    group.addValue("--resolution", "R", options.splat.resolution, resolution(),
                   "Sheet pixels per voxel, 1 to " + std::to_string(kMaxResolution) +
                       "\n(default: 1 or 2, chosen from the screen; 1/2 or 1/4 where\nvoxels "
                       "beside each other are joined)");
    group.addValue("--filter", "NAME", options.splat.filter, pictureFilter(),
                   withDefault("What makes pixels of the rendered plane: catmull-rom (sharp),\n"
                               "mitchell, gauss (soft) or box (the mean over a pixel)",
                               pictureFilterName(options.splat.filter)));
}

void addRenderOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup arguments(app, "Arguments");
    arguments
        .addValue("INPUT", "FILE", command.input, anyText(),
                  std::string("Volume to render: ") + kInputFormats +
                      "; or a scene with one, .usda; or a pattern in quotes, 'shots/**/*.vdb'")
        .required();
    addOutputOptions(app, command);
    addSequenceOptions(app, command);
    addBatchOptions(app, command);
    addToneOptions(app, command.tone);
    addColorOptions(app, command.color);
    addDeepOptions(app, command);
    addAovOptions(app, command);
    addExrOptions(app, command);
    addCameraOptions(app, command.picture);
    addModeOption(app, command.picture.render.mode);
    addRayOptions(app, command);
    addWindowOption(app, command.window);
    addOpticsOptions(app, command.picture);
    addSurfaceOptions(app, command.picture.surface, command.picture.render.optics.gradientOpacity);
    addShadingOptions(app, command.picture.shading);
    addScatterOptions(app, command.picture.scatter);
    addGroundOption(app, command.ground);
    addMediumOptions(app, command.picture.medium);
    addPartOptions(app, command.picture);
    addMethodOption(app, command.picture.render.splat.method);
    addSplattingOptions(app, command.picture);
    addAnnotationOptions(app, command.annotations);
    addInputOptions(app, command.picture.read);
}

void applyProjection(const CLI::App& app, CameraOptions& camera) {
    const bool isCArm =
        isGiven(app, "--sid") || isGiven(app, "--sdd") || isGiven(app, "--detector");
    if (isCArm && !isGiven(app, "--projection")) camera.projection = Projection::kPerspective;
    if (camera.projection == Projection::kLatlong && !isGiven(app, "--size"))
        camera.sizePixels = {1024, 512};
}

void checkCamera(const CameraOptions& camera) {
    // Any box will do to have the camera's own options checked; whether up is along the line of
    // sight may depend on whether the volume is a patient.
    const IndexBox box{glm::ivec3(0), glm::ivec3(1)};
    try {
        makeCamera(camera, box, glm::dmat4(1));
    } catch (const Error& error) {
        try {
            makeCamera(camera, box, glm::dmat4(1), "RAS");
        } catch (const Error&) {
            throw error;
        }
    }
}

void warnOfUnusedView(const CLI::App& app, const CameraOptions& options, const Volume& volume,
                      const Listener& listener) {
    if (!isGiven(app, "--view")) return;
    if (isGiven(app, "--direction")) return listener.warn("--view: has no effect with --direction");
    if (!options.eyeWorld) return;
    // An eye at the target, which may be the middle of the volume, looks as the view says.
    const Camera middle = makeCamera(CameraOptions(), volume);
    if (*options.eyeWorld != options.targetWorld.value_or(middle.targetWorld))
        listener.warn("--view: has no effect with --eye");
}

void warnOfDetector(const CameraOptions& options, const Volume& volume, const Listener& listener) {
    if (!options.sourceToDetectorWorld || volume.empty()) return;
    const Camera camera = makeCamera(options, volume);
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(volume.box(), corner), 1);
        const glm::dvec3 away = glm::dvec3(volume.worldFromIndex() * index) - camera.eyeWorld();
        farthest = std::max(farthest, glm::dot(away, camera.direction));
    }
    const double beyond = farthest - *options.sourceToDetectorWorld;
    if (beyond > 0) {
        listener.warn("--sdd: the volume reaches " + numberText(beyond) +
                      " beyond the detector, and counts there as well");
    }
}

}  // namespace deltasplat
