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

/// What the header of a NIfTI-1 or NIfTI-2 file says, checked.
struct NiftiHeader {
    std::filesystem::path dataFile;  ///< the file itself, or the .img of a pair
    RawLayout layout;                ///< of the values of one volume as stored, behind skipBytes
    std::int64_t volumes = 1;        ///< one behind the other; all of their bytes fit into 62 bits
    std::string dims;                ///< of all axes, for messages: "64x64x36x120"
    Rescale rescale;
    glm::dmat4 worldFromIndex{1.0};
    int placeDigits = 0;     ///< as placeDigitsOf
    bool isLabels = false;   ///< intent NIFTI_INTENT_LABEL: values are numbers of names
    std::string space;       ///< "RAS", or empty if the header places the voxels nowhere
    std::string lengthUnit;  ///< as Volume::lengthUnit
};

/// Returns the header and the data file of a NIfTI pair of which `file` is one (.hdr and .img, in
/// any case and under gzip or not), each only where it is there; for other names the file alone.
std::vector<std::filesystem::path> niftiFiles(const std::filesystem::path& file);

/// Reads the header of a .nii file, or of a pair of which `file` is one, under gzip or not. Warns
/// of what is passed over or turned: a qform that differs from the sform, a form that gives voxels
/// no place, units that become millimetres, a header that has neither form.
/// @throw Error(kInput) if it is no NIfTI header or says what cannot be meant or is not supported
NiftiHeader readNiftiHeader(const std::filesystem::path& file, const Listener& listener);

/// As DenseFormat has them.
void settleNifti(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string niftiHeader(const DenseLayout& layout, const std::string& dataFile);

}  // namespace deltasplat
