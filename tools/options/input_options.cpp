// SPDX-License-Identifier: Apache-2.0
#include "options/input_options.h"

#include <set>

#include "deltasplat/error.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"

namespace deltasplat {
namespace {

const char* levelSetName(bool toFog) {
    return toFog ? "fog" : "keep";
}

std::string vectorText(const glm::dvec3& v) {
    return joinNumbers({v.x, v.y, v.z}, ",");
}

Parser<bool> levelSet() {
    return [](const std::string& option, const std::string& text) {
        return choice({"fog", "keep"})(option, text) == "fog";
    };
}

Parser<bool> endian() {
    return [](const std::string& option, const std::string& text) {
        return choice({"little", "big"})(option, text) == "big";
    };
}

Parser<bool> palette() {
    return [](const std::string& option, const std::string& text) {
        return choice({"index", "color"})(option, text) == "index";
    };
}

}  // namespace

void addInputOptions(CLI::App& app, ReadOptions& options) {
    OptionGroup vdb(app, "Input, .vdb");
    vdb.addValue("--grid", "NAME", options.gridName, anyText(),
                 "Grid to read, \"\" being one without a name (default where one is\n"
                 "wanted: the one named density, else the first fog volume, else\n"
                 "the first other scalar grid, phi, phi_*, flags, shadow and other\n"
                 "helpers last; otherwise all of them; vector and point grids are\n"
                 "never read)");
    vdb.addValue("--level-set", "fog|keep", options.levelSetToFog, levelSet(),
                 withDefault("Turn level sets into fog, or keep their distances",
                             levelSetName(options.levelSetToFog)));

    RawFormat& raw = options.raw;
    OptionGroup group(app, "Input, .raw and .raw.gz");
    group.addValue("--dims", "AxBxC", raw.dims, dimensions(),
                   "Voxels along x (fastest), y, z (default: as in a name such as\n"
                   "engine_256x256x128_uint8.raw.gz)");
    group.addValue(
        "--type", "TYPE", raw.type,
        choice({"uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"}),
        "uint8 int8 uint16 int16 uint32 int32 float32 or float64\n"
        "(default: as in the name)");
    group.addValue("--endian", "little|big", raw.bigEndian, endian(),
                   "Byte order (default: as in the name, else little)");
    group.addValue("--skip-bytes", "N", raw.skipBytes, wholeNumber(),
                   withDefault("Header bytes to pass over", std::to_string(raw.skipBytes)));

    OptionGroup several(app, "Input, several volumes");
    several.addValue("--volume", "N", options.volume, wholeNumber(),
                     "NIfTI, NRRD, MetaImage and .npy of more than three axes, TIFF of several\n"
                     "channels or times: which volume, from 0 on (without it they are an error;\n"
                     "info tells how many there are); .seg.nrrd: which layer (without it all\n"
                     "as one, later segments on top)");
    several.addValue("--series", "UID", options.series, anyText(),
                     "DICOM folder of several series: which one (without it they are\n"
                     "an error; info lists them)");

    OptionGroup(app, "Input, images")
        .addValue("--palette", "index|color", options.paletteNumbers, palette(),
                  "Read the numbers of a palette's colours, as labels are kept, or the\n"
                  "colours' luminance (default color, which is said; index with labels\n"
                  "as --tf, and of ImageJ's palettes, which show values)");

    OptionGroup place(app, "Input, .raw, .raw.gz, .npy and images");
    place.addValue("--spacing", "X,Y,Z", raw.spacing, voxelSpacing(),
                   "World units per voxel (default 1,1,1, or what an image says)");
    place.addValue(
        "--origin", "X,Y,Z", raw.origin, vector3(1e15),
        withDefault("World position of the centre of voxel 0,0,0", vectorText(raw.origin)));

    OptionGroup any(app, "Input");
    any.addValue("--nan", "VALUE", options.nanValue, number(),
                 "Replaces NaN and infinities (default: they are an error)");
    addConfineOption(app);
}

void addConfineOption(CLI::App& app) {
    app.add_flag_callback("--confine", confineInputs,
                          "Read no file outside of the input's folder, as headers and\n"
                          "links may name them (default: as they say)")
        ->group("Input");
}

namespace {

// What chooses among volumes is no remark to pass over: something else would be read.
void requireChoice(const CLI::App& app, const std::string& option, bool meant,
                   const std::string& inputs) {
    if (meant || !isGiven(app, option)) return;
    throw Error(ErrorCode::kUsage, option, app.get_option(option)->as<std::string>(),
                "it with " + inputs + " input");
}

}  // namespace

void warnOfUnusedInputOptions(const CLI::App& app, const std::vector<std::filesystem::path>& inputs,
                              const Listener& listener) {
    std::set<const Format*> formats;
    bool anyTiff = false;
    for (const std::filesystem::path& input : inputs) {
        // What is wrong with an input is for its reader to say.
        try {
            const InputKind kind = findInput(input, {});
            formats.insert(kind.format);
            anyTiff = anyTiff || isTiffName(kind.files.front());
        } catch (const Error&) {
            return;
        }
    }
    const auto isAny = [&](bool Format::*flag) {
        return std::any_of(formats.begin(), formats.end(),
                           [&](const Format* format) { return format->*flag; });
    };
    const bool isAllPlaced = std::all_of(formats.begin(), formats.end(),
                                         [](const Format* format) { return format->saysPlace; });
    requireChoice(app, "--volume", anyTiff || isAny(&Format::mayHoldSeveral),
                  "a .nii, .nrrd, .mha, .npy or .tif");
    requireChoice(app, "--series", formats.contains(&dicomFormat()), "a DICOM");
    const auto warnOf = [&](const std::vector<std::string>& options, const std::string& input) {
        const std::string remark = ": has no effect without " + input;
        for (const std::string& option : options) {
            if (isGiven(app, option)) listener.warn(option + remark);
        }
    };
    if (!formats.contains(&vdbFormat())) {
        warnOf({"--grid", "--level-set"}, "a .vdb input");
    }
    if (!formats.contains(&rawVolumeFormat())) {
        warnOf({"--dims", "--type", "--endian", "--skip-bytes"}, "a .raw or .raw.gz input");
    }
    if (!formats.contains(&imageFormat())) warnOf({"--palette"}, "an input of images");
    if (isAllPlaced) {
        warnOf({"--spacing", "--origin"}, "an input of raw values or images");
    }
}

}  // namespace deltasplat
