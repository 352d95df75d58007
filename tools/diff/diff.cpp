// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "deltasplat/error.h"
#include "deltasplat/ingest/list_grids.h"
#include "diff/diff_options.h"
#include "diff/diff_report.h"
#include "files/file_name.h"
#include "formats/readers.h"
#include "formats/vdb/vdb_leaves.h"
#include "listener.h"
#include "modules/load_early.h"
#include "options/input_options.h"
#include "options/volume_choices.h"
#include "process/print_out.h"
#include "sequence/frame_name.h"
#include "sequence/frame_warnings.h"
#include "sequence/frames_to_make.h"
#include "subcommands.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

// idiff's, for files that cannot be compared. Wrong usage shares it here: its usual number, 2,
// means that the files differ.
constexpr int kCannotCompare = 4;

// Shares of the progress: the first file read, the second read, both compared.
constexpr double kReadA = 0.45;
constexpr double kReadB = 0.9;

struct GridPair {
    std::optional<std::string> a;  // empty: the default grid
    std::optional<std::string> b;
};

std::vector<std::string> without(const std::vector<std::string>& names,
                                 const std::vector<std::string>& others) {
    const std::set<std::string> left(others.begin(), others.end());
    std::vector<std::string> rest;
    for (const std::string& name : names) {
        if (!left.contains(name)) rest.push_back(name);
    }
    return rest;
}

// Notes the scalar grids of a .vdb that stand beside the one compared.
void noteOthers(const std::filesystem::path& file, std::vector<std::string>& onlyHere,
                std::vector<std::string>& notCompared) {
    if (!isVdbName(file)) return;
    const GridList grids = listGrids(file);
    notCompared.insert(notCompared.end(), grids.others.begin(), grids.others.end());
    if (grids.preferred) onlyHere = without(grids.scalar, {*grids.preferred});
}

// Finds what is to be compared with what, and notes what is in one file only.
std::vector<GridPair> pairGrids(const DiffOptions& options, FileDiff& diff) {
    if (const auto& asked = options.read.gridName) return {{asked, asked}};
    if (!isVdbName(options.a) || !isVdbName(options.b)) {
        noteOthers(options.a, diff.onlyInA, diff.notCompared);
        noteOthers(options.b, diff.onlyInB, diff.notCompared);
        return {{}};
    }
    const GridList a = listGrids(options.a);
    const GridList b = listGrids(options.b);
    for (const std::string& grid : a.others) diff.notCompared.push_back(grid);
    for (const std::string& grid : without(b.others, a.others)) diff.notCompared.push_back(grid);
    // Without a choice, names do not matter; without any grid, reading says so.
    if (a.scalar.size() == 1 && b.scalar.size() == 1) return {{a.scalar[0], b.scalar[0]}};
    if (a.scalar.empty() || b.scalar.empty()) return {{}};
    diff.onlyInA = without(a.scalar, b.scalar);
    diff.onlyInB = without(b.scalar, a.scalar);
    std::vector<GridPair> pairs;
    for (const std::string& name : without(a.scalar, diff.onlyInA)) pairs.push_back({name, name});
    return pairs;
}

// --volume and --series choose among several. What has only one may be what another program, or
// `convert`, made of the one chosen.
ReadOptions optionsFor(const std::filesystem::path& file, const std::filesystem::path& other,
                       ReadOptions options) {
    if (!options.volume && !options.series) return options;
    if (hasSeveral(file, options) || !hasSeveral(other, options)) return options;
    options.volume.reset();
    options.series.reset();
    return options;
}

// @param packed  whether values may stay in the file
Volume readOne(const std::filesystem::path& file, const std::optional<std::string>& grid,
               ReadOptions options, bool packed, const Listener& listener) {
    options.gridName = isVdbName(file) ? grid : std::nullopt;
    options.keepSource = true;
    if (packed) {
        if (auto volume = readPackedVolume(file, options, listener)) return std::move(*volume);
    }
    Volume volume = readCompared(file, options, listener);
    // The volume's own values are all that is looked at.
    if (volume.source()) volume = volume.withoutCodes();
    return volume;
}

GridDiff compareGrids(const DiffOptions& options, const GridPair& pair, bool packed,
                      const std::function<Listener(double begin, double end)>& stage) {
    GridDiff diff;
    diff.a = readOne(options.a, pair.a, optionsFor(options.a, options.b, options.read), packed,
                     stage(0, kReadA));
    diff.b = readOne(options.b, pair.b, optionsFor(options.b, options.a, options.read), packed,
                     stage(kReadA, kReadB));
    // What is packed is read while it is compared.
    const bool areRead = !diff.a.source() || !diff.a.source()->packed || !diff.b.source() ||
                         !diff.b.source()->packed;
    CompareOptions compare = options.compare;
    compare.placeDigitsA = placeDigitsOf(options.a);
    compare.placeDigitsB = placeDigitsOf(options.b);
    diff.comparison = compareVolumes(diff.a, diff.b, compare, stage(areRead ? kReadB : 0, 1));
    diff.verdict = judge(diff.comparison, options.compare, options.limits);
    for (Volume* volume : {&diff.a, &diff.b}) {
        VolumeData rest = volume->withoutVoxels().data();
        rest.histogram = {};
        *volume = Volume(std::move(rest));
    }
    return diff;
}

// Values are unpacked as they are compared, unless that turns out to be not enough.
GridDiff compareGrids(const DiffOptions& options, const GridPair& pair,
                      const std::function<Listener(double begin, double end)>& stage) {
    // What has been said is not said again.
    std::vector<std::string> said;
    const auto noting = [&](double begin, double end) {
        Listener listener = stage(begin, end);
        listener.warning = [&, warn = listener.warning](const std::string& text) {
            said.push_back(text);
            if (warn) warn(text);
        };
        return listener;
    };
    const auto withoutSaid = [&](double begin, double end) {
        Listener listener = stage(begin, end);
        listener.warning = [&, warn = listener.warning](const std::string& text) {
            const auto found = std::find(said.begin(), said.end(), text);
            if (found != said.end()) {
                said.erase(found);
            } else if (warn) {
                warn(text);
            }
        };
        return listener;
    };
    try {
        return compareGrids(options, pair, /*packed=*/true, noting);
    } catch (const NeedsWholeGrid&) {
        return compareGrids(options, pair, /*packed=*/false, withoutSaid);
    }
}

// Compares two grids of several; undefined distances of solvers do not keep the others from it.
void addComparison(const DiffOptions& options, const GridPair& pair, bool amongOthers,
                   const std::function<Listener(double begin, double end)>& stage, FileDiff& diff) {
    try {
        diff.grids.push_back(compareGrids(options, pair, stage));
    } catch (const NotFinite&) {
        if (!amongOthers) throw;
        diff.notCompared.push_back(pair.a.value_or("") + " (NaN or infinite values)");
    } catch (const UnreadableGrid& error) {
        if (!amongOthers) throw;
        diff.notCompared.push_back(pair.a.value_or("") + " (" + error.obstacle + ")");
    }
}

// Compares two files. The display's part is what `stage` gives.
FileDiff compareFiles(const CLI::App& app, const DiffOptions& options,
                      const std::function<Listener(double begin, double end)>& stage) {
    FileDiff diff;
    warnOfUnusedInputOptions(app, {options.a, options.b}, stage(0, 0));
    const std::vector<GridPair> pairs = pairGrids(options, diff);
    const double count = double(pairs.size());
    double done = 0;
    for (const GridPair& pair : pairs) {
        const auto part = [&](double begin, double end) {
            return stage((done + begin) / count, (done + end) / count);
        };
        addComparison(options, pair, pairs.size() > 1, part, diff);
        ++done;
    }
    diff.incompleteCounts = !options.limits.ignoreMissing;
    return diff;
}

Verdict compareOnce(const CLI::App& app, const DiffOptions& options, const Session& session) {
    FileDiff diff;
    {
        ProgressDisplay display(session.common);
        diff = compareFiles(app, options,
                            [&](double begin, double end) { return display.stage(begin, end); });
    }
    if (options.json) {
        printOut(jsonText(diff));
    } else if (!session.common.quiet) {
        printOut(plainText(diff, options));
    }
    return diff.verdict();
}

// The files of all frames: one of the two may be the same for all.
std::vector<FrameDiff> framesOf(const DiffOptions& options, const Listener& listener) {
    const auto filesOf = [&](const std::string& option, const std::filesystem::path& file) {
        return withInputs(inputsOfFrames(options.frames, option, file, listener),
                          options.frames.missing, listener);
    };
    const bool isOfA = FrameName::findInput(options.a).has_value();
    const bool isOfB = isOfA && FrameName::findInput(options.b).has_value();
    std::map<int, std::filesystem::path> ofB;
    if (isOfB || !isOfA)
        for (const FrameFiles& one : filesOf("B", options.b)) ofB[one.frame] = one.input;
    std::vector<FrameDiff> frames;
    if (!isOfA) {
        for (const int frame : options.frames.frames)
            if (ofB.contains(frame)) frames.push_back({frame, options.a, ofB[frame], {}});
        return frames;
    }
    for (const FrameFiles& one : filesOf("A", options.a)) {
        if (isOfB && !ofB.contains(one.frame)) continue;
        frames.push_back({one.frame, one.input, isOfB ? ofB[one.frame] : options.b, {}});
    }
    return frames;
}

Verdict compareFrames(const CLI::App& app, const DiffOptions& options, const Session& session) {
    ProgressDisplay display(session.common);
    std::vector<FrameDiff> frames = framesOf(options, display.stage(0, 0));
    if (frames.empty()) {
        throw Error(ErrorCode::kInput, "--frames", "no frame that both have", "at least one");
    }
    std::vector<FrameFiles> files;
    for (const FrameDiff& frame : frames) files.push_back({frame.frame, frame.a, frame.b});
    const Listener all = display.stage(0, 1);
    FrameWarnings warnings(files, all);
    Verdict worst = Verdict::kPass;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        FrameDiff& frame = frames[i];
        DiffOptions one = options;
        one.a = frame.a;
        one.b = frame.b;
        const auto stage = [&](double begin, double end) {
            const double count = double(frames.size());
            Listener part = display.stage((double(i) + begin) / count, (double(i) + end) / count);
            part.warning = [&, i](const std::string& text) { warnings.warn(i, text); };
            return part;
        };
        try {
            frame.diff = compareFiles(app, one, stage);
        } catch (const Error& error) {
            if (error.code() == ErrorCode::kInterrupted) throw;
            warnings.count();
            throw Error(error.code(), frameLine(files[i], error.what()));
        }
        warnings.finish(i);
        worst = std::max(worst, frame.diff.verdict());
        if (!options.json && !session.common.quiet) printOut(plainText(frame.diff, one));
    }
    warnings.count();
    if (options.json) {
        printOut(jsonText(frames));
    } else if (!session.common.quiet) {
        printOut(plainText(frames));
    }
    return worst;
}

Verdict runDiff(const CLI::App& app, DiffOptions options, const Session& session) {
    // Most grids of a .vdb need no library.
    std::vector<std::jthread> loading;
    for (const std::filesystem::path& file : {options.a, options.b})
        if (!isVdbName(file)) loading.push_back(loadEarly(file));
    for (std::filesystem::path* const file : {&options.a, &options.b})
        settleNames(app, options.frames, *file);
    if (options.frames.asked()) return compareFrames(app, options, session);
    return compareOnce(app, options, session);
}

}  // namespace

Subcommand addDiff(CLI::App& program) {
    const auto options = std::make_shared<DiffOptions>();
    const auto verdict = std::make_shared<Verdict>(Verdict::kPass);
    // What is in the files is compared as it is, not as it would be rendered.
    options->read.levelSetToFog = false;
    CLI::App& app = addSubcommand(
        program, "diff", "Compares two volumes as idiff compares images.",
        {"deltasplat diff smoke.vdb restored.vdb",
         "deltasplat diff engine_256x256x128_uint8.raw.gz lossy.vdb --fail 2 --failpercent 0.1"});
    app.footer(
        app.get_footer() +
        "\n\nExit codes: 0 same, 1 warning, 2 different; 4 whatever else goes wrong (wrong usage,\n"
        "unreadable input); 130 interrupted. With -q they are all that is said.");
    return {&app, [&app, options] { addDiffOptions(app, *options); },
            [&app, options, verdict](const Session& session) {
                *verdict = runDiff(app, *options, session);
            },
            [verdict] { return int(*verdict); }, kCannotCompare};
}

}  // namespace deltasplat
