// SPDX-License-Identifier: Apache-2.0
#include "diff/diff_report.h"

#include <algorithm>
#include <cstdio>
#include <glm/vec4.hpp>

#include "base/text.h"
#include "options/parse.h"
#include "text/json_text.h"
#include "text/text_line.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

const char* nameOf(Verdict verdict) {
    switch (verdict) {
        case Verdict::kPass:
            return "PASS";
        case Verdict::kWarning:
            return "WARNING";
        case Verdict::kFailure:
            break;
    }
    return "FAILURE";
}

Json toJson(const VolumeComparison& c, Verdict verdict) {
    return {{"mean_error", c.meanError},
            {"rms_error", c.rmsError},
            {"max_error", c.maxError},
            {"max_at", c.maxError > 0 ? Json::array({c.maxAt.x, c.maxAt.y, c.maxAt.z}) : Json()},
            {"over", c.overFail},
            {"over_warn", c.overWarn},
            {"voxels", c.voxels},
            {"active_mismatch", c.activeMismatch},
            {"background_error", c.backgroundError},
            {"shift", c.shift},
            {"transform_equal", c.transformEqual},
            {"size_equal", c.sizeEqual},
            {"type_equal", c.typeEqual},
            {"class_equal", c.classEqual},
            {"equal", c.equal()},
            {"result", nameOf(verdict)}};
}

// Errors as in the worst of them, counts of all, and what is equal only if it is so everywhere.
VolumeComparison worstOf(const std::vector<VolumeComparison>& comparisons) {
    VolumeComparison worst;
    for (const VolumeComparison& c : comparisons) {
        if (c.maxError > worst.maxError) {
            worst.maxError = c.maxError;
            worst.maxAt = c.maxAt;
        }
        worst.meanError = std::max(worst.meanError, c.meanError);
        worst.rmsError = std::max(worst.rmsError, c.rmsError);
        worst.backgroundError = std::max(worst.backgroundError, c.backgroundError);
        worst.shift = std::max(worst.shift, c.shift);
        worst.voxels += c.voxels;
        worst.overFail += c.overFail;
        worst.overWarn += c.overWarn;
        worst.activeMismatch += c.activeMismatch;
        worst.transformEqual = worst.transformEqual && c.transformEqual;
        worst.sizeEqual = worst.sizeEqual && c.sizeEqual;
        worst.typeEqual = worst.typeEqual && c.typeEqual;
        worst.classEqual = worst.classEqual && c.classEqual;
    }
    return worst;
}

std::string shownName(const std::string& grid) {
    return grid.empty() ? "\"\"" : grid;
}

std::string agreement(const std::string& a, const std::string& b) {
    return a == b ? a : "A has " + a + ", B has " + b;
}

std::string indexText(const glm::ivec3& index) {
    return "(" + numberText(glm::dvec3(index)) + ")";
}

std::string placeText(const VolumeComparison& c) {
    const std::string offset =
        c.offset == glm::ivec3(0) ? "" : "; B's voxel (0,0,0) is A's " + indexText(c.offset);
    if (c.shift == 0) return "equal" + offset;
    return (c.transformEqual ? "equal within rounding, up to " : "different, up to ") +
           numberText(c.shift) + " voxels apart" + offset;
}

// Of files that say nothing of places, whose voxels are of size 1 from the world's origin on.
std::string assumedText(const GridDiff& grid) {
    const auto isAssumed = [](const Volume& volume) {
        return !volume.hasBackground() && volume.space().empty() &&
               volume.worldFromIndex() == glm::dmat4(1);
    };
    const bool a = isAssumed(grid.a);
    const bool b = isAssumed(grid.b);
    if (a == b) return "";
    return std::string(" (") + (a ? "A" : "B") +
           "'s is origin 0,0,0 and spacing 1,1,1, as of files that name none; "
           "--origin and --spacing name them)";
}

std::string activeText(const GridDiff& grid) {
    const std::uint64_t mismatch = grid.comparison.activeMismatch;
    const auto count = [](const Volume& volume) {
        return countText(volume.activeCount(), "voxel");
    };
    if (mismatch == 0) return count(grid.a);
    return "A has " + count(grid.a) + ", B has " + count(grid.b) + "; " + std::to_string(mismatch) +
           " in one of them only";
}

std::string backgroundText(const GridDiff& grid) {
    const auto text = [](const Volume& volume) {
        return volume.hasBackground() ? numberText(volume.background()) : "none";
    };
    // Two 64-bit integers that differ may be the same number as doubles.
    const double error = grid.comparison.backgroundError;
    return agreement(text(grid.a), text(grid.b)) +
           (error > 0 ? "; they differ by " + numberText(error) : "");
}

std::string overText(std::uint64_t over, std::uint64_t voxels, double threshold) {
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.3g",
                  voxels > 0 ? 100 * double(over) / double(voxels) : 0.0);
    return "  " + countText(over, "voxel") + " (" + percent + "%) over " + numberText(threshold) +
           "\n";
}

std::string maxText(const GridDiff& grid) {
    const VolumeComparison& c = grid.comparison;
    if (c.maxError == 0) return "0";
    const glm::dvec3 at(c.maxAt);
    const glm::dvec3 world(grid.a.worldFromIndex() * glm::dvec4(at, 1));
    return numberText(c.maxError) + " @ (" + numberText(at) + "), in the world (" +
           numberText(world) + "); values are " + c.valueTextA + " vs " + c.valueTextB;
}

std::string plainText(const GridDiff& grid, const CompareOptions& thresholds) {
    const VolumeComparison& c = grid.comparison;
    std::string text =
        textLine("grid", agreement(shownName(grid.a.name()), shownName(grid.b.name())));
    const bool isApart = c.shift != 0 || c.offset != glm::ivec3(0);
    text += textLine("transform", placeText(c) + (isApart ? assumedText(grid) : ""));
    text += textLine("type", agreement(grid.a.type(), grid.b.type()));
    text += textLine("class", agreement(grid.a.gridClass(), grid.b.gridClass()));
    text += textLine("background", backgroundText(grid));
    text += textLine("active", activeText(grid));
    if (!c.sizeEqual) {
        const std::string dims =
            agreement(dimsText(grid.a.box().dims(), " x "), dimsText(grid.b.box().dims(), " x "));
        text +=
            textLine("dims", dims + (c.offset == glm::ivec3(0) ? "" : ", from other voxels on"));
    }
    text += "  Mean error = " + numberText(c.meanError) + "\n";
    text += "  RMS error = " + numberText(c.rmsError) + "\n";
    text += "  Max error = " + maxText(grid) + "\n";
    text += overText(c.overWarn, c.voxels, thresholds.warn);
    return text + overText(c.overFail, c.voxels, thresholds.fail);
}

}  // namespace

Verdict judge(const VolumeComparison& c, const CompareOptions& thresholds,
              const DiffLimits& limits) {
    const auto isOver = [&](std::uint64_t over, double percent, double threshold, double hard) {
        return double(over) > percent / 100 * double(c.voxels) || c.maxError > hard ||
               c.backgroundError > std::min(threshold, hard);
    };
    const bool activeEqual = c.activeMismatch == 0 || limits.ignoreActive;
    if (!c.transformEqual || !c.sizeEqual || !activeEqual) return Verdict::kFailure;
    if (isOver(c.overFail, limits.failPercent, thresholds.fail, limits.hardFail))
        return Verdict::kFailure;
    if (isOver(c.overWarn, limits.warnPercent, thresholds.warn, limits.hardWarn))
        return Verdict::kWarning;
    return Verdict::kPass;
}

Verdict FileDiff::verdict() const {
    Verdict worst = isIncomplete() && incompleteCounts ? Verdict::kFailure : Verdict::kPass;
    for (const GridDiff& grid : grids) worst = std::max(worst, grid.verdict);
    return worst;
}

namespace {

VolumeComparison worstOf(const FileDiff& diff) {
    std::vector<VolumeComparison> comparisons;
    for (const GridDiff& grid : diff.grids) comparisons.push_back(grid.comparison);
    return worstOf(comparisons);
}

Json toJson(const FileDiff& diff) {
    Json json = toJson(worstOf(diff), diff.verdict());
    json["equal"] = json["equal"] && !diff.isIncomplete();
    json["only_in_a"] = diff.onlyInA;
    json["only_in_b"] = diff.onlyInB;
    json["not_compared"] = diff.notCompared;
    json["grids"] = Json::array();
    for (const GridDiff& grid : diff.grids) {
        const glm::ivec3& offset = grid.comparison.offset;
        Json one = {{"name", grid.a.name()},
                    {"name_b", grid.b.name()},
                    {"offset", {offset.x, offset.y, offset.z}}};
        one.update(toJson(grid.comparison, grid.verdict));
        json["grids"].push_back(one);
    }
    return json;
}

}  // namespace

std::string jsonText(const FileDiff& diff) {
    return dumpJson(toJson(diff));
}

std::string jsonText(const std::vector<FrameDiff>& frames) {
    std::vector<VolumeComparison> comparisons;
    Verdict verdict = Verdict::kPass;
    bool isComplete = true;
    Json each = Json::array();
    for (const FrameDiff& frame : frames) {
        comparisons.push_back(worstOf(frame.diff));
        verdict = std::max(verdict, frame.diff.verdict());
        isComplete = isComplete && !frame.diff.isIncomplete();
        Json one{{"frame", frame.frame}, {"a", frame.a.string()}, {"b", frame.b.string()}};
        one.update(toJson(frame.diff));
        each.push_back(one);
    }
    Json json = toJson(worstOf(comparisons), verdict);
    json["equal"] = json["equal"] && isComplete;
    json["frames"] = each;
    return dumpJson(json);
}

std::string plainText(const FileDiff& diff, const DiffOptions& options) {
    std::string text =
        "Comparing \"" + options.a.string() + "\" and \"" + options.b.string() + "\"\n";
    for (const GridDiff& grid : diff.grids) text += plainText(grid, options.compare);
    for (const std::string& name : diff.onlyInA) text += textLine("only in A", shownName(name));
    for (const std::string& name : diff.onlyInB) text += textLine("only in B", shownName(name));
    for (const std::string& name : diff.notCompared) text += textLine("not compared", name);
    return text + nameOf(diff.verdict()) + "\n";
}

std::string plainText(const std::vector<FrameDiff>& frames) {
    std::string text;
    for (const Verdict verdict : {Verdict::kPass, Verdict::kWarning, Verdict::kFailure}) {
        std::vector<std::string> those;
        for (const FrameDiff& frame : frames)
            if (frame.diff.verdict() == verdict) those.push_back(std::to_string(frame.frame));
        if (those.empty()) continue;
        text += (text.empty() ? "" : ", ") + std::to_string(those.size()) + " " + nameOf(verdict);
        if (verdict != Verdict::kPass) text += " (" + joinNames(those) + ")";
    }
    return "Frames: " + text + "\n";
}

}  // namespace deltasplat
