// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "formats/dicom/dicom_meaning.h"
#include "formats/dicom/dicom_walk.h"

namespace deltasplat {

/// How the picture is stored that a slice is, or is a part of.
struct DicomPixels {
    std::string syntax;  ///< DICOM's name for how the file is written
    bool bigEndian = false;
    bool packed = false;
    bool words = true;
    using Piece = DicomElements::Piece;
    std::vector<Piece> pieces;  ///< without a table of offsets
    Piece element;              ///< that the piece is a part of, if they are not packed
    int columns = 0;
    int rows = 0;
    DicomBits bits;
};

/// What the header of one DICOM slice says, checked.
struct DicomSlice {
    std::filesystem::path file;
    int frame = 0;  ///< of several in the file, from 1 on; 0 if it is the only one
    int columns = 0;
    int rows = 0;
    int left = 0;  ///< of its first voxel in the picture
    int top = 0;
    DicomPixels pixels;
    DicomMeaning meaning;
    glm::dvec3 position{0.0};     ///< of the centre of the first voxel; millimetres, LPS
    glm::dvec3 alongRow{0.0};     ///< from one column to the next
    glm::dvec3 alongColumn{0.0};  ///< from one row to the next
    double thickness = 1;         ///< along the normal; what a single slice goes by

    glm::dvec3 normal() const;
    /// Returns its file's name, with the folders below the input, and the frame.
    std::string name(const std::filesystem::path& input) const;
};

/// The slices of one volume, in order, and where they lie.
struct DicomVolume {
    std::vector<DicomSlice> slices;  ///< along the normal
    glm::dmat4 worldFromIndex{1.0};
};

/// Sorts the slices of one series by their places.
/// @param input  the folder, or a file in it, for messages
/// @throw Error(kInput) if they are of several sizes or directions, or unevenly spaced
DicomVolume arrangeSlices(const std::filesystem::path& input, std::vector<DicomSlice> slices);

}  // namespace deltasplat
