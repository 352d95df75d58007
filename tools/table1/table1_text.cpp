// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "base/text.h"
#include "bench/bench_words.h"
#include "table1/table1.h"

namespace deltasplat {
namespace {

using Cells = std::vector<std::string>;

// Sets cells in columns as wide as what is in them: the first one to the left, others to the right.
std::string columns(const std::vector<Cells>& rows) {
    std::vector<std::size_t> widths;
    for (const Cells& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const Cells& row : rows) {
        std::string line = "  " + row.at(0) + std::string(widths[0] - row[0].size(), ' ');
        for (std::size_t i = 1; i < row.size(); ++i)
            line += std::string(widths[i] + 2 - row[i].size(), ' ') + row[i];
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

const Table1Row* rowOf(const Table1Report& report, const Table1DataSet& dataSet) {
    for (const Table1Row& row : report.rows)
        if (row.dataSet.name == std::string(dataSet.name)) return &row;
    return nullptr;
}

std::string nameOf(const Table1DataSet& dataSet) {
    return dataSet.name + std::string(dataSet.standIn ? " *" : "");
}

double ratio(std::uint64_t a, std::uint64_t b) {
    return b > 0 ? double(a) / double(b) : std::numeric_limits<double>::quiet_NaN();
}

// The paper's columns, and those that explain them.
Cells timeCells(const Table1DataSet& dataSet, const BenchRun& run) {
    const RenderStats& stats = run.stats;
    Cells cells = {nameOf(dataSet), dimsText(run.dims), fixedText(run.comparability(), 4),
                   fixedText(100 * ratio(stats.deltas, stats.voxels), 2) + " %",
                   fixedText(ratio(stats.voxels, stats.deltas), 2)};
    for (const MethodRuns& method : run.methods)
        cells.push_back(millisecondsText(method.render.median));
    cells.push_back(fixedText(run.speedup(Method::kTraditional, Method::kDelta), 2));
    cells.push_back(fixedText(run.speedup(Method::kSparse, Method::kDelta), 2));
    cells.push_back(fixedText(dataSet.paper, 2));
    return cells;
}

Cells stampCells(const Table1DataSet& dataSet, const BenchRun& run) {
    Cells cells = {nameOf(dataSet)};
    for (const MethodRuns& method : run.methods) cells.push_back(std::to_string(method.stamps));
    for (const MethodRuns& method : run.methods)
        cells.push_back(fixedText(method.nanosecondsPerStamp(), 2));
    if (run.tolerance) {
        cells.push_back(errorText(run.tolerance->measured.color));
        cells.push_back(errorText(run.tolerance->measured.alpha));
    }
    return cells;
}

// One line for all volumes, or one for each if methods differ on any.
std::string identityLines(const Table1Report& report, BenchEntry Table1Row::*part) {
    std::string text;
    bool identical = true;
    for (const Table1Row& row : report.rows) {
        const BenchRun& run = (row.*part).run;
        text += "  " + std::string(row.dataSet.name) + ": pixels " + identityText(run) + "\n";
        identical = identical && run.identical;
    }
    return identical ? "  pixels " + identityText((report.rows.at(0).*part).run) + "\n" : text;
}

const Cells kMethodNames = {"traditional", "sparse", "delta", "auto"};

std::string timeTable(const Table1Report& report, BenchEntry Table1Row::*part) {
    std::vector<Cells> rows = {{"", "", "comparability", "", "", "milliseconds:", "", "", "",
                                "traditional", "sparse", "paper's"},
                               {"data set", "voxels", "along z", "deltas", "ceiling"}};
    rows[1].insert(rows[1].end(), kMethodNames.begin(), kMethodNames.end());
    rows[1].insert(rows[1].end(), {"/ delta", "/ delta", "ratio"});
    for (const Table1DataSet& dataSet : kTable1) {
        if (const Table1Row* const row = rowOf(report, dataSet)) {
            rows.push_back(timeCells(dataSet, (row->*part).run));
        } else {
            Cells cells(rows[1].size());
            cells.front() = nameOf(dataSet);
            cells[1] = "not measured";
            cells.back() = fixedText(dataSet.paper, 2);
            rows.push_back(cells);
        }
    }
    return columns(rows);
}

std::string stampTable(const Table1Report& report, BenchEntry Table1Row::*part) {
    std::vector<Cells> rows = {{"", "stamps:", "", "", "", "ns/stamp:", "", "", ""}, {"data set"}};
    for (int twice = 0; twice < 2; ++twice)
        rows[1].insert(rows[1].end(), kMethodNames.begin(), kMethodNames.end());
    if ((report.rows.at(0).*part).run.tolerance) {
        rows[0].push_back("difference:");
        rows[1].insert(rows[1].end(), {"colour", "alpha"});
    }
    for (const Table1Row& row : report.rows)
        rows.push_back(stampCells(row.dataSet, (row.*part).run));
    return columns(rows);
}

// One block of rows: the exact ones, or those with a tolerance.
std::string block(const Table1Report& report, BenchEntry Table1Row::*part) {
    return timeTable(report, part) + "\n" + stampTable(report, part) + "\n" +
           identityLines(report, part);
}

std::string setting(const Table1Report& report) {
    const std::string footprint = std::to_string(kTable1Footprint);
    return "Table 1 of \"Accelerating Footprint Method Based on Comparability of Consecutive Image "
           "Slices\"\n"
           "  front view along z, one pixel a voxel, composite, 1 thread, 1 sheet pixel a voxel,\n"
           "  footprint " +
           footprint + " x " + footprint + " (sigma " + fixedText(kTable1Sigma, 1) +
           "), transfer function: " + report.transferFunction +
           "\n  milliseconds of render (splat, composite, warp), medians of " +
           std::to_string(report.repeats) +
           ", interleaved\n"
           "  ceiling: voxels / deltas; paper's ratio: the paper's traditional / delta\n"
           "  difference: the largest of any pixel's channels from the exact picture\n";
}

const char* footnotes() {
    return "  * a stand-in for the paper's ear data set: a part of another scan, its ratio is not "
           "to be\n    compared with the paper's\n"
           "  Here every method stamps footprints one by one, as the paper does, with the same "
           "kernel.\n"
           "  Footprints that screens ask for are mostly of one pixel, which is written, and "
           "others\n"
           "  summed tile by tile where much changes, which helps dense work (traditional) most.\n";
}

}  // namespace

std::string plainText(const Table1Report& report) {
    std::string files;
    for (const Table1Row& row : report.rows) files += "  " + row.exact.input + "\n";
    return hardwareText(report.machine) + "\n" + softwareText(report.machine) + "\n\n" +
           setting(report) + files + "\nexact\n" + block(report, &Table1Row::exact) +
           "\ndata values held within " + fixedText(kTable1ToleranceValue, 0) + " of 255\n" +
           block(report, &Table1Row::held) + "\n" + footnotes();
}

}  // namespace deltasplat
