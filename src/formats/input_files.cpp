// SPDX-License-Identifier: Apache-2.0
#include "formats/input_files.h"

#include <algorithm>
#include <system_error>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/format.h"
#include "formats/images/image_stack.h"
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

// Returns the input itself if it is a folder, else its folder.
fs::path folderOf(const fs::path& input) {
    std::error_code error;
    const fs::path near = fs::is_directory(input, error) ? input : input.parent_path();
    return near.empty() ? "." : near;
}

// Missing files pass: their reader reports them.
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

std::int64_t chooseVolume(const std::string& where, const std::string& axes, std::int64_t count,
                          const std::optional<std::int64_t>& chosen) {
    const std::string which =
        count == 1 ? "`volume` 0" : "`volume` 0 to " + std::to_string(count - 1);
    const std::string held =
        std::to_string(count) + (count == 1 ? " volume (" : " volumes (") + axes + ")";
    if (!chosen && count > 1) {
        throw Error(ErrorCode::kInput, where, held, "one, chosen by " + which);
    }
    const std::int64_t volume = chosen.value_or(0);
    if (volume >= 0 && volume < count) return volume;
    throw Error(ErrorCode::kInput, where, "no volume " + std::to_string(volume) + " among " + held,
                which);
}

namespace {

constexpr std::string_view kSigns = "#@%$*?[]{}\\";

// Removes the escapes, except in folders that exist as written, and in the file name if `keepFile`.
std::string plainPath(const std::string& path, bool keepFile) {
    std::string text;
    for (const NamePart& part : partsOfName(path)) {
        const bool isKept = part.isLiteral || (keepFile && !part.isFolder);
        text += isKept ? part.text : withoutEscapes(part.text);
    }
    return text;
}

}  // namespace

bool isEscape(std::string_view text, std::size_t at) {
    return text[at] == '\\' && at + 1 < text.size() &&
           kSigns.find(text[at + 1]) != std::string_view::npos;
}

bool hasSigns(std::string_view text) {
    return text.find_first_of(kSigns) != std::string_view::npos;
}

std::string maskedEscapes(std::string_view text) {
    std::string masked(text);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!isEscape(text, i)) continue;
        masked[i] = masked[i + 1] = '\0';
        ++i;
    }
    return masked;
}

std::string withoutEscapes(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (isEscape(text, i)) ++i;
        plain += text[i];
    }
    return plain;
}

bool isFolderThere(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
}

std::vector<NamePart> partsOfName(const std::string& path) {
    std::vector<NamePart> parts;
    std::string before;  // as on the disk
    for (std::size_t begin = 0; begin < path.size();) {
        const std::size_t slash = path.find('/', begin);
        NamePart part;
        part.isFolder = slash != std::string::npos;
        part.text = path.substr(begin, part.isFolder ? slash + 1 - begin : std::string::npos);
        part.isLiteral = part.isFolder && hasSigns(part.text) && isFolderThere(before + part.text);
        begin += part.text.size();
        before += part.isLiteral ? part.text : withoutEscapes(part.text);
        parts.push_back(std::move(part));
    }
    return parts;
}

std::filesystem::path plainName(const std::filesystem::path& file) {
    return plainPath(file.string(), false);
}

std::filesystem::path plainInput(const std::filesystem::path& input) {
    std::error_code ignored;
    if (!hasSigns(input.string()) || std::filesystem::exists(input, ignored)) return input;
    const bool isStack = isImageName(input) && stackPattern(input);
    std::filesystem::path plain = plainPath(input.string(), isStack);
    return isStack || std::filesystem::exists(plain, ignored) ? plain : input;
}

}  // namespace deltasplat
