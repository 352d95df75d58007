// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <limits>
#include <memory>
#include <thread>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/synth/write_analytic.h"
#include "formats/input_files.h"
#include "listener.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "process/print_out.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

struct SynthOptions {
    std::string name;
    std::filesystem::path output;
    std::uint64_t seed = 1;
    double noise = 0;
    AnalyticFileOptions file;
};

// Keeps to the size of a voxel index; how much is too much is for the writer to say.
Parser<glm::ivec3> sampleDimensions() {
    return [](const std::string& option, const std::string& text) {
        const glm::i64vec3 dims = dimensions()(option, text);
        constexpr std::int64_t kMax = std::numeric_limits<int>::max();
        for (int axis = 0; axis < 3; ++axis) {
            if (dims[axis] < 1 || dims[axis] > kMax) {
                throw Error(ErrorCode::kUsage, option, text,
                            "AxBxC, three whole numbers from 1 to " + std::to_string(kMax));
            }
        }
        return glm::ivec3(dims);
    };
}

void declareOptions(CLI::App& app, SynthOptions& options) {
    OptionGroup arguments(app, "Arguments");
    arguments.addValue("NAME", "WORD", options.name, anyText(),
                       joinWords(analyticNames(), "or") + "; without it, lists them");
    arguments.addValue("OUTPUT", "FILE", options.output, anyText(),
                       "File to write, .raw (give the dims and the type in its name\n"
                       "and it can be read without options) or .vdb, which alone holds\n"
                       "the several grids of fire (density, temperature in kelvin, flame)\n"
                       "and explosion (density, temperature, colours Cd)");

    OptionGroup sample(app, "Sample");
    const glm::ivec3 dims = options.file.dims;
    sample.addValue(
        "--dims", "AxBxC", options.file.dims, sampleDimensions(),
        withDefault("Voxels along x, y, z",
                    joinNumbers({double(dims.x), double(dims.y), double(dims.z)}, "x")));
    sample.addValue(
        "--seed", "N", options.seed, wholeNumber(),
        withDefault("Chooses the shape of cloud, vessels, fire and explosion,\nand noise",
                    std::to_string(options.seed)));
    sample.addValue(
        "--noise", "S", options.noise, number(0, 1),
        withDefault(
            "Standard deviation of the engine's and the vessels' noise,\n1 = the value range",
            numberText(options.noise)));
    sample.addValue("--samples", "N", options.file.samples, wholeNumber(1, 16),
                    withDefault("Samples along each axis that a voxel is the mean of, 1 to 16, as\n"
                                "scanners see edges; not for labels",
                                std::to_string(options.file.samples)));
    sample.addValue("--type", "TYPE", options.file.type, choice({"uint8", "uint16", "float32"}),
                    "Value type of a .raw: uint8, uint16 or float32 (default uint8);\n"
                    "a .vdb always holds floats");
    const glm::dvec3 spacing = options.file.spacing;
    sample.addValue("--spacing", "X,Y,Z", options.file.spacing, voxelSpacing(),
                    withDefault("World units per voxel (.vdb)",
                                joinNumbers({spacing.x, spacing.y, spacing.z}, ",")));
}

void warnOfUnusedOptions(const CLI::App& app, const SynthOptions& options,
                         ProgressDisplay& display) {
    if (isGiven(app, "--noise") && options.name != "engine" && options.name != "vessels")
        display.warn("--noise: has no effect on a volume other than engine and vessels");
    if (isGiven(app, "--spacing") && lowerCase(options.output.extension().string()) != ".vdb")
        display.warn("--spacing: has no effect without a .vdb output");
}

void runSynth(const CLI::App& app, SynthOptions options, const Session& session) {
    options.output = plainName(options.output);
    if (options.name.empty()) {
        std::string list;
        for (const std::string& name : analyticNames()) list += name + "\n";
        return printOut(list);
    }
    const AnalyticVolume volume = makeAnalytic(options.name, options.seed, options.noise);
    requireArgument(!options.output.empty(), "OUTPUT", "FILE (see 'deltasplat synth --help')");
    refuseLog("OUTPUT", options.output);
    ProgressDisplay display(session.common);
    warnOfUnusedOptions(app, options, display);
    writeAnalytic(volume, options.output, options.file, display.stage(0, 1));
    allIsWritten();
}

}  // namespace

Subcommand addSynth(CLI::App& program) {
    const auto options = std::make_shared<SynthOptions>();
    CLI::App& app = addSubcommand(program, "synth", "Writes a sample volume known in closed form.",
                                  {"deltasplat synth cloud cloud.vdb --dims 128x128x128 --seed 7",
                                   "deltasplat synth engine engine_256x256x128_uint8.raw "
                                   "--dims 256x256x128 --noise 0.01"});
    return {&app, [&app, options] { declareOptions(app, *options); },
            [&app, options](const Session& session) { runSynth(app, *options, session); }};
}

}  // namespace deltasplat
