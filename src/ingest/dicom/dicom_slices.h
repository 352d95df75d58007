// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "ingest/dense/rescale.h"
#include "ingest/dicom/dicom_walk.h"

namespace deltasplat {

/// How the pixels of a slice are stored.
struct DicomPixels {
    std::string syntax;  ///< DICOM's name for how the file is written
    bool bigEndian = false;
    bool packed = false;
    bool words = true;
    using Piece = DicomElements::Piece;
    std::vector<Piece> pieces;
    int bitsAllocated = 16;  ///< 8, 16 or 32
    int bitsStored = 16;     ///< the lowest of them
    bool isSigned = false;
    Rescale rescale;
};

/// What the header of one DICOM slice says, checked.
struct DicomSlice {
    std::filesystem::path file;
    int columns = 0;
    int rows = 0;
    DicomPixels pixels;
    RawType type = RawType::kUint8;  ///< of the values, rescale slope and intercept applied
    glm::dvec3 position{0.0};        ///< of the centre of the first voxel; millimetres, LPS
    glm::dvec3 alongRow{0.0};        ///< from one column to the next
    glm::dvec3 alongColumn{0.0};     ///< from one row to the next
    double thickness = 1;            ///< along the normal; what a single slice goes by

    glm::dvec3 normal() const;
    std::string name() const { return file.filename().string(); }
};

/// The slices of one volume, in order, and where they lie.
struct DicomVolume {
    std::vector<DicomSlice> slices;  ///< along the normal
    glm::dmat4 worldFromIndex{1.0};
};

/// Sorts the slices of one series by their places.
/// @param folder  for messages
/// @throw Error(kInput) if they are of several sizes or directions, or unevenly spaced
DicomVolume arrangeSlices(const std::string& folder, std::vector<DicomSlice> slices);

}  // namespace deltasplat
