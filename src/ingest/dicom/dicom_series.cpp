// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_series.h"

#include <algorithm>

#include "printable.h"

namespace deltasplat {
namespace {

std::string nameOf(const std::string& uid) {
    return uid.empty() ? "\"\"" : printable(uid);
}

// "512x512x120", or how many files there are where they are no slices.
std::string sizeText(const DicomSeries& series) {
    if (series.slices.empty() || series.error)
        return std::to_string(series.files) + (series.files == 1 ? " file" : " files");
    return std::to_string(series.slices[0].columns) + "x" + std::to_string(series.slices[0].rows) +
           "x" + std::to_string(series.slices.size());
}

// Of some dozens of series every UID, from which one has to be chosen.
std::string listText(const std::vector<DicomSeries>& all) {
    std::string list;
    for (const DicomSeries& series : all) {
        if (list.size() > 3000) return list + ", ...";
        list += (list.empty() ? "" : ", ") + nameOf(series.uid) + " (" +
                (series.description.empty() ? "" : series.description + ", ") + sizeText(series) +
                ")";
    }
    return list;
}

}  // namespace

DicomSeries chooseSeries(const std::filesystem::path& input, std::vector<DicomSeries> series,
                         const std::optional<std::string>& uid) {
    if (uid) {
        const auto chosen = std::find_if(series.begin(), series.end(),
                                         [&](const DicomSeries& one) { return one.uid == *uid; });
        if (chosen != series.end()) return std::move(*chosen);
        throw Error(ErrorCode::kInput,
                    gotExpected(input.string(), "no DICOM series " + nameOf(*uid),
                                "`series` of " + listText(series)));
    }
    if (series.size() == 1) return std::move(series.front());
    throw Error(ErrorCode::kInput,
                gotExpected(input.string(),
                            std::to_string(series.size()) + " DICOM series: " + listText(series),
                            "one, chosen by `series` UID"));
}

}  // namespace deltasplat
