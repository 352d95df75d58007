// SPDX-License-Identifier: Apache-2.0
#include "render/read_medium.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "ingest/files/input_kind.h"
#include "medium/part_sampler.h"
#include "number_text.h"
#include "options/parse.h"
#include "options/transfer_function_option.h"
#include "text/short_number.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

// Nothing that is hot enough to glow has fewer kelvin.
constexpr double kLeastKelvin = 500;
// What 1 stands for where values are no kelvin.
constexpr double kKelvinOfOne = 2000;

std::string namesOf(const std::vector<VolumeEntry>& entries) {
    std::string names;
    for (const VolumeEntry& entry : entries)
        names += (names.empty() ? "" : ", ") + entry.name + " (" + entry.type + ")";
    return names;
}

void requireVdb(const std::filesystem::path& input, const std::string& option) {
    if (findInput(input, {}).format == InputKind::Format::kVdb) return;
    throw Error(ErrorCode::kUsage,
                gotExpected(option, "it with " + input.string(), "it with a .vdb input"));
}

// The grid that is asked for, if it is "auto" the one that names tell.
std::string chosen(const std::string& option, const std::string& asked, const std::string& found,
                   const std::vector<VolumeEntry>& entries) {
    if (asked != "auto") return asked;
    if (!found.empty()) return found;
    throw Error(ErrorCode::kInput, gotExpected(option, "auto and no grid of such a name",
                                               "the name of one of " + namesOf(entries)));
}

class MediumReader {
  public:
    MediumReader(const std::filesystem::path& input, const PictureOptions& picture,
                 const Volume& volume, const Listener& listener)
        : input_(input), picture_(picture), volume_(volume), listener_(listener) {}

    std::shared_ptr<const Volume> read(const std::string& option, const std::string& grid) {
        ReadOptions read = picture_.read;
        read.gridName = grid;
        read.keepInexact = false;
        Volume volume = readVolume(input_, read, listener_);
        if (volume.empty()) return {};
        warnOfPlace(option, volume);
        return cut(option, std::move(volume));
    }

    MediumPart fire(const std::string& option, const std::string& grid) {
        const MediumChoice& choice = picture_.medium;
        MediumPart part;
        part.volume = read(option, grid);
        part.strength = choice.emissionStrength;
        if (!choice.emissionFunction.empty()) {
            part.kind = MediumPart::Kind::kEmission;
            part.transferFunction = readTransferFunctionOption(choice.emissionFunction, listener_);
            part.range = choice.emissionRange;
        } else if (part.volume) {
            setKelvin(option, grid, part);
        }
        return part;
    }

    MediumPart fog(const std::string& option, const LayerChoice& layer) {
        MediumPart part;
        part.volume = read(option, layer.grid);
        part.kind = MediumPart::Kind::kAbsorption;
        part.transferFunction = readTransferFunctionOption(layer.transferFunction, listener_);
        part.strength = picture_.render.optics.extinctionScale;
        return part;
    }

  private:
    // Says how kelvin were made of values that are none.
    void setKelvin(const std::string& option, const std::string& grid, MediumPart& part) {
        const double most = part.volume->valueMax;
        const std::string values = "values of " + grid + ", " + numberText(part.volume->valueMin) +
                                   " to " + numberText(most) + ", ";
        if (const auto& kelvin = picture_.medium.kelvin) {
            part.kelvinScale = kelvin->x;
            part.kelvinOffset = kelvin->y;
        } else if (most < kLeastKelvin) {
            part.kelvinScale = kKelvinOfOne;
            listener_.warn(option + ": " + values + "seem to be no kelvin; 1 is taken for " +
                           numberText(kKelvinOfOne) + " K (--temperature-scale)");
        } else if (part.volume->valueMin < 0) {
            listener_.warn(option + ": " + values +
                           "are taken for kelvin, of which there are none below 0; "
                           "--temperature-scale 1,273.15 takes degrees Celsius");
        }
        const double hottest = part.kelvinScale * most + part.kelvinOffset;
        if (hottest > kLeastKelvin) return;
        listener_.warn(option + ": nothing of " + grid + " glows, for the hottest has " +
                       shortNumberText(hottest, 1e-3) + " K, and nothing below 500 K is seen to");
    }

    // One line where voxels are not the volume's.
    void warnOfPlace(const std::string& option, const Volume& part) {
        const WorldBox own = worldBox(part.box, part.worldFromIndex);
        const WorldBox other = worldBox(volume_.box, volume_.worldFromIndex);
        const bool isApart = glm::any(glm::greaterThan(own.min, other.max)) ||
                             glm::any(glm::greaterThan(other.min, own.max));
        if (isApart && !volume_.empty()) {
            listener_.warn(option + ": grid " + part.name + " lies from " + numberText(own.min) +
                           " to " + numberText(own.max) + " and nowhere in " + volume_.name +
                           ", which lies from " + numberText(other.min) + " to " +
                           numberText(other.max));
        }
        const PartFit fit =
            PartSampler(part, volume_.worldFromIndex, PartSampler::Around::kBackground).fit();
        if (fit == PartFit::kSame) return;
        listener_.warn(
            option + ": grid " + part.name + " has voxels of " + numberText(part.voxelSize()) +
            ", " + volume_.name + " of " + numberText(volume_.voxelSize()) +
            (fit == PartFit::kFiner ? ": the mean of those that fall into one of these is shown"
                                    : ", or lies between these: read between them"));
    }

    // As the volume was.
    std::shared_ptr<const Volume> cut(const std::string& option, Volume part) {
        const CutChoice& parts = picture_.parts;
        if (!parts.cuts()) return std::make_shared<const Volume>(std::move(part));
        const bool byIndex = parts.cut.cropIndex || !parts.slices.empty();
        if (byIndex && part.worldFromIndex != volume_.worldFromIndex) {
            throw Error(ErrorCode::kUsage,
                        gotExpected(option,
                                    "grid " + part.name +
                                        ", whose voxels are others than "
                                        "those that are cropped by their indices",
                                    "--crop-world or --clip-plane"));
        }
        try {
            return std::make_shared<const Volume>(
                cutAsChosen(part, input_, parts, picture_.read, listener_));
        } catch (const Error& error) {
            // Nothing of it is left.
            if (error.code() != ErrorCode::kUsage) throw;
            return {};
        }
    }

    const std::filesystem::path& input_;
    const PictureOptions& picture_;
    const Volume& volume_;
    const Listener& listener_;
};

void readColors(const std::string& name, const std::vector<VolumeEntry>& entries,
                MediumReader& reader, Optics& optics) {
    constexpr const char* kOption = "--color-grid";
    std::vector<std::string> names = splitAt(name, ',');
    if (names.size() == 1) {
        const auto found = std::find_if(entries.begin(), entries.end(),
                                        [&](const auto& entry) { return entry.name == name; });
        if (found == entries.end() || !isColorType(found->type)) {
            throw Error(ErrorCode::kInput,
                        gotExpected(kOption,
                                    found == entries.end() ? "no grid \"" + name + "\""
                                                           : name + " of type " + found->type,
                                    "a vec3s or vec3d grid, or three of floats R,G,B, of " +
                                        namesOf(entries)));
        }
        names = {name + ".x", name + ".y", name + ".z"};
    }
    if (names.size() != 3) {
        throw Error(ErrorCode::kUsage,
                    gotExpected(kOption, name, "one vector grid, or three of floats R,G,B"));
    }
    ColorGrids grids;
    for (std::size_t c = 0; c < 3; ++c) {
        grids[c] = reader.read(kOption, names[c]);
        if (!grids[c]) return;
        if (grids[c]->valueMin >= 0) continue;
        throw Error(ErrorCode::kInput,
                    gotExpected(kOption, names[c] + " of " + numberText(grids[c]->valueMin),
                                "colours of at least 0"));
    }
    optics.colorGrids = grids;
}

}  // namespace

void applyLayers(const CLI::App& app, PictureOptions& picture) {
    MediumChoice& medium = picture.medium;
    if (medium.layers.empty()) return;
    for (const char* option : {"--grid", "--tf", "--emission-grid", "--surface", "--isovalue"}) {
        if (!isGiven(app, option)) continue;
        throw Error(ErrorCode::kUsage,
                    gotExpected("--layer", std::string(option) + " besides", "one of the two"));
    }
    // What swallows light comes first; where nothing does, there is but fire in nothing.
    const auto fog = std::find_if(medium.layers.begin(), medium.layers.end(),
                                  [](const auto& one) { return !one.transferFunction.empty(); });
    if (fog == medium.layers.end()) {
        picture.read.gridName = medium.layers.front().grid;
        picture.isClear = true;
        return;
    }
    picture.read.gridName = fog->grid;
    picture.transferFunction = fog->transferFunction;
    medium.layers.erase(fog);
}

void readMedium(const std::filesystem::path& input, const PictureOptions& picture,
                const Volume& volume, Optics& optics, const Listener& listener) {
    const MediumChoice& choice = picture.medium;
    if (picture.isClear) {
        optics.transferFunction = TransferFunction();
        optics.transferFunction.colors = {{0, glm::dvec3(1)}};
        optics.transferFunction.opacities = {{0, 0, 0.5, 0}};
    }
    if (!choice.asked()) return;
    requireVdb(input, choice.emissionGrid ? "--emission-grid"
                      : choice.colorGrid  ? "--color-grid"
                                          : "--layer");
    const std::vector<VolumeEntry> entries = listVolumes(input);
    const MediumGrids found = mediumGrids(entries);
    MediumReader reader(input, picture, volume, listener);
    const auto add = [&](MediumPart part) {
        if (part.volume) optics.parts.push_back(std::move(part));
    };
    if (choice.emissionGrid) {
        constexpr const char* kOption = "--emission-grid";
        add(reader.fire(kOption, chosen(kOption, *choice.emissionGrid, found.emission, entries)));
    }
    for (const LayerChoice& layer : choice.layers) {
        add(layer.transferFunction.empty() ? reader.fire("--layer", layer.grid)
                                           : reader.fog("--layer", layer));
    }
    if (choice.colorGrid) {
        readColors(chosen("--color-grid", *choice.colorGrid, found.color, entries), entries, reader,
                   optics);
    }
}

}  // namespace deltasplat
