// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "deltasplat/error.h"
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

// What cannot be read; the rest is told all the same.
using Failures = std::vector<Error>;

FileReport reportOf(const std::string& file, const ReadOptions& options, const Listener& listener,
                    Failures& failures) {
    FileReport report;
    report.file = file;
    VolumeVisitor visitor;
    visitor.volume = [&](Volume volume) { report.grids.push_back(reportOf(std::move(volume))); };
    visitor.invalid = [&](const Error& error) { failures.push_back(error); };
    visitor.other = [&](const std::string& name, const std::string& type) {
        report.others.push_back(name + " (" + type + ")");
    };
    forEachVolume(file, options, visitor, listener);
    return report;
}

void runInfo(const CLI::App& app, const InfoOptions& options, const Session& session) {
    std::vector<FileReport> reports;
    Failures failures;
    {
        ProgressDisplay display(session.common.quiet);
        warnOfUnusedInputOptions(app, {options.inputs.begin(), options.inputs.end()}, display);
        const double count = double(options.inputs.size());
        for (const std::string& file : options.inputs) {
            const double done = double(reports.size());
            reports.push_back(reportOf(file, options.read,
                                       display.stage(done / count, (done + 1) / count), failures));
        }
    }
    printOut(options.json ? jsonText(reports) : plainText(reports));
    if (failures.empty()) return;
    // The last one ends the program, which shows it as it shows every error.
    for (std::size_t i = 0; i + 1 < failures.size(); ++i) showError(failures[i].what());
    throw failures.back();
}

}  // namespace

Subcommand addInfo(CLI::App& program) {
    const auto options = std::make_shared<InfoOptions>();
    // What is in a file is told as it is, not as it would be rendered.
    options->read.levelSetToFog = false;
    CLI::App& app = addSubcommand(
        program, "info", "Tells what is in volume files, and how alike their slices are.",
        {"deltasplat info smoke.vdb", "deltasplat info --json engine_256x256x128_uint8.raw.gz"});
    app.add_option("INPUT", options->inputs, std::string("Files to describe: ") + kInputFormats)
        ->type_name("FILE")
        ->required()
        ->group("Arguments");
    OptionGroup(app, "Output").addFlag("--json", options->json, "Print one JSON object");
    addInputOptions(app, options->read);
    return {&app, [&app, options](const Session& session) { runInfo(app, *options, session); }};
}

}  // namespace deltasplat
