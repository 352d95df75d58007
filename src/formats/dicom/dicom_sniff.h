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

/// The files of a folder that are of one DICOM series.
struct DicomSeries {
    std::string uid;          ///< empty if the files do not say it
    std::string description;  ///< what the first file says of it, such as "CT, Thorax 1.5 mm"
    std::size_t files = 0;
    std::filesystem::path firstFile;
    bool images = false;             ///< whether any of them holds an image: reports hold none
    std::vector<DicomSlice> slices;  ///< in no order
    DicomNotes notes;                ///< what users may not expect of its values
    std::optional<Error> error;      ///< what is wrong with the first file that is no slice
};

/// Returns the series that DICOM files are of, by UID. Each header is read once.
/// @param input  for messages
/// @throw Error(kInput) if a file is no DICOM or does not say its series while others do, so that
///        nobody knows what series it is of; or if none is but tables of contents
std::vector<DicomSeries> findSeries(const std::filesystem::path& input,
                                    const std::vector<std::filesystem::path>& files);

/// Returns the series of this UID, or the only one.
/// @param series  at least one
/// @param uid     what was asked for; empty: the only one
/// @throw Error(kInput) if there is no such series, or several and none is asked for
DicomSeries chooseSeries(const std::filesystem::path& input, std::vector<DicomSeries> series,
                         const std::optional<std::string>& uid);

/// Opens the slices of a series.
/// @param input  for messages
/// @throw as readVolume
DenseSource openDicom(const std::filesystem::path& input, const std::string& name,
                      DicomSeries series);

}  // namespace deltasplat
