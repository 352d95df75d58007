// SPDX-License-Identifier: Apache-2.0
// Stands in for what reads through GDCM, where the library is built without it.
#include "deltasplat/error.h"
#include "modules/medical_module.h"

namespace deltasplat {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& input, const std::string& got) {
    throw Error(ErrorCode::kInput, input.string(), got,
                "a build with DELTASPLAT_DICOM=ON to read DICOM");
}

}  // namespace

std::vector<DicomSeries> medical_module::findSeries(const std::filesystem::path& input,
                                                    const std::vector<std::filesystem::path>&) {
    refuse(input, "DICOM");
}

// As it is declared for those who read: they keep the series.
// NOLINTBEGIN(performance-unnecessary-value-param)
DenseSource medical_module::openDicom(const std::filesystem::path& input, const std::string&,
                                      DicomSeries) {
    refuse(input, "DICOM");
}
// NOLINTEND(performance-unnecessary-value-param)

}  // namespace deltasplat
