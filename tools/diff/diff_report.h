// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/ingest/volume.h"
#include "diff/diff_options.h"

namespace deltasplat {

/// The numbers are the exit codes of idiff.
enum class Verdict : int { kPass = 0, kWarning = 1, kFailure = 2 };

/// Two grids and how they differ.
struct GridDiff {
    Volume a;  ///< without its codes and its source
    Volume b;  ///< without its codes and its source
    VolumeComparison comparison;
    Verdict verdict = Verdict::kPass;
};

struct FileDiff {
    std::vector<GridDiff> grids;
    std::vector<std::string> onlyInA;      ///< scalar grids of A that B has not
    std::vector<std::string> onlyInB;      ///< scalar grids of B that A has not
    std::vector<std::string> notCompared;  ///< as "velocity (vec3s)": not scalar, or not finite
    bool incompleteCounts = true;          ///< whether any of these make the files different

    /// Whether a grid of either file was compared with nothing.
    bool isIncomplete() const {
        return !onlyInA.empty() || !onlyInB.empty() || !notCompared.empty();
    }
    /// The worst verdict; a failure if a grid was compared with nothing and that counts.
    Verdict verdict() const;
};

/// Says whether a comparison passes. Values have to be within the thresholds; backgrounds, which
/// stand for any number of voxels, as well; places, active states and sizes have to agree.
Verdict judge(const VolumeComparison& comparison, const CompareOptions& thresholds,
              const DiffLimits& limits);

/// The files of a frame and how they differ.
struct FrameDiff {
    int frame;
    std::filesystem::path a, b;
    FileDiff diff;
};

/// Returns one JSON object with a line end: the worst of all grids, then `"grids"`, one by one.
std::string jsonText(const FileDiff& diff);

/// Returns one JSON object with a line end: the worst of all grids of all frames, then `"frames"`,
/// what there would be of each by itself, with its number and its files.
std::string jsonText(const std::vector<FrameDiff>& frames);

/// Returns one block of lines for each pair of grids, and last PASS, WARNING or FAILURE.
std::string plainText(const FileDiff& diff, const DiffOptions& options);

/// Returns a line that says how many frames pass, and which do not.
std::string plainText(const std::vector<FrameDiff>& frames);

}  // namespace deltasplat
