// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench_report.h"

namespace deltasplat {

/// A row of Table 1 of "Accelerating Footprint Method Based on Comparability of Consecutive Image
/// Slices".
struct Table1DataSet {
    const char* name;
    const char* file;  ///< which holds it, by its name without folders
    double paper;      ///< the paper's acceleration: its traditional / delta
    bool standIn;      ///< whether the file is another data set than the paper's
};
inline constexpr std::array<Table1DataSet, 4> kTable1 = {{
    {"fuel", "fuel_64x64x64_uint8.raw", 8.06, false},
    {"ear", "ear_region_128x128x30_uint8.raw", 6.46, true},
    {"head", "cthead_256x256x225_uint8.raw.gz", 5.39, false},
    {"engine", "engine_256x256x128_uint8.raw.gz", 7.24, false},
}};

// The paper's setting.
inline constexpr int kTable1Footprint = 6;   ///< width and height of the footprint in sheet pixels
inline constexpr double kTable1Sigma = 1.0;  ///< voxels; most of the Gaussian fits the footprint
inline constexpr double kTable1ToleranceValue = 2;  ///< of the second block of rows, in data units

/// A data set, measured.
struct Table1Row {
    Table1DataSet dataSet;
    BenchEntry exact;
    BenchEntry held;  ///< with data values held within kTable1ToleranceValue
};

/// All that `bench table1` has to say.
struct Table1Report {
    Machine machine;
    std::string transferFunction;  ///< its file, or what is built in
    int repeats = 0;
    std::vector<Table1Row> rows;  ///< of the data sets that were there
};

/// Returns where the files of the data sets are, by their names: anywhere below a folder, links to
/// folders followed. Of several files of one name, the one in the fewest folders.
/// @throw Error(kInput) if there is no such folder
std::map<std::string, std::filesystem::path> findTable1Files(const std::filesystem::path& folder,
                                                             const Listener& listener = {});

/// Returns how a volume is rendered: along z from the front, as large as its slices.
RenderOptions table1Options(const Volume& volume, const TransferFunction& transferFunction);

/// Returns one JSON object with a line end, its runs as in `bench --json`.
std::string jsonText(const Table1Report& report);

/// Returns the tables, a row for each data set of the paper, measured or not.
/// @param report  with at least one row
std::string plainText(const Table1Report& report);

}  // namespace deltasplat
