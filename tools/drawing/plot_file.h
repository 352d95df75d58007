// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "drawing/drawing.h"

namespace deltasplat {

/// Whether writeDrawing knows the extension: .png or .svg.
bool isDrawingFile(const std::filesystem::path& file);

/// Throws unless writeDrawing could write this file: asked before long work.
/// @throw Error(kUsage) for an extension other than .png and .svg; Error(kOutput) if the folder
/// does not exist or cannot be written to
void checkDrawingFile(const std::filesystem::path& file);

/// Writes a drawing as `.svg`, or as `.png` at two pixels a unit, by extension in any case. The
/// file appears under its final name only when it is whole. The same drawing gives the same bytes.
/// @throw as checkDrawingFile; Error(kFailed) if a .png does not fit into memory
void writeDrawing(const std::filesystem::path& file, const Drawing& drawing);

}  // namespace deltasplat
