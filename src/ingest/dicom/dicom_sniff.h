// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace deltasplat {

/// How the elements of a DICOM data set are written.
struct DicomSyntax {
    bool explicitTypes = true;  ///< each element says the type of its value
    bool bigEndian = false;
};

/// How a DICOM file begins.
struct DicomStart {
    std::uint64_t place = 0;  ///< of its first element
    /// How the data set is written; empty if a header, group 2, says it.
    std::optional<DicomSyntax> bare;
    bool isContents = false;  ///< a table of contents, as DICOMDIR is under that name
};

/// Whether two letters are a type of values, of which lengths are two bytes, or four.
bool isShortDicomType(std::string_view letters);
bool isLongDicomType(std::string_view letters);

/// Returns how a file begins that is DICOM by its first bytes: by the letters that mark it, or
/// without them by a data set that names its class. Nothing for other files.
/// @throw Error(kInput) if it cannot be opened
std::optional<DicomStart> dicomStart(const std::filesystem::path& file);

/// Whether a file is DICOM, and no table of contents, by its first bytes.
/// @throw Error(kInput) if it cannot be opened
inline bool isDicom(const std::filesystem::path& file) {
    const std::optional<DicomStart> start = dicomStart(file);
    return start && !start->isContents;
}

}  // namespace deltasplat
