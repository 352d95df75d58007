// SPDX-License-Identifier: Apache-2.0
#include "formats/input_files.h"

#include <algorithm>
#include <system_error>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/format.h"
#include "formats/input_kind.h"

namespace deltasplat {
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& input) {
    try {
        const InputKind kind = findInput(input, {});
        return kind.format->files ? kind.format->files(input) : kind.files;
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
