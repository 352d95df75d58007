// SPDX-License-Identifier: Apache-2.0
#include "ingest/label_claim.h"

#include <string>

#include "ingest/files/byte_source.h"
#include "ingest/files/file_name.h"
#include "ingest/nifti/nifti_header.h"

namespace deltasplat {
namespace {

// Keys of an NRRD header are lines of their own; an empty line ends it.
bool hasSegments(const std::filesystem::path& file) {
    constexpr std::size_t kMostHeader = std::size_t{1} << 20;
    ByteSource source(file, Packing::kNone);
    std::string text(kMostHeader, '\0');
    text.resize(source.read(text.data(), text.size()));
    std::erase(text, '\r');
    return text.substr(0, text.find("\n\n")).find("\nSegment0_ID:=") != std::string::npos;
}

}  // namespace

bool saysLabels(const std::filesystem::path& input) {
    if (std::filesystem::is_directory(input)) return false;
    const std::string extension = lowerExtension(input);
    if (extension == ".nii" || extension == ".nii.gz") return readNiftiHeader(input, {}).isLabels;
    return (extension == ".nrrd" || extension == ".nhdr") && hasSegments(input);
}

}  // namespace deltasplat
