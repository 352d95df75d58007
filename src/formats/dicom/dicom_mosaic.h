// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/dicom/dicom_slices.h"

namespace deltasplat {

/// Whether a file is a mosaic: a picture that slices are laid out in, row by row.
bool isMosaic(const DicomElements& elements);

/// Returns the slices of a mosaic.
/// @param picture  the mosaic as one slice
/// @param notes    what users may not expect of it
/// @throw Error(kInput) if it does not say how many there are, or they do not fill it
std::vector<DicomSlice> slicesOfMosaic(const DicomElements& elements, const DicomSlice& picture,
                                       DicomNotes& notes);

}  // namespace deltasplat
