// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <glm/vec2.hpp>
#include <vector>

#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/ingest/read_volume.h"
#include "optics/label_function.h"

namespace deltasplat {

/// Slices along an axis: 0 = i, 1 = j, 2 = k.
struct AxisSlices {
    std::size_t axis = 2;
    glm::ivec2 range{0};  ///< first and last
};

/// Which parts of a volume are shown, as asked for.
struct CutChoice {
    Cut cut;                         ///< but for slices and mask
    std::vector<AxisSlices> slices;  ///< of several of an axis the last counts
    std::filesystem::path mask;      ///< FILE or FILE:GRID; empty: none
    LabelChanges labels;

    bool cuts() const;
};

/// Declares the options that cut a volume.
void addCutOptions(CLI::App& app, CutChoice& choice);

/// Declares the options that change a table of labels.
void addLabelOptions(CLI::App& app, LabelChanges& changes);

/// Returns the file of the mask, if there is one.
/// @throw Error(kUsage) if a grid is asked for of what is no .vdb, or has no name
std::vector<std::filesystem::path> filesOfMask(const CutChoice& choice);

/// Cuts a volume that was read from a file.
/// @param read  how it was read: the same goes for the mask, as far as it is meant for both
/// @throw as readVolume, of the mask, and cutVolume; Error(kInput) if a mask that says nothing of
///        its place, or is for a volume that does not, has other dimensions
Volume cutAsChosen(const Volume& volume, const std::filesystem::path& input,
                   const CutChoice& choice, const ReadOptions& read, const Listener& listener);

}  // namespace deltasplat
