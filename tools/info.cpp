// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "deltasplat/ingest/read_volume.h"
#include "info_report.h"
#include "input_options.h"
#include "listener.h"
#include "subcommands.h"

namespace deltasplat {
namespace {

struct InfoOptions {
    std::vector<std::string> inputs;
    bool json = false;
    ReadOptions read;
};

GridReport reportOf(Volume volume) {
    GridReport report;
    for (int axis = 0; axis < 3; ++axis) report.counts[axis] = countDeltas(volume, axis);
    // The codes are counted, and the largest thing in memory.
    volume.codes.reset();
    report.volume = std::move(volume);
    return report;
}

FileReport reportOf(const std::string& file, const ReadOptions& options, const Listener& listener) {
    FileReport report;
    report.file = file;
    for (Volume& volume : readAllVolumes(file, options, listener))
        report.grids.push_back(reportOf(std::move(volume)));
    return report;
}

void runInfo(const InfoOptions& options, const Session& session) {
    std::vector<FileReport> reports;
    {
        ProgressDisplay display(session.common.quiet);
        const double count = double(options.inputs.size());
        for (const std::string& file : options.inputs) {
            const double done = double(reports.size());
            reports.push_back(
                reportOf(file, options.read, display.stage(done / count, (done + 1) / count)));
        }
    }
    printOut(options.json ? jsonText(reports) : plainText(reports));
}

}  // namespace

Subcommand addInfo(CLI::App& program) {
    const auto options = std::make_shared<InfoOptions>();
    // What is in a file is told as it is, not as it would be rendered.
    options->read.levelSetToFog = false;
    CLI::App& app = addSubcommand(
        program, "info", "Tells what is in volume files, and how alike their slices are.",
        {"deltasplat info smoke.vdb", "deltasplat info --json engine_256x256x128_uint8.raw.gz"});
    app.add_option("INPUT", options->inputs, "Files to describe: .vdb, .raw or .raw.gz")
        ->type_name("FILE")
        ->required()
        ->group("Arguments");
    OptionGroup(app, "Output").addFlag("--json", options->json, "Print one JSON object");
    addInputOptions(app, options->read);
    return {&app, [options](const Session& session) { runInfo(*options, session); }};
}

}  // namespace deltasplat
