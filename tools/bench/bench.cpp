// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <system_error>

#include "bench/bench_failures.h"
#include "bench/bench_page_file.h"
#include "bench/bench_report.h"
#include "camera/camera_options.h"
#include "listener.h"
#include "options/input_options.h"
#include "options/transfer_function_option.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "process/print_out.h"
#include "render/read_medium.h"
#include "render/render_input.h"
#include "render/render_options.h"
#include "subcommands.h"
#include "table1/bench_table1.h"

namespace deltasplat {
namespace {

// Share of a volume's progress that reading takes.
constexpr double kReadShare = 0.1;

struct BenchCommand {
    std::vector<std::string> inputs;
    int repeats = 7;
    bool json = false;
    std::filesystem::path report;  // empty: none
    PictureOptions picture;
};

// What has been measured, and what could not be: the rest is told all the same.
struct Findings {
    BenchReport report;
    std::vector<Error> failures;
};

void addBenchOptions(CLI::App& app, BenchCommand& command) {
    // Not required, since a required one would take the name of a subcommand for a file.
    app.add_option("INPUT", command.inputs,
                   std::string("Volumes to render, at least one: ") + kInputFormats)
        ->type_name("FILE")
        ->group("Arguments");
    OptionGroup group(app, "Measuring");
    group.addValue("--repeats", "N", command.repeats, wholeNumber(1, 100000),
                   withDefault("Rounds that count, after one to warm up; in each round each\n"
                               "method makes one picture",
                               std::to_string(command.repeats)));
    OptionGroup output(app, "Output");
    output.addFlag("--json", command.json, "Print one JSON object, times in seconds");
    output.addValue("--report", "DIR", command.report, anyText(),
                    "Folder to write index.html to, a page of pictures, bars and\n"
                    "tables that needs nothing else; made if it does not exist");
    addCameraOptions(app, command.picture);
    addOpticsOptions(app, command.picture);
    addSurfaceOptions(app, command.picture.surface, command.picture.render.optics.gradientOpacity);
    addShadingOptions(app, command.picture.shading);
    addScatterOptions(app, command.picture.scatter);
    addMediumOptions(app, command.picture.medium);
    addPartOptions(app, command.picture);
    addSplattingOptions(app, command.picture);
    addInputOptions(app, command.picture.read);
}

void warnOfUnusedOptions(const CLI::App& app, const BenchCommand& command,
                         ProgressDisplay& display) {
    Files inputs(command.inputs.begin(), command.inputs.end());
    const Files mask = filesOfMask(command.picture.parts);
    inputs.insert(inputs.end(), mask.begin(), mask.end());
    warnOfUnusedInputOptions(app, inputs, display.stage(0, 0));
    warnOfUnusedScatterOptions(app, command.picture.scatter, command.picture.shading,
                               command.picture.medium.emissionLights.has_value(), display);
    if (isGiven(app, "--background") && command.report.empty())
        display.warn("--background: has no effect without --report");
}

void measure(const CLI::App& app, const std::string& input, const BenchCommand& command,
             RenderOptions options, ProgressDisplay& display, double begin, double end,
             Findings& found) {
    const double read = begin + (end - begin) * kReadShare;
    try {
        const Volume volume =
            readToRender(input, command.picture, options, display.stage(begin, read));
        warnOfUnusedView(app, options.camera, volume, display.stage(read, read));
        found.report.entries.push_back(
            {input, modeName(command.picture.render.mode),
             measureMethods(volume, options, command.repeats, display.stage(read, end))});
    } catch (const Error& error) {
        if (error.code() == ErrorCode::kInterrupted) throw;
        found.failures.push_back(error);
    }
}

Findings measureAll(const CLI::App& app, const BenchCommand& command, const Session& session) {
    Findings found;
    found.report.machine = thisMachine();
    found.report.commandLine = session.commandLine;
    ProgressDisplay display(session.common);
    warnOfUnusedOptions(app, command, display);
    const RenderOptions options = readOptics(command.picture, display.stage(0, 0));
    const double count = double(command.inputs.size());
    double done = 0;
    for (const std::string& input : command.inputs) {
        measure(app, input, command, options, display, done / count, (done + 1) / count, found);
        ++done;
    }
    return found;
}

void checkReport(const BenchCommand& command) {
    checkPageFolder(command.report, command.picture.render.camera.sizePixels);
    const std::filesystem::path page = pageIn(command.report);
    std::error_code ignored;
    if (!exists(page, ignored)) return;
    checkOutput("--report", page, filesRead(filesOfMask(command.picture.parts), {}), "the mask");
    const Files inputs(command.inputs.begin(), command.inputs.end());
    checkOutput("--report", page,
                filesRead(inputs, parseTransferFunction(command.picture.transferFunction).file),
                "the inputs and the transfer function");
}

void runBench(const CLI::App& app, BenchCommand command, const Session& session) {
    requireArgument(!command.inputs.empty(), "INPUT", "FILE (see 'deltasplat bench --help')");
    applyProjection(app, command.picture.render.camera);
    {
        ProgressDisplay display(session.common);
        applyCamera(app, {}, command.picture, display.stage(0, 0));
    }
    checkCamera(command.picture.render.camera);
    applyLayers(app, command.picture);
    applySurface(app, command.picture.render.mode, isFog(command.picture), command.picture.surface,
                 command.picture.read);
    if (!command.report.empty()) checkReport(command);
    Findings found = measureAll(app, command, session);
    if (!found.report.entries.empty()) {
        printOut(command.json ? jsonText(found.report) : plainText(found.report));
        if (!command.report.empty())
            writePage(command.report, pageText(found.report, command.picture.background));
    }
    for (const BenchEntry& entry : found.report.entries) addDifference(entry, found.failures);
    throwFailures(found.failures);
    allIsWritten();
}

}  // namespace

Subcommand addBench(CLI::App& program) {
    const auto command = std::make_shared<BenchCommand>();
    CLI::App& app = addSubcommand(
        program, "bench", "Measures the four methods side by side on volumes.",
        {"deltasplat bench smoke.vdb --view iso --threads 1 --report out",
         "deltasplat bench engine_256x256x128_uint8.raw.gz head.vdb --tf examples/ct.json "
         "--repeats 9 --json",
         "deltasplat bench table1 data"});
    Subcommand bench{&app, [&app, command] { addBenchOptions(app, *command); },
                     [&app, command](const Session& session) { runBench(app, *command, session); }};
    bench.nested.push_back(addTable1(app));
    return bench;
}

}  // namespace deltasplat
