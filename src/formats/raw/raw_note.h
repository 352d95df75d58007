// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/dense/dense_layout.h"

namespace deltasplat {

/// Says what a file does not say of where voxels lie and options can, and what nothing brings back.
/// @param lack     what the file does not have
/// @param options  that it has to be read with besides
void notePlace(const DenseLayout& layout, const std::string& lack, std::string options,
               WriteNotes& notes);

/// As DenseFormat::settle: a file without a header, of which the name may say something.
void settleRaw(DenseLayout& layout, const std::string& file, WriteNotes& notes);
inline std::string noHeader(const DenseLayout&, const std::string&) {
    return {};
}

}  // namespace deltasplat
