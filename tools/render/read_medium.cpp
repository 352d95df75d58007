// SPDX-License-Identifier: Apache-2.0
#include "render/read_medium.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/affine.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/optics/emission_lights.h"
#include "deltasplat/optics/presets.h"
#include "formats/format.h"
#include "formats/input_kind.h"
#include "lighting/part_sampler.h"
#include "optics/color_space.h"
#include "options/parse.h"
#include "options/transfer_function_option.h"
#include "render/scene_input.h"
#include "text/short_number.h"

namespace deltasplat {
namespace {

// What reaches no more is no kelvin; what 1 stands for then.
constexpr double kMostShare = 20;
constexpr double kKelvinOfOne = 2000;

std::string namesOf(const std::vector<VolumeEntry>& entries) {
    std::vector<std::string> names;
    for (const VolumeEntry& entry : entries) names.push_back(entry.name + " (" + entry.type + ")");
    return nameList(names);
}

void requireVdb(const std::filesystem::path& input, const std::string& option) {
    if (findInput(input, {}).is(vdbFormat())) return;
    throw Error(ErrorCode::kUsage, option, "it with " + input.string(), "it with a .vdb input");
}

// The grid that is asked for, if it is "auto" the one that names tell.
std::string chosen(const std::string& option, const std::string& asked, const std::string& found,
                   const std::vector<VolumeEntry>& entries) {
    if (asked != "auto") return asked;
    if (!found.empty()) return found;
    throw Error(ErrorCode::kInput, option, "auto and no grid of such a name",
                "the name of one of " + namesOf(entries));
}

class MediumReader {
  public:
    MediumReader(const std::filesystem::path& input, const PictureOptions& picture,
                 const Volume& volume, const FrameLook* look, const Listener& listener)
        : input_(input), picture_(picture), volume_(volume), look_(look), listener_(listener) {}

    // Reads a whole grid; null if nothing of it is active.
    std::shared_ptr<const Volume> read(const std::string& option, const std::string& grid) {
        ReadOptions read = picture_.read;
        read.gridName = grid;
        read.keepInexact = false;
        auto volume = std::make_shared<const Volume>(
            placed(look_ ? look_->sequence.read(input_, read, listener_)
                         : readVolume(input_, read, listener_),
                   picture_));
        whole_ = look_ ? &look_->standIn(grid, *volume) : volume.get();
        isDark_ = whole_->empty();
        if (volume->empty()) return {};
        fit_ = fitOf(*volume, volume_.worldFromIndex());
        warnOfPlace(option, *volume);
        return volume;
    }

    MediumPart fire(const std::string& option, const std::string& grid) {
        const MediumChoice& choice = picture_.medium;
        MediumPart part;
        part.volume = read(option, grid);
        if (!part.volume) return part;
        part.strength = choice.emissionStrength;
        if (choice.emissionFunction.empty()) {
            setKelvin(option, grid, part);
        } else {
            part.kind = MediumPart::Kind::kEmission;
            setFunction(option, choice.emissionFunction, choice.emissionRange, part);
        }
        part.volume = cut(option, part.volume);
        return part;
    }

    MediumPart fog(const std::string& option, const LayerChoice& layer) {
        MediumPart part;
        part.volume = read(option, layer.grid);
        if (!part.volume) return part;
        part.kind = MediumPart::Kind::kAbsorption;
        part.strength = picture_.render.optics.extinctionScale;
        setFunction(option, layer.transferFunction, picture_.render.optics.range, part);
        part.volume = cut(option, part.volume);
        return part;
    }

    // Cut as the volume was.
    std::shared_ptr<const Volume> cut(const std::string& option,
                                      const std::shared_ptr<const Volume>& part) {
        const CutChoice& parts = picture_.parts;
        if (!parts.cuts()) return part;
        if (fit_ != PartFit::kSame || part->worldFromIndex() != volume_.worldFromIndex()) {
            throw Error(ErrorCode::kUsage, option,
                        "grid " + part->name() +
                            ", whose voxels are others than those "
                            "of " +
                            volume_.name() + ", which is cut",
                        "grids of the same voxels, or nothing cut");
        }
        try {
            return std::make_shared<const Volume>(
                cutAsChosen(*part, input_, parts, picture_.read, listener_));
        } catch (const Error& error) {
            // Nothing of it is left; whatever else is wrong is said when the volume is cut.
            if (error.code() != ErrorCode::kUsage && error.code() != ErrorCode::kInput) throw;
            return {};
        }
    }

    // Whether nothing of what was read last shines, in any frame.
    bool isDark() const { return isDark_; }

  private:
    // As the volume alone would be shown: by all of its values, whatever is cut off.
    void setFunction(const std::string& option, const std::filesystem::path& given,
                     const std::optional<glm::dvec2>& range, MediumPart& part) {
        Optics optics;
        optics.transferFunction = readTransferFunctionOption(given, listener_);
        optics.range = range;
        if (optics.transferFunction.categorical && fit_ != PartFit::kSame) {
            throw Error(ErrorCode::kUsage, option,
                        "labels of grid " + part.volume->name() +
                            ", whose voxels are "
                            "others than those of " +
                            volume_.name(),
                        "labels of the same voxels, for between two is a third");
        }
        if (const Preset* preset = parseTransferFunction(given).preset)
            fitPreset(*preset, *whole_, optics);
        if (optics.transferFunction.normalized && !optics.range)
            optics.range = defaultRange(*whole_);
        part.transferFunction = optics.transferFunction;
        part.range = optics.range;
    }

    // Says how kelvin were made of values that are none. A sequence must not change its mind with
    // its hottest voxel: only values that can hardly be kelvin of anything are scaled.
    void setKelvin(const std::string& option, const std::string& grid, MediumPart& part) {
        const double most = whole_->valueMax();
        const std::string values = "values of " + grid + ", " + numberText(whole_->valueMin()) +
                                   " to " + numberText(most) + ", ";
        if (const auto& kelvin = picture_.medium.kelvin) {
            part.kelvinScale = kelvin->x;
            part.kelvinOffset = kelvin->y;
        } else if (most <= kMostShare) {
            part.kelvinScale = kKelvinOfOne;
            listener_.warn(option + ": " + values + "seem to be no kelvin; 1 is taken for " +
                           numberText(kKelvinOfOne) + " K (--temperature-scale)");
        } else if (whole_->valueMin() < 0) {
            listener_.warn(option + ": " + values +
                           "are taken for kelvin, of which there are none below 0; "
                           "--temperature-scale 1,273.15 takes degrees Celsius");
        }
        const double hottest = part.kelvinScale * most + part.kelvinOffset;
        isDark_ = !(hottest > kDarkKelvin);
        if (isDark_) {
            listener_.warn(option + ": nothing of " + grid + " glows, for the hottest has " +
                           shortNumberText(hottest, 1e-3) + " K, and nothing below " +
                           numberText(kDarkKelvin) + " K is seen to");
        } else if (hottest > kHottestKelvin) {
            listener_.warn(option + ": " + values + "reach " + shortNumberText(hottest, 1e-3) +
                           " K; what is hotter than 100000 K is taken for that");
        }
    }

    // One line where voxels are not the volume's.
    void warnOfPlace(const std::string& option, const Volume& part) {
        const WorldBox own = worldBox(part.box(), part.worldFromIndex());
        const WorldBox other = worldBox(volume_.box(), volume_.worldFromIndex());
        const bool isApart = glm::any(glm::greaterThan(own.min, other.max)) ||
                             glm::any(glm::greaterThan(other.min, own.max));
        if (isApart && !volume_.empty()) {
            listener_.warn(option + ": grid " + part.name() + " lies from " + numberText(own.min) +
                           " to " + numberText(own.max) + " and nowhere in " + volume_.name() +
                           ", which lies from " + numberText(other.min) + " to " +
                           numberText(other.max));
        }
        if (fit_ == PartFit::kSame) return;
        listener_.warn(
            option + ": grid " + part.name() + " has voxels of " + numberText(part.voxelSize()) +
            ", " + volume_.name() + " of " + numberText(volume_.voxelSize()) +
            (fit_ == PartFit::kFiner ? ": the mean of those that fall into one of these is shown"
                                     : ", or lies between these: read between them"));
    }

    const std::filesystem::path& input_;
    const PictureOptions& picture_;
    const Volume& volume_;
    const FrameLook* look_;
    const Listener& listener_;
    const Volume* whole_ = nullptr;  // stands for the grid in hand, of all frames
    bool isDark_ = false;            // of what was read last
    PartFit fit_ = PartFit::kSame;   // of the grid in hand
};

void readColors(const std::string& name, const std::vector<VolumeEntry>& entries,
                MediumReader& reader, Optics& optics, const Listener& listener) {
    constexpr const char* kOption = "--color-grid";
    std::vector<std::string> names = splitAt(name, ',');
    if (names.size() == 1) {
        const auto found = std::find_if(entries.begin(), entries.end(),
                                        [&](const auto& entry) { return entry.name == name; });
        if (found == entries.end() || !isColorType(found->type)) {
            throw Error(ErrorCode::kInput, kOption,
                        found == entries.end() ? "no grid \"" + name + "\""
                                               : name + " of type " + found->type,
                        "a vec3s or vec3d grid, or three of floats R,G,B, of " + namesOf(entries));
        }
        names = {name + ".x", name + ".y", name + ".z"};
    }
    if (names.size() != 3) {
        throw Error(ErrorCode::kUsage, kOption, name, "one vector grid, or three of floats R,G,B");
    }
    ColorGrids grids;
    for (std::size_t c = 0; c < 3; ++c) {
        grids[c] = reader.read(kOption, names[c]);
        if (!grids[c]) return;
        if (grids[c]->valueMax() > kBrightestColor) {
            listener.warn(std::string(kOption) + ": colours of " + names[c] + " reach " +
                          numberText(grids[c]->valueMax()) +
                          "; what is more than 16 is taken for it");
        }
        if (grids[c]->valueMin() >= 0) continue;
        throw Error(ErrorCode::kInput, kOption,
                    names[c] + " of " + numberText(grids[c]->valueMin()), "colours of at least 0");
    }
    for (auto& grid : grids) {
        grid = reader.cut(kOption, grid);
        if (!grid) return;
    }
    optics.colorGrids = grids;
}

// Whether the volume itself is not shown, but what is besides.
bool isClear(const PictureOptions& picture) {
    return picture.medium.isLayered && picture.transferFunction.empty();
}

void addEmissionLights(const Volume& volume, int count, Optics& optics, const Listener& listener) {
    const std::vector<Light> fire = emissionLights(volume, optics, count);
    if (fire.empty()) listener.warn("--emission-lights: nothing shines that could light the fog");
    std::vector<Light>& lights = optics.scattering->lights;
    lights.insert(lights.end(), fire.begin(), fire.end());
}

}  // namespace

void applyLayers(const CLI::App& app, PictureOptions& picture) {
    MediumChoice& medium = picture.medium;
    if (medium.layers.empty() || picture.render.mode != Mode::kComposite) return;
    const std::size_t most = medium.colorGrid ? kMostPartsWithColors : kMostParts;
    if (medium.layers.size() > most + 1) {
        throw Error(
            ErrorCode::kUsage, "--layer", std::to_string(medium.layers.size()) + " of them",
            "at most " + std::to_string(most + 1) + (medium.colorGrid ? " with --color-grid" : ""));
    }
    const auto fogs = std::ranges::count_if(medium.layers, &LayerChoice::isFog);
    if (fogs > 1 && picture.scatter.asked()) {
        throw Error(ErrorCode::kUsage, "--layer",
                    "several that swallow light with --lighting scatter", "one, and fire");
    }
    medium.isLayered = true;
    for (const char* option : {"--grid", "--tf", "--emission-grid", "--surface", "--isovalue"}) {
        if (!isGiven(app, option)) continue;
        throw Error(ErrorCode::kUsage, "--layer", std::string(option) + " besides",
                    "one of the two");
    }
    // What swallows light comes first; where nothing does, there is but fire in nothing.
    const auto fog = std::ranges::find_if(medium.layers, &LayerChoice::isFog);
    if (fog == medium.layers.end()) {
        picture.read.gridName = medium.layers.front().grid;
        return;
    }
    picture.read.gridName = fog->grid;
    picture.transferFunction = fog->transferFunction;
    medium.layers.erase(fog);
}

void readMedium(const std::filesystem::path& input, const PictureOptions& picture,
                const Volume& volume, Optics& optics, const Listener& listener,
                const FrameLook* look) {
    const MediumChoice& choice = picture.medium;
    if (isClear(picture)) {
        optics.transferFunction = TransferFunction();
        optics.transferFunction.colors = {{0, glm::dvec3(1)}};
        optics.transferFunction.opacities = {{0, 0, 0.5, 0}};
        if (optics.densityScale || choice.colorGrid) {
            listener.warn(std::string(optics.densityScale ? "--density-scale" : "--color-grid") +
                          ": has no effect without a --layer that swallows light");
        }
        optics.densityScale.reset();
    }
    if (optics.densityScale && std::ranges::any_of(choice.layers, &LayerChoice::isFog)) {
        listener.warn(
            "--density-scale: is that of the first --layer that swallows light, not of others");
    }
    if (!choice.asked()) return;
    requireVdb(input, choice.emissionGrid ? "--emission-grid"
                      : choice.colorGrid  ? "--color-grid"
                                          : "--layer");
    const std::vector<VolumeEntry> entries = listVolumes(input);
    const MediumGrids found = mediumGrids(entries);
    MediumReader reader(input, picture, volume, look, listener);
    const auto add = [&](MediumPart part) {
        if (part.volume) optics.parts.push_back(std::move(part));
    };
    if (choice.emissionGrid) {
        constexpr const char* kOption = "--emission-grid";
        add(reader.fire(kOption, chosen(kOption, *choice.emissionGrid, found.emission, entries)));
        if (*choice.emissionGrid == "auto" && reader.isDark() && !found.otherEmission.empty()) {
            listener.warn(std::string(kOption) + ": auto takes " + found.emission +
                          ", nothing of which glows; " + found.otherEmission +
                          " is another that may, where it is named");
        }
    }
    for (const LayerChoice& layer : choice.layers) {
        add(layer.isFire() ? reader.fire("--layer", layer.grid) : reader.fog("--layer", layer));
    }
    if (choice.colorGrid) {
        readColors(chosen("--color-grid", *choice.colorGrid, found.color, entries), entries, reader,
                   optics, listener);
    }
    if (choice.emissionLights && optics.scattering)
        addEmissionLights(volume, *choice.emissionLights, optics, listener);
}

}  // namespace deltasplat
