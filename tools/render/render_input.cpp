// SPDX-License-Identifier: Apache-2.0
#include "render/render_input.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/default_ramp.h"
#include "optics/label_function.h"
#include "optics/transfer_function.h"
#include "optics/value_colors.h"
#include "options/transfer_function_option.h"
#include "render/read_medium.h"
#include "render/scene_input.h"

namespace deltasplat {
namespace {

// Who sees little of it should know why.
void warnOfOtherData(const Preset& preset, const Volume& volume, const Listener& listener) {
    if (volume.empty()) return;
    const std::string values =
        "values from " + numberText(volume.valueMin()) + " to " + numberText(volume.valueMax());
    // Around whatever is scanned is air, and in it fat.
    if (preset.values == Preset::Values::kHounsfield && volume.valueMin() >= 0) {
        listener.warn("--tf: " + preset.name + " is for Hounsfield units (air -1000, water 0); " +
                      values + " seem to be others");
    }
    if (preset.values != Preset::Values::kLabels) return;
    if (isHounsfield(volume)) {
        listener.warn("--tf: " + preset.name + " is for labels; " + values +
                      " seem to be Hounsfield units, for which there are ct-bone and others");
    }
    if (const std::optional<double> broken = anyBroken(volume)) {
        listener.warn("--tf: " + preset.name + " is for whole numbers, and " + values +
                      " lie between, such as " + numberText(*broken));
    }
    if (volume.valueMax() > kLargestPresetLabel) {
        listener.warn("--tf: " + preset.name + " has colours for 1 to " +
                      std::to_string(kLargestPresetLabel) + ", and of the " + values +
                      " those that are more are clear");
    }
}

// The preset that is named or, where nothing is, that of a CT scan for one, and that of labels for
// what is said to be labels; else null.
const Preset* presetOf(const PictureOptions& picture, const Volume& volume) {
    if (!picture.transferFunction.empty())
        return parseTransferFunction(picture.transferFunction).preset;
    const bool isFree = picture.render.mode == Mode::kComposite && !picture.render.optics.range;
    return isFree ? defaultPreset(volume) : nullptr;
}

// Surfaces are shaded unless something else is wanted: those of level sets and of scanned bodies.
std::optional<Shading> shadingOf(const PictureOptions& picture, const Volume& volume,
                                 const Preset* preset, bool isSurface) {
    if (picture.render.mode != Mode::kComposite || isFog(picture)) return {};
    const bool isScan = preset && preset->values == Preset::Values::kHounsfield;
    const bool byValue = picture.render.optics.colorBy == ColorBy::kValue;
    return picture.shading.of(byValue && (isScan || isSurface || volume.fromLevelSet()));
}

// What is asked for may not be of two kinds.
void checkSurface(const PictureOptions& picture) {
    if (!picture.surface.asked) return;
    const std::string option = picture.surface.isovalue ? "--isovalue" : "--surface";
    const Optics& optics = picture.render.optics;
    if (optics.colorBy != ColorBy::kValue) {
        throw Error(ErrorCode::kUsage, option,
                    "--color-by " + colorByName(optics.colorBy) + " besides", "--color-by value");
    }
    if (picture.surface.isFogGiven) {
        throw Error(ErrorCode::kUsage, option, "--level-set fog besides", "--level-set keep");
    }
    if (optics.gradientOpacity.empty()) return;
    throw Error(ErrorCode::kUsage, option, "--gradient-opacity besides", "one of the two");
}

// Surfaces know no other lights.
void checkDistant(const std::vector<Light>& lights) {
    for (const Light& light : lights) {
        if (!light.positionWorld) continue;
        throw Error(ErrorCode::kUsage, "--light", "point:X,Y,Z without --lighting scatter",
                    "head, X,Y,Z or view:X,Y,Z");
    }
}

// The same of fog.
void checkFog(const PictureOptions& picture) {
    if (!picture.scatter.asked()) checkDistant(picture.shading.lights);
    if (!isFog(picture)) return;
    const MediumChoice& medium = picture.medium;
    const std::string option = picture.scatter.asked() ? "--lighting scatter"
                               : medium.emissionGrid   ? "--emission-grid"
                               : medium.colorGrid      ? "--color-grid"
                                                       : "--layer";
    const Optics& optics = picture.render.optics;
    const char* besides = picture.shading.shades.value_or(false) ? "--shade besides"
                          : picture.surface.isovalue             ? "--isovalue besides"
                          : picture.surface.asked                ? "--surface besides"
                          : !optics.gradientOpacity.empty()      ? "--gradient-opacity besides"
                                                                 : nullptr;
    if (besides) throw Error(ErrorCode::kUsage, option, besides, "one of the two");
    if (optics.colorBy != ColorBy::kValue) {
        throw Error(ErrorCode::kUsage, option,
                    "--color-by " + colorByName(optics.colorBy) + " besides", "--color-by value");
    }
    if (!picture.scatter.asked()) return;
    for (const Light& light : picture.shading.lights) {
        if (light.frame == LightFrame::kWorld) continue;
        throw Error(ErrorCode::kUsage, "--light", "head or view:X,Y,Z with --lighting scatter",
                    "X,Y,Z, the way that light travels in the world, or point:X,Y,Z");
    }
}

// Fire is made lights for fog that scatters them.
void checkEmissionLights(const PictureOptions& picture) {
    if (!picture.medium.emissionLights || picture.render.mode != Mode::kComposite) return;
    const bool burns = picture.medium.burns();
    if (burns && picture.scatter.asked()) return;
    throw Error(ErrorCode::kUsage, "--emission-lights",
                burns ? "it without --lighting scatter" : "it without fire",
                burns ? "--lighting scatter, fog that they light"
                      : "--emission-grid, or a --layer shown as fire");
}

// Where values are all on one side, there is nothing to see but where the volume ends.
void warnOfNoSurface(const Volume& volume, double isovalue, const Listener& listener) {
    double low = volume.valueMin();
    double high = volume.valueMax();
    if (volume.hasBackground()) {
        low = std::min(low, volume.background());
        high = std::max(high, volume.background());
    }
    const bool isBelow = isLevelSet(volume);  // inside of a surface
    const bool isAllInside = isBelow ? high <= isovalue : low >= isovalue;
    const bool isAllOutside = isBelow ? low > isovalue : high < isovalue;
    if (!isAllInside && !isAllOutside) return;
    const std::string range = low < high
                                  ? "values from " + numberText(low) + " to " + numberText(high)
                                  : "a volume of value " + numberText(low);
    listener.warn("--isovalue: got " + numberText(isovalue) + ", which " + range +
                  (low < high ? " never pass: " : " never passes: ") +
                  (isAllInside ? "all is inside, and shown is all of the volume, as a solid"
                               : "nothing is inside"));
}

// A surface has the colour that values have there, if that is asked for and it has no other.
void finishSurface(const PictureOptions& picture, const Volume& volume, Optics& optics,
                   const Listener& listener) {
    const double isovalue = optics.surface->isovalue;
    if (!picture.transferFunction.empty() && !picture.surface.color)
        optics.surface->color = glm::dvec3(ValueColors(volume, optics).colorOf(float(isovalue)));
    if (volume.empty()) return;
    warnOfNoSurface(volume, isovalue, listener);
}

}  // namespace

RenderOptions readOptics(const PictureOptions& picture, const Listener& listener) {
    RenderOptions options = picture.render;
    options.splat.mostJoined = picture.join.value_or(kMostJoined);
    const ColorBy colorBy = options.optics.colorBy;
    if (picture.shading.asked() && !isFog(picture) && colorBy != ColorBy::kValue) {
        throw Error(ErrorCode::kUsage, "--shade", "--color-by " + colorByName(colorBy) + " besides",
                    "--color-by value");
    }
    checkSurface(picture);
    checkFog(picture);
    checkEmissionLights(picture);
    const bool ramp = picture.transferFunction.empty();
    if (!ramp) {
        options.optics.transferFunction =
            readTransferFunctionOption(picture.transferFunction, listener);
    }
    if (options.optics.range && !ramp && !options.optics.transferFunction.normalized)
        listener.warn("--range: has no effect on a transfer function that is not normalized");
    return options;
}

glm::dvec3 upOf(const PictureOptions& picture, const Volume& volume) {
    const glm::dvec3 up = volume.space().empty() ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    if (picture.upWorld) return *picture.upWorld;
    return picture.render.camera.up.value_or(up);
}

namespace {

bool mixesVoxels(const PictureOptions& picture) {
    return picture.render.mode != Mode::kComposite || picture.render.splat.between.value_or(0) > 0;
}

// Labels stand apart; what is between two of them looks like a third.
// @param option  that says there are labels, or the file that does
void warnOfMixedLabels(const std::string& option, const PictureOptions& picture,
                       const Listener& listener) {
    const Mode mode = picture.render.mode;
    if (!mixesVoxels(picture)) return;
    const std::string what = mode == Mode::kComposite
                                 ? "--between " + std::to_string(*picture.render.splat.between)
                                 : "--mode " + modeName(mode);
    listener.warn(option + ": " + what +
                  " mixes values of neighbouring voxels, so that between labels it shows others "
                  "that are not there; " +
                  (mode == Mode::kComposite ? "--between 0" : "composite") + " keeps them apart");
}

// What is said of a volume that a table of labels shows.
// @param who  says that there are labels
void warnOfLabels(const std::string& who, const PictureOptions& picture, const Preset* preset,
                  const Volume& volume, const TransferFunction& table, const Listener& listener) {
    const bool isShown = picture.render.mode == Mode::kComposite || picture.render.mipColors;
    if (!isShown) return;
    warnOfMixedLabels(who, picture, listener);
    warnOfAbsentLabels(picture.parts.labels, table, volume, listener);
    // The preset has all labels that there are.
    if (!preset) warnOfUnlistedLabels(picture.parts.labels, table, volume, listener);
}

// Who sees little of a volume, and has not asked for that, should know why.
void warnOfHidden(const std::filesystem::path& input, const Volume& volume,
                  const TransferFunction& ramp, const Listener& listener) {
    constexpr double kMuch = 0.5;
    const double share = hiddenShare(volume, ramp, {});
    if (share <= kMuch) return;
    const auto clear =
        std::ranges::find(ramp.opacities, 0.0, &TransferFunction::OpacityPoint::opacity);
    if (clear == ramp.opacities.end()) return;
    const char* const side = clear == ramp.opacities.begin()     ? " or less"
                             : clear + 1 == ramp.opacities.end() ? " or more"
                                                                 : "";
    listener.warn(input.string() + ": " + std::to_string(int(100 * share)) +
                  " % of the voxels are not shown: their values are " + numberText(clear->x) +
                  side + ", where the ramp is clear; --range LO,HI has it begin elsewhere");
}

// Puts into `options` what depends on the volume: all of it, whatever is cut off.
// @param isWhole  what will be seen is that volume
void fitOptics(const std::filesystem::path& input, const PictureOptions& picture,
               const Volume& volume, bool isWhole, RenderOptions& options,
               const Listener& listener) {
    const Preset* preset = presetOf(picture, volume);
    const std::optional<glm::dvec2>& range = picture.render.optics.range;
    options.optics.surface = picture.surface.of(volume);
    options.optics.shading = shadingOf(picture, volume, preset, options.optics.surface.has_value());
    if (picture.render.mode == Mode::kComposite)
        options.optics.scattering =
            picture.scatter.of(picture.shading, picture.medium.emissionLights.has_value(),
                               upOf(picture, volume), listener);
    if (options.optics.shading && !isWhole) options.optics.shading->noise = gradientNoise(volume);
    if (preset && !options.optics.surface) warnOfOtherData(*preset, volume, listener);
    if (picture.transferFunction.empty()) {
        const bool isOfValues = picture.render.mode != Mode::kComposite;
        options.optics.transferFunction =
            preset  ? presetFunction(preset->name)
            : range ? (isOfValues ? wholeRamp(volume, *range) : defaultRamp(volume, *range))
                    : (isOfValues ? wholeRamp(volume) : defaultRamp(volume));
        if (!preset && !range && !isOfValues && !options.optics.surface)
            warnOfHidden(input, volume, options.optics.transferFunction, listener);
    } else {
        if (preset) fitPreset(*preset, volume, options.optics);
        const bool isOpen = options.optics.transferFunction.normalized && !options.optics.range;
        if (isOpen && !isWhole) options.optics.range = defaultRange(volume);
    }
    // Labels that a file gives colours have those.
    if (preset && preset->name == kLabelPreset && volume.labels())
        options.optics.transferFunction =
            withColors(options.optics.transferFunction, *volume.labels());
    options.optics.transferFunction =
        changeLabels(options.optics.transferFunction, picture.parts.labels);
    const bool saysTable = !picture.transferFunction.empty();
    if (options.optics.transferFunction.categorical && !options.optics.surface) {
        warnOfLabels(saysTable ? "--tf" : input.string(), picture, preset, volume,
                     options.optics.transferFunction, listener);
    } else if (!saysTable && mixesVoxels(picture) && holdsLabels(volume)) {
        warnOfMixedLabels(input.string(), picture, listener);
    }
    if (options.optics.surface) {
        if (holdsLabels(volume))
            listener.warn(input.string() +
                          ": a surface takes labels for quantities; without it --show-labels shows "
                          "some of them");
        finishSurface(picture, volume, options.optics, listener);
    }
}

// Notes what of a frame is in the picture.
Volume seenIn(Volume volume, const Optics& optics, const FrameLook* look) {
    if (!look) return volume;
    look->sequence.addSeen(look->frame, volume);
    for (const MediumPart& part : optics.parts) look->sequence.addSeen(look->frame, *part.volume);
    return volume;
}

// Whether it is asked for to make some values clear. Without a transfer function all but the least
// are shown.
bool hidesSome(const PictureOptions& picture, const Optics& optics) {
    if (picture.transferFunction.empty()) return optics.range.has_value();
    const Preset* const preset = parseTransferFunction(picture.transferFunction).preset;
    const bool isShaded = preset && preset->values == Preset::Values::kHounsfield;
    return !isShaded && hidesValues(optics.transferFunction, optics.range.has_value());
}

// Whether a picture may do without most voxels, for all that is known before they are read: X-rays
// count all, and whoever lights what is shown, or looks at how much values change, asks for all.
bool mayShowSome(const PictureOptions& picture, const Optics& optics) {
    return picture.render.mode == Mode::kComposite && !picture.surface.asked &&
           !picture.shading.asked() && !isFog(picture) && optics.gradientOpacity.empty() &&
           hidesSome(picture, optics);
}

// Returns which values are shown, as far as that is known.
std::function<bool(const std::string&, double)> shownFirst(const PictureOptions& picture,
                                                           const Optics& optics) {
    const std::optional<glm::dvec2> range = optics.range;
    if (picture.transferFunction.empty()) {
        // The default ramp.
        return [range](const std::string&, double value) { return range && value > range->x; };
    }
    return [function = optics.transferFunction, range](const std::string& type, double value) {
        return showsValue(function, range, type, value);
    };
}

}  // namespace

Volume readToRender(const std::filesystem::path& input, const PictureOptions& picture,
                    RenderOptions& options, const Listener& listener, const FrameLook* look) {
    ReadOptions read = picture.read;
    if (!read.paletteNumbers && isForLabels(picture.transferFunction)) read.paletteNumbers = true;
    if (picture.surface.asked || picture.surface.ofLevelSets)
        read.levelSetSurface = {picture.surface.isovalue.value_or(0), picture.parts.cuts()};
    read.keepInexact = picture.render.mode != Mode::kComposite;
    // Frames are kept, many at a time, and told by what they take.
    read.readLater = !look && mayShowSome(picture, options.optics);
    if (read.readLater) read.isWanted = shownFirst(picture, options.optics);
    Volume volume = placed(
        look ? look->sequence.read(input, read, listener) : readVolume(input, read, listener),
        picture, {{}, listener.warning});
    if (measuresMillimetres(picture.render) && volume.lengthUnit().empty()) {
        listener.warn(input.string() + ": names no unit of length; " +
                      (picture.render.mode == Mode::kDrr ? "--mode drr" : "--sid") +
                      " takes its lengths for millimetres");
    }
    fitOptics(input, picture, look ? look->standIn(kMainGrid, volume) : volume,
              !look && !picture.parts.cuts(), options, listener);
    if (options.optics.surface) options.optics.densityScale.reset();
    if (picture.render.mode == Mode::kComposite)
        readMedium(input, picture, volume, options.optics, listener, look);
    if (!picture.parts.cuts()) return seenIn(std::move(volume), options.optics, look);
    return seenIn(cutAsChosen(volume, input, picture.parts, picture.read, listener), options.optics,
                  look);
}

RenderOptions opticsFor(const Volume& volume, const std::filesystem::path& input,
                        const PictureOptions& picture, const Listener& listener,
                        const FrameLook& look) {
    RenderOptions options = readOptics(picture, listener);
    fitOptics(input, picture, look.standIn(kMainGrid, volume), false, options, listener);
    if (options.optics.surface) options.optics.densityScale.reset();
    return options;
}

ReadScene readScene(const std::filesystem::path& input, const PictureOptions& picture,
                    const Listener& listener, const FrameLook* look) {
    RenderOptions options = readOptics(picture, listener);
    Volume volume = readToRender(input, picture, options, listener, look);
    return {options, std::make_shared<const Volume>(std::move(volume))};
}

}  // namespace deltasplat
