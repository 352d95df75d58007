// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/ingest/label_list.h"
#include "deltasplat/ingest/value_statistics.h"
#include "info/info_report.h"
#include "options/parse.h"
#include "options/volume_choices.h"
#include "text/short_number.h"
#include "text/text_line.h"
#include "volume/code_math.h"
#include "volume_place.h"

namespace deltasplat {
namespace {

// Zeros without a sign.
std::string valueText(double value) {
    return joinNumbers({value}, "");
}

template <class Vector>
std::string toText(const Vector& v, const std::string& separator) {
    return joinNumbers({double(v.x), double(v.y), double(v.z)}, separator);
}

// Files hold sizes as floats or with few digits, or directions of which they are the lengths.
std::string sizeText(const glm::dvec3& size) {
    return shortNumberText(size.x) + " x " + shortNumberText(size.y) + " x " +
           shortNumberText(size.z);
}

std::string padded(const std::string& text, std::size_t width) {
    return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string percent(double part, double whole) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f %%", whole > 0 ? 100 * part / whole : 0.0);
    return text;
}

std::string alongText(int axis) {
    return std::string("along ") + "xyz"[axis];
}

std::string axisText(const GridReport& report, int axis) {
    const SliceCounts& counts = report.counts[axis];
    char text[32];
    std::snprintf(text, sizeof text, "%.4f", comparability(report, axis));
    return "comparability " + std::string(text) + " as data, " + std::to_string(counts.deltas) +
           " deltas (" + percent(double(counts.deltas), double(voxelsOf(report.volume.box()))) +
           ")";
}

std::string backgroundText(const GridReport& report) {
    const Volume& volume = report.volume;
    if (volume.hasBackground()) return valueText(volume.background());
    if (!report.backgroundGuess) return "none that is obvious";
    return valueText(*report.backgroundGuess) + ", a guess: " +
           percent(double(volume.mostFrequent()->count), double(volume.activeCount())) +
           " of the voxels have it";
}

std::string deltaText(const DeltaOrigin& origin) {
    std::string text = alongText(origin.sliceAxis) + ", a key slice every " +
                       std::to_string(origin.keyInterval) + ", " + std::to_string(origin.deltas) +
                       " deltas, " + origin.codeBook + " code book, ";
    if (origin.maxError == 0) return text + "exact";
    if (origin.tolerance > 0) text += "tolerance " + numberText(origin.tolerance) + ", ";
    if (origin.toleranceValue > 0)
        text += "tolerance value " + numberText(origin.toleranceValue) + ", ";
    return text + "largest error " + numberText(origin.maxError);
}

std::string codeBookText(const Volume& volume) {
    const CodeError& error = volume.codeError();
    if (error.absolute == 0) return volume.codeBook().name();
    char share[32];
    std::snprintf(share, sizeof share, "%.3g %%", 100 * error.relative);
    return volume.codeBook().name() + ", largest error " + numberText(error.absolute) +
           (error.relative > 0 ? ", " + std::string(share) + " of a value" : "");
}

std::string labelsText(const Volume& volume) {
    if (!volume.labels()) return "";
    constexpr std::size_t kMost = 8;
    const std::vector<LabelEntry>& entries = volume.labels()->entries;
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, entries.size()); ++i) {
        text += (i == 0 ? "" : ", ") + std::to_string(entries[i].value) +
                (entries[i].name.empty() ? "" : " " + printable(entries[i].name));
    }
    if (entries.size() > kMost) text += " and " + std::to_string(entries.size() - kMost) + " more";
    return textLine("labels", text.empty() ? "without names" : text);
}

std::string valuesText(const Volume& volume) {
    if (volume.empty()) return textLine("range", "none");
    std::string shares;
    for (const int share : {1, 50, 99}) {
        shares += (shares.empty() ? "" : ", ") + std::to_string(share) +
                  " %: " + valueText(percentileValue(volume, share));
    }
    return textLine("range", valueText(volume.valueMin()) + " to " + valueText(volume.valueMax())) +
           textLine("percentiles", shares);
}

// A bar that has its full length at 100 % and loses the same for every tenth of it.
std::string bar(double share) {
    constexpr double kFull = 48;
    constexpr double kPerTenth = 12;
    const double length = std::round(kFull + kPerTenth * std::log10(share));
    return std::string(std::size_t(std::max(1.0, length)), '#');
}

std::string histogramText(const Volume& volume) {
    if (volume.empty()) return "";
    const ValueHistogram histogram = histogramOfValues(volume, 16);
    const double width = (histogram.high - histogram.low) / double(histogram.counts.size());
    std::vector<std::string> from;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        char edge[32];
        std::snprintf(edge, sizeof edge, "%.6g", histogram.low + width * double(i) + 0.0);
        from.push_back(edge);
        longest = std::max(longest, from.back().size());
        // Bins of whole numbers may go on behind the largest value, and one value has one bin.
        if (width == 0 || histogram.low + width * double(i + 1) > volume.valueMax()) break;
    }
    std::string text = textLine(
        "histogram", "values from; share of the active voxels; 12 # more: ten times as many");
    for (std::size_t i = 0; i < from.size(); ++i) {
        const double share = double(histogram.counts[i]) / double(volume.activeCount());
        char number[32];
        std::snprintf(number, sizeof number, "%10.4f %%  ", 100 * share);
        text += "    " + padded(from[i], std::max<std::size_t>(longest, 10)) + number +
                (histogram.counts[i] > 0 ? bar(share) : "") + "\n";
    }
    return text;
}

std::string stampsText(const GridReport& report) {
    std::string text =
        textLine("stamps", "predicted for a view along an axis; visible: " + report.visible);
    const auto row = [](const std::string& name, const std::vector<std::string>& cells) {
        std::string words;
        for (const std::string& cell : cells) words += padded(cell, 13);
        return textLine("  " + name, words);
    };
    text += row("", {"traditional", "sparse", "delta", "auto"});
    for (int axis = 0; axis < 3; ++axis) {
        const StampCounts& stamps = report.stamps[axis];
        text +=
            row(alongText(axis), {std::to_string(stamps.traditional), std::to_string(stamps.sparse),
                                  std::to_string(stamps.delta), std::to_string(stamps.automatic)});
    }
    return text;
}

std::string placeText(const Volume& volume) {
    const VolumePlace place = placeOf(volume);
    const Camera camera = makeCamera(CameraOptions(), volume);
    std::string directions;
    for (int axis = 0; axis < 3; ++axis) {
        directions += (axis > 0 ? ", " : "") + std::string(1, "ijk"[axis]) + " " +
                      directionText(place, volume.space(), axis);
    }
    std::string text = textLine("world box", "(" + toText(place.box.min, ", ") + ") to (" +
                                                 toText(place.box.max, ", ") + ")");
    text += textLine("origin", "(" + toText(place.origin, ", ") + ")");
    if (!volume.space().empty()) text += textLine("space", spaceText(volume.space()));
    text += textLine("directions", directions);
    return text +
           textLine("front view", "target (" + toText(camera.targetWorld, ", ") +
                                      "), frame width " + numberText(camera.frameWidthWorld));
}

// Which one of several it is.
std::string choiceText(const GridReport& report) {
    const VolumeEntry& entry = report.entry;
    std::string text;
    if (entry.series) text += textLine("series", seriesText(entry));
    if (entry.volumes > 1) {
        text += textLine("volume", std::to_string(report.volumeIndex) + " of " +
                                       std::to_string(entry.volumes) + ", --volume 0 to " +
                                       std::to_string(entry.volumes - 1));
    }
    return text;
}

std::string gridText(const GridReport& report) {
    const Volume& v = report.volume;
    std::string text =
        textLine("grid", v.name()) + textLine("type", v.type()) + textLine("class", v.gridClass());
    text += choiceText(report);
    text += textLine("dims", toText(v.box().dims(), " x "));
    text += textLine("box", v.empty() ? "empty"
                                      : "(" + toText(v.box().min, ", ") + ") to (" +
                                            toText(v.box().max, ", ") + ")");
    text += textLine("voxel size", sizeText(v.voxelSize()) +
                                       (v.lengthUnit().empty() ? "" : " " + v.lengthUnit())) +
            placeText(v);
    text +=
        textLine("active", std::to_string(v.activeCount()) + " (" +
                               percent(double(v.activeCount()), double(voxelsOf(v.box()))) + ")");
    text += valuesText(v) + labelsText(v);
    text += textLine("background", backgroundText(report)) + textLine("code book", codeBookText(v));
    if (v.origin()) text += textLine("delta grid", deltaText(*v.origin()));
    for (int axis = 0; axis < 3; ++axis) text += textLine(alongText(axis), axisText(report, axis));
    return text + stampsText(report) + histogramText(v);
}

}  // namespace

std::string plainText(const std::vector<FileReport>& reports) {
    std::string text;
    for (const FileReport& report : reports) {
        text += (text.empty() ? "" : "\n") + report.file + "\n";
        for (std::size_t i = 0; i < report.grids.size(); ++i)
            text += (i > 0 ? "\n" : "") + gridText(report.grids[i]);
        for (const std::string& grid : report.others) text += textLine("not read", grid);
        if (!report.medium.emission.empty())
            text += textLine("fire", report.medium.emission + " (--emission-grid auto)");
        if (!report.medium.color.empty())
            text += textLine("colours", report.medium.color + " (--color-grid auto)");
    }
    return text;
}

}  // namespace deltasplat
