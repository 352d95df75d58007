// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "render/render_options.h"

namespace deltasplat {

/// A picture of a batch.
struct BatchItem {
    std::filesystem::path input;
    std::filesystem::path folder;  ///< relative to the pattern's
    std::filesystem::path output;
    std::filesystem::path stats;      ///< empty: none
    std::optional<std::string> grid;  ///< empty: as the command says
    std::optional<Error> failure;     ///< why it cannot be made
};

/// Returns its file, and the grid if that is said.
std::string nameOfItem(const BatchItem& item);

/// Finds what pictures are to be made of. Folders and files whose grids cannot be read become
/// items that have failed.
/// @throw Error(kUsage) for names of outputs that are none, or of two pictures; Error(kInput) if
/// there is no file
std::vector<BatchItem> findBatch(const RenderCommand& command, const Listener& listener);

}  // namespace deltasplat
