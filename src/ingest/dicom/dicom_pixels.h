// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "ingest/dicom/dicom_slices.h"

namespace deltasplat {

/// Returns the type of a slice's values after its rescale: the smallest that holds them.
RawType dicomValueType(const DicomPixels& pixels);

/// Reads the pixels of a slice through GDCM and rescales them.
/// @param to  [rows][columns] of slice.type
/// @throw Error(kInput) if GDCM refuses them
void readDicomPixels(const DicomSlice& slice, std::byte* to);

}  // namespace deltasplat
