// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "formats/dense/dense_layout.h"
#include "formats/dense/rescale.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// The checked header of a NIfTI-1 or NIfTI-2 file.
struct NiftiHeader {
    std::filesystem::path dataFile;  ///< the file itself, or the .img of a pair
    RawLayout layout;                ///< one volume as stored, after skipBytes
    std::int64_t volumes = 1;        ///< consecutive; together at most 2^62 bytes
    std::string dims;                ///< all axes, for messages: "64x64x36x120"
    Rescale rescale;
    glm::dmat4 worldFromIndex{1.0};
    int placeDigits = 0;     ///< as placeDigitsOf
    bool isLabels = false;   ///< intent NIFTI_INTENT_LABEL: values are label numbers
    std::string space;       ///< "RAS", or empty if the header gives no placement
    std::string lengthUnit;  ///< as Volume::lengthUnit
};

/// Returns the existing files of a NIfTI pair (.hdr, then .img, any case, gzipped or not) that
/// contains `file`; for other names only `file`.
std::vector<std::filesystem::path> niftiFiles(const std::filesystem::path& file);

/// Reads the header of a .nii file or of a pair with `file`, gzipped or not. Warns of a qform that
/// differs from the sform, forms that give no place, converted units, and a lack of both forms.
/// @throw Error(kInput) if the file has no NIfTI header, or the header is invalid or unsupported
NiftiHeader readNiftiHeader(const std::filesystem::path& file, const Listener& listener);

/// Functions for DenseFormat.
void settleNifti(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string niftiHeader(const DenseLayout& layout, const std::string& dataFile);

}  // namespace deltasplat
