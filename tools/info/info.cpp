// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <thread>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/ingest/read_volume.h"
#include "drawing/plot_file.h"
#include "formats/format.h"
#include "formats/input_kind.h"
#include "info/describe_volume.h"
#include "info/info_list.h"
#include "info/info_report.h"
#include "info/sequence_report.h"
#include "info/slice_plot.h"
#include "listener.h"
#include "options/input_options.h"
#include "options/transfer_function_option.h"
#include "options/volume_choices.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "process/print_out.h"
#include "sequence/frame_options.h"
#include "sequence/frame_warnings.h"
#include "sequence/frames_to_make.h"
#include "subcommands.h"
#include "warn_once.h"

namespace deltasplat {
namespace {

// A picture of more grids would be too large to look at.
constexpr std::size_t kMaxPlots = 16;

struct InfoOptions {
    std::vector<std::string> inputs;  // of frames their files
    FrameChoice frames;
    std::vector<FrameFiles> files;  // of frames
    bool json = false;
    bool list = false;
    std::filesystem::path plot;              // empty: none
    std::filesystem::path transferFunction;  // empty: none
    ReadOptions read;
};

// Tells the last failure by ending with it, which shows it as every error is shown.
void throwFailures(const std::vector<Error>& failures) {
    if (failures.empty()) return;
    for (std::size_t i = 0; i + 1 < failures.size(); ++i) showError(failures[i].what());
    throw failures.back();
}

void listInputs(const CLI::App& app, const InfoOptions& options, const Session& session) {
    std::vector<FileListing> files;
    std::vector<Error> failures;
    ProgressDisplay display(session.common);
    warnOfUnusedInputOptions(app, {options.inputs.begin(), options.inputs.end()},
                             display.stage(0, 0));
    for (const char* const option : {"--plot", "--tf"}) {
        if (isGiven(app, option)) display.warn(std::string(option) + ": has no effect with --list");
    }
    for (const std::string& file : options.inputs) {
        try {
            files.push_back({file, listVolumes(file, options.read, display.stage(0, 0))});
        } catch (const Error& error) {
            if (error.code() == ErrorCode::kInterrupted) throw;
            failures.push_back(error);
        }
    }
    if (!files.empty()) printOut(options.json ? jsonText(files) : plainText(files));
    throwFailures(failures);
}

// What has been found out, and what could not be: the rest is told all the same.
struct Findings {
    std::vector<FileReport> reports;
    std::vector<Error> failures;
    std::size_t grids = 0;  // in all reports, the unfinished one included
};

void describeChoice(const std::string& file, const VolumeChoice& choice, const InfoOptions& options,
                    const DescribeOptions& describe, const Listener& listener, FileReport& report,
                    Findings& found) {
    VolumeVisitor visitor;
    visitor.volume = [&](Volume volume) {
        const bool plot = !options.plot.empty() && found.grids < kMaxPlots;
        if (++found.grids == kMaxPlots + 1 && !options.plot.empty())
            listener.warn("--plot: shows the first " + std::to_string(kMaxPlots) + " grids only");
        report.grids.push_back(describeVolume(std::move(volume), describe, plot));
        report.grids.back().entry = choice.entry;
        report.grids.back().volumeIndex = choice.read.volume.value_or(0);
    };
    visitor.invalid = [&](const Error& error) { found.failures.push_back(error); };
    visitor.other = [&](const std::string& name, const std::string& type) {
        report.others.push_back(name + " (" + type + ")");
    };
    try {
        forEachVolume(file, choice.read, visitor, listener);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::kInterrupted) throw;
        found.failures.push_back(error);
    }
}

void addFile(const std::string& file, const InfoOptions& options, const DescribeOptions& describe,
             const Listener& listener, Findings& found) {
    FileReport report;
    report.file = file;
    std::vector<VolumeChoice> choices;
    try {
        choices = choicesIn(file, options.read);
    } catch (const Error& error) {
        found.failures.push_back(error);
    }
    double done = 0;
    WarnOnce warnings(listener);  // what is said of a folder is said with each series
    for (const VolumeChoice& choice : choices) {
        Listener part;
        part.progress = [&](double share) {
            listener.report((done + share) / double(choices.size()));
        };
        part.warning = [&](const std::string& text) { warnings.warn(text); };
        if (choices.size() > 1 && choice.entry.type == kNoImages) {
            report.others.push_back(seriesText(choice.entry) + " (" + kNoImages + ")");
        } else {
            describeChoice(file, choice, options, describe, part, report, found);
        }
        ++done;
    }
    if (!report.grids.empty() && findInput(file, {}).is(vdbFormat()))
        report.medium = mediumGrids(listVolumes(file, options.read));
    if (!report.grids.empty() || !report.others.empty()) found.reports.push_back(std::move(report));
}

DescribeOptions describeOptions(const InfoOptions& options, const Listener& listener) {
    DescribeOptions describe;
    if (options.transferFunction.empty()) return describe;
    describe.transferFunction = readTransferFunctionOption(options.transferFunction, listener);
    describe.preset = parseTransferFunction(options.transferFunction).preset;
    describe.transferFunctionFile = options.transferFunction.filename().string();
    return describe;
}

SlicePlot plotOf(const std::string& file, const GridReport& report) {
    const Volume& volume = report.volume;
    const glm::ivec3 dims = volume.box().dims();
    SlicePlot plot;
    plot.title = std::filesystem::path(file).filename().string();
    // A raw volume has no name but its file's.
    if (volume.hasBackground()) plot.title += ", " + volume.name();
    if (!report.entry.description.empty()) plot.title += ", " + report.entry.description;
    if (report.entry.volumes > 1) plot.title += ", volume " + std::to_string(report.volumeIndex);
    plot.title += ", " + dimsText(dims, " x ");
    plot.visible = "visible: " + report.visible;
    plot.box = volume.box();
    plot.columns = report.columns;
    return plot;
}

void writePlot(const std::filesystem::path& file, const Findings& found) {
    std::vector<SlicePlot> plots;
    for (const FileReport& report : found.reports) {
        for (const GridReport& grid : report.grids) {
            if (plots.size() < kMaxPlots) plots.push_back(plotOf(report.file, grid));
        }
    }
    if (!plots.empty()) writeDrawing(file, drawSlicePlots(plots));
}

void declareOptions(CLI::App& app, InfoOptions& options) {
    app.add_option("INPUT", options.inputs, std::string("Files to describe: ") + kInputFormats)
        ->type_name("FILE")
        ->required()
        ->group("Arguments");
    OptionGroup output(app, "Output");
    output.addFlag("--json", options.json, "Print one JSON object");
    output.addFlag("--list", options.list,
                   "Only list what the headers tell: a line for each grid or DICOM\n"
                   "series with its name, type, class and box, which one is read by\n"
                   "default, and how many volumes there are");
    output.addValue("--plot", "FILE", options.plot, anyText(),
                    "Picture to write, .png or .svg: which share of every slice's\n"
                    "voxels is visible and which changes, along x, y and z; a row\n"
                    "for each grid, up to " +
                        std::to_string(kMaxPlots));
    OptionGroup(app, "Optics")
        .addValue("--tf", "FILE|PRESET", options.transferFunction, anyText(),
                  "Transfer function, as for render, that stamps and picture are\n"
                  "for (default: all voxels but the background are visible)");
    addFrameList(app, options.frames);
    addInputOptions(app, options.read);
}

// The same with the files of frames in place of names that stand for them.
InfoOptions withFrames(const CLI::App& app, InfoOptions options, const Session& session) {
    for (std::string& input : options.inputs) {
        std::filesystem::path file = input;
        settleNames(app, options.frames, file);
        input = file.string();
        if (!options.frames.asked()) continue;
        ProgressDisplay display(session.common);
        const Listener listener = display.stage(0, 0);
        const std::vector<FrameFiles> frames =
            inputsOfFrames(options.frames, "INPUT", file, listener);
        for (const FrameFiles& frame : withInputs(frames, options.frames.missing, listener))
            options.files.push_back(frame);
    }
    if (!options.frames.asked()) return options;
    options.inputs.clear();
    for (const FrameFiles& frame : options.files) options.inputs.push_back(frame.input.string());
    return options;
}

void runInfo(const CLI::App& app, const InfoOptions& asked, const Session& session) {
    InfoOptions options = withFrames(app, asked, session);
    if (!options.read.paletteNumbers && isForLabels(options.transferFunction))
        options.read.paletteNumbers = true;
    if (options.list) return listInputs(app, options, session);
    if (!options.plot.empty()) {
        checkDrawingFile(options.plot);
        const Files inputs(options.inputs.begin(), options.inputs.end());
        checkOutput("--plot", options.plot,
                    filesRead(inputs, parseTransferFunction(options.transferFunction).file),
                    "the inputs and the transfer function");
    }
    Findings found;
    {
        ProgressDisplay display(session.common);
        const Listener all = display.stage(0, 1);
        FrameWarnings warnings(options.files, all);
        warnOfUnusedInputOptions(app, {options.inputs.begin(), options.inputs.end()},
                                 display.stage(0, 0));
        const DescribeOptions describe = describeOptions(options, display.stage(0, 0));
        const double count = double(options.inputs.size());
        for (std::size_t i = 0; i < options.inputs.size(); ++i) {
            Listener part = display.stage(double(i) / count, double(i + 1) / count);
            if (!options.files.empty())
                part.warning = [&, i](const std::string& text) { warnings.warn(i, text); };
            addFile(options.inputs[i], options, describe, part, found);
            warnings.finish(i);
        }
        warnings.count();
    }
    if (!found.reports.empty()) {
        // Of several sequences there is nothing to say in common.
        const bool isSequence = options.frames.asked() && asked.inputs.size() == 1;
        printOut(options.json
                     ? jsonText(found.reports, options.transferFunction.string(), isSequence)
                     : plainText(found.reports) +
                           (isSequence ? "\n" + sequenceText(found.reports, options.inputs.size())
                                       : ""));
    }
    if (!options.plot.empty()) writePlot(options.plot, found);
    throwFailures(found.failures);
    allIsWritten();
}

}  // namespace

Subcommand addInfo(CLI::App& program) {
    const auto options = std::make_shared<InfoOptions>();
    // What is in a file is told as it is, not as it would be rendered.
    options->read.levelSetToFog = false;
    options->read.keepInexact = true;  // what a delta grid would store
    CLI::App& app = addSubcommand(
        program, "info", "Tells what is in volume files, and how alike their slices are.",
        {"deltasplat info smoke.vdb --plot smoke.svg",
         "deltasplat info --json engine_256x256x128_uint8.raw.gz --tf examples/ct.json"});
    return {&app, [&app, options] { declareOptions(app, *options); },
            [&app, options](const Session& session) { runInfo(app, *options, session); }};
}

}  // namespace deltasplat
