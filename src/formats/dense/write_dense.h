// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "deltasplat/convert/write_volume.h"
#include "formats/dense/dense_layout.h"

namespace deltasplat {

/// Writes a volume as a file of a dense format; see writeVolumes.
WriteReport writeDense(const std::filesystem::path& file, const DenseFormat& format,
                       const Volume& volume, const Listener& listener);

}  // namespace deltasplat
