// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "deltasplat/error.h"
#include "formats/dense/dense_source.h"
#include "formats/dicom/dicom_slices.h"

namespace deltasplat {

struct DicomSyntax {
    bool explicitTypes = true;  ///< each element says the type of its value
    bool bigEndian = false;
};

struct DicomStart {
    std::uint64_t place = 0;          ///< offset of the first element
    std::optional<DicomSyntax> bare;  ///< encoding; empty if a header (group 2) gives it
    bool isContents = false;          ///< a table of contents, usually named DICOMDIR
};

/// Whether two letters name a value type with a 2-byte, or a 4-byte, length.
bool isShortDicomType(std::string_view letters);
bool isLongDicomType(std::string_view letters);

/// Recognises a DICOM file by its first bytes: by the "DICM" mark, or by a data set that names its
/// class. Nothing for other files.
/// @throw Error(kInput) if the file cannot be opened
std::optional<DicomStart> dicomStart(const std::filesystem::path& file);

/// Whether a file begins as DICOM and is no table of contents. Throws as dicomStart.
inline bool isDicom(const std::filesystem::path& file) {
    const std::optional<DicomStart> start = dicomStart(file);
    return start && !start->isContents;
}

struct DicomSeries {
    std::string uid;          ///< empty if the files have none
    std::string description;  ///< from the first file, such as "CT, Thorax 1.5 mm"
    std::size_t files = 0;
    std::filesystem::path firstFile;
    bool images = false;             ///< whether any file holds an image; reports hold none
    std::vector<DicomSlice> slices;  ///< unordered
    DicomNotes notes;                ///< surprises about the values, for the user
    std::optional<Error> error;      ///< the first file's that is no slice
};

/// Groups DICOM files into series by UID, reading each header once.
/// @throw Error(kInput) if a file is no DICOM, or has no series UID while others do, because its
///        series is then unknown; or if all files are tables of contents
std::vector<DicomSeries> findSeries(const std::filesystem::path& input,
                                    const std::vector<std::filesystem::path>& files);

/// Returns the series with this UID, or the only one; `series` is not empty.
/// @param uid     the requested UID; empty: the only series
/// @throw Error(kInput) if that series does not exist, or there are several and none is requested
DicomSeries chooseSeries(const std::filesystem::path& input, std::vector<DicomSeries> series,
                         const std::optional<std::string>& uid);

/// @throw as readVolume
DenseSource openDicom(const std::filesystem::path& input, const std::string& name,
                      DicomSeries series);

}  // namespace deltasplat
