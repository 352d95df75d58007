// SPDX-License-Identifier: Apache-2.0
#include "table1/bench_table1.h"

#include <filesystem>
#include <memory>

#include "bench/bench_failures.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/threads.h"
#include "listener.h"
#include "options/transfer_function_option.h"
#include "process/print_out.h"
#include "table1/ct_ramp.h"
#include "table1/table1.h"

namespace deltasplat {
namespace {

struct Table1Command {
    std::filesystem::path folder = ".";
    std::filesystem::path transferFunction;  // empty: the CT ramp
    int repeats = 7;
    bool json = false;
};

struct Findings {
    Table1Report report;
    std::vector<Error> failures;
};

void addTable1Options(CLI::App& app, Table1Command& command) {
    OptionGroup arguments(app, "Arguments");
    arguments.addValue(
        "DATA_FOLDER", "DIR", command.folder, anyText(),
        withDefault("Folder that holds the volumes, or folders of them", "the current folder"));
    OptionGroup group(app, "Measuring");
    group.addValue(
        "--repeats", "N", command.repeats, wholeNumber(1, 100000),
        withDefault("Rounds that count, after one to warm up", std::to_string(command.repeats)));
    group.addValue("--tf", "FILE|PRESET", command.transferFunction, anyText(),
                   "Transfer function, as for render (default: a CT ramp, clear below\n"
                   "22 % of the range: that of examples/ct.json)");
    OptionGroup output(app, "Output");
    output.addFlag("--json", command.json, "Print one JSON object, times in seconds");
}

std::string filesText() {
    std::string text = "Files looked for:";
    for (const Table1DataSet& dataSet : kTable1) text += std::string("\n  ") + dataSet.file;
    return text;
}

// Options of `bench` itself have nothing to say here.
void refuseOptionsOfBench(const CLI::App& bench) {
    const CLI::Option* const threads = bench.get_option("--threads");
    for (const CLI::Option* option : bench.get_options()) {
        if (option->count() == 0 || option->get_group() == threads->get_group()) continue;
        throw Error(ErrorCode::kUsage, option->get_name(), "a place before table1",
                    "options of 'deltasplat bench table1' behind it");
    }
}

void checkThreads(const CLI::App& app, int threads) {
    for (const CLI::App* at = &app; at != nullptr; at = at->get_parent()) {
        if (!isGiven(*at, "--threads") || threads == 1) continue;
        throw Error(ErrorCode::kUsage, "--threads", std::to_string(threads),
                    "1, as Table 1 is measured with one thread");
    }
}

// What is rendered with; the preset is the one that the function is of, or null.
struct ChosenFunction {
    TransferFunction function;
    const Preset* preset = nullptr;
};

void measure(const Table1DataSet& dataSet, const std::filesystem::path& file,
             const ChosenFunction& chosen, ProgressDisplay& display, double begin, double end,
             Findings& found) {
    const auto stage = [&](double from, double to) {
        return display.stage(begin + (end - begin) * from, begin + (end - begin) * to);
    };
    const Volume volume = readVolume(file, {}, stage(0, 0.1));
    RenderOptions options = table1Options(volume, chosen.function);
    if (chosen.preset) fitPreset(*chosen.preset, volume, options.optics);
    const auto run = [&](double from, double to) {
        return BenchEntry{file.string(), "composite",
                          measureMethods(volume, options, found.report.repeats, stage(from, to))};
    };
    Table1Row row{dataSet, run(0.1, 0.55), {}};
    options.splat.tolerance.value = kTable1ToleranceValue;
    row.held = run(0.55, 1);
    addDifference(row.exact, found.failures);
    addDifference(row.held, found.failures);
    found.report.rows.push_back(std::move(row));
}

// A volume that is missing or cannot be read does not keep the others from being measured.
void measureAll(const Table1Command& command, const ChosenFunction& chosen,
                ProgressDisplay& display, Findings& found) {
    const auto files = findTable1Files(command.folder, display.stage(0, 0));
    for (std::size_t i = 0; i < kTable1.size(); ++i) {
        const auto file = files.find(kTable1[i].file);
        if (file == files.end()) {
            found.failures.emplace_back(
                ErrorCode::kInput,
                gotExpected(kTable1[i].file, "no such file below " + command.folder.string(),
                            "the data set '" + std::string(kTable1[i].name) + "' of Table 1"));
            continue;
        }
        const double count = kTable1.size();
        try {
            measure(kTable1[i], file->second, chosen, display, double(i) / count,
                    double(i + 1) / count, found);
        } catch (const Error& error) {
            if (error.code() == ErrorCode::kInterrupted) throw;
            found.failures.push_back(error);
        }
    }
}

void runTable1(const CLI::App& app, const Table1Command& command, const Session& session) {
    refuseOptionsOfBench(*app.get_parent());
    checkThreads(app, session.common.threads);
    const ThreadLimit limit(1);
    ProgressDisplay display(session.common);
    const bool ramp = command.transferFunction.empty();
    ChosenFunction chosen{ctRamp()};
    if (!ramp) {
        chosen = {readTransferFunctionOption(command.transferFunction, display.stage(0, 0)),
                  parseTransferFunction(command.transferFunction).preset};
    }

    Findings found;
    found.report.machine = thisMachine();
    found.report.transferFunction =
        ramp ? "CT ramp, clear below 22 % of the range" : command.transferFunction.string();
    found.report.repeats = command.repeats;
    measureAll(command, chosen, display, found);
    if (!found.report.rows.empty())
        printOut(command.json ? jsonText(found.report) : plainText(found.report));
    throwFailures(found.failures);
}

}  // namespace

Subcommand addTable1(CLI::App& bench) {
    const auto command = std::make_shared<Table1Command>();
    CLI::App& app = addSubcommand(
        bench, "table1", "Measures the paper's Table 1 in the paper's setting, one thread.",
        {"deltasplat bench table1 data", "deltasplat bench table1 data --repeats 15 --json"});
    app.footer(filesText() + "\n\n" + app.get_footer());
    return {&app, [&app, command] { addTable1Options(app, *command); },
            [&app, command](const Session& session) { runTable1(app, *command, session); }};
}

}  // namespace deltasplat
