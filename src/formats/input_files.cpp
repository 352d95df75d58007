// SPDX-License-Identifier: Apache-2.0
#include "formats/input_files.h"

#include <algorithm>
#include <system_error>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/input_kind.h"
#include "formats/nifti/read_nifti.h"
#include "formats/text/text_header.h"

namespace deltasplat {
namespace {

// The name that a header gives of its data file; empty if the data follows the header.
std::string dataNameIn(const std::filesystem::path& header, InputKind::Format format) {
    if (format == InputKind::Format::kNrrd) {
        const TextHeader text = readNrrdHeader(header);
        const std::string* const name = text.find("datafile");
        return name == nullptr ? "" : *name;
    }
    const std::string name = readMetaHeader(header).fields.back().value;
    return lowerCase(name) == "local" ? "" : name;
}

// The two files of a NIfTI pair, that which was named first.
std::vector<std::filesystem::path> withPartner(const std::filesystem::path& input) {
    std::vector<std::filesystem::path> files{input};
    for (const std::filesystem::path& file : niftiFiles(input))
        if (file != input) files.push_back(file);
    return files;
}

}  // namespace

std::vector<std::filesystem::path> filesOf(const std::filesystem::path& input) {
    try {
        InputKind kind = findInput(input, {});
        if (kind.format == InputKind::Format::kNifti) return withPartner(input);
        if (kind.format == InputKind::Format::kNrrd ||
            kind.format == InputKind::Format::kMetaImage) {
            const std::string name = dataNameIn(input, kind.format);
            if (!name.empty()) kind.files.push_back(input.parent_path() / name);
        }
        return kind.files;
    } catch (const Error&) {
        return {input};
    }
}

namespace {

bool& confined() {
    static bool confined = false;
    return confined;
}

}  // namespace

void confineInputs() {
    confined() = true;
}

bool inputsAreConfined() {
    return confined();
}

namespace {

namespace fs = std::filesystem;

// The folder of an input, or the one that it is.
fs::path folderOf(const fs::path& input) {
    std::error_code error;
    const fs::path near = fs::is_directory(input, error) ? input : input.parent_path();
    return near.empty() ? "." : near;
}

// What is not there at all is for its reader to say.
bool isWithin(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path around = fs::canonical(fs::absolute(folder), error);
    const fs::path real = fs::weakly_canonical(fs::absolute(file), error);
    const auto parted = std::mismatch(around.begin(), around.end(), real.begin(), real.end());
    return !error && !around.empty() && parted.first == around.end();
}

void requireInFolderOf(const fs::path& input, const std::vector<fs::path>& files) {
    const fs::path folder = folderOf(input);
    for (const fs::path& file : files) {
        if (isWithin(folder, file)) continue;
        throw Error(ErrorCode::kInput, input.string(),
                    "the file " + printable(file.string()) + " outside of its folder",
                    "files inside of it (`confineInputs`)");
    }
}

}  // namespace

void requireFoundIn(const std::filesystem::path& folder, const std::filesystem::path& input) {
    const fs::path base = folder.empty() ? "." : folder;
    if (!inputsAreConfined() || isWithin(base, folderOf(input))) return;
    throw Error(ErrorCode::kInput, input.string(),
                "a folder outside of " + printable(base.string()) + ", in which the pattern looks",
                "folders inside of it (`confineInputs`)");
}

void requireConfined(const std::filesystem::path& input) {
    requireInFolderOf(input, filesOf(input));
}

void requireConfined(const std::filesystem::path& input, const std::filesystem::path& named) {
    if (inputsAreConfined()) requireInFolderOf(input, {named});
}

}  // namespace deltasplat
