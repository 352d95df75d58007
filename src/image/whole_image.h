// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace deltasplat {

/// Whether a file is an image of which all pixels can be read: not cut short by a copy that broke
/// off, and not another kind of file.
bool isWholeImage(const std::filesystem::path& file);

}  // namespace deltasplat
