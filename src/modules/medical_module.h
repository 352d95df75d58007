// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace deltasplat {

struct DenseSource;
struct DicomSeries;

/// What is read through GDCM, as ImageModule is of OpenImageIO.
struct MedicalModule {
    std::vector<DicomSeries> (*findSeries)(const std::filesystem::path& input,
                                           const std::vector<std::filesystem::path>& files);
    DenseSource (*openDicom)(const std::filesystem::path& input, const std::string& name,
                             DicomSeries series);
};

/// As imageModule().
const MedicalModule& medicalModule();

/// What the module is made of.
namespace medical_module {

std::vector<DicomSeries> findSeries(const std::filesystem::path& input,
                                    const std::vector<std::filesystem::path>& files);
DenseSource openDicom(const std::filesystem::path& input, const std::string& name,
                      DicomSeries series);

inline constexpr MedicalModule kModule{findSeries, openDicom};

}  // namespace medical_module

}  // namespace deltasplat
