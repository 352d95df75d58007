// SPDX-License-Identifier: Apache-2.0
#include "ingest/input_files.h"

#include "deltasplat/error.h"
#include "ingest/file_name.h"
#include "ingest/input_kind.h"
#include "ingest/text_header.h"
#include "lower_case.h"

namespace deltasplat {
namespace {

// The name that a header gives of its data file; empty if the data follows the header.
std::string dataNameIn(const std::filesystem::path& header) {
    const std::string extension = lowerExtension(header);
    if (extension == ".nrrd" || extension == ".nhdr") {
        const TextHeader text = readNrrdHeader(header);
        const std::string* const name = text.find("datafile");
        return name == nullptr ? "" : *name;
    }
    const std::string name = readMetaHeader(header).fields.back().value;
    return lowerCase(name) == "local" ? "" : name;
}

}  // namespace

std::vector<std::filesystem::path> filesOf(const std::filesystem::path& input) {
    try {
        InputKind kind = findInput(input, {});
        if (kind.format == InputKind::Format::kItk) {
            const std::string name = dataNameIn(input);
            if (!name.empty()) kind.files.push_back(input.parent_path() / name);
        }
        return kind.files;
    } catch (const Error&) {
        return {input};
    }
}

}  // namespace deltasplat
