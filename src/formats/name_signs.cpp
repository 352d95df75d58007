// SPDX-License-Identifier: Apache-2.0
#include "formats/name_signs.h"

#include <system_error>

#include "formats/images/image_stack.h"
#include "formats/input_kind.h"

namespace deltasplat {
namespace {

constexpr std::string_view kSigns = "#@%$*?[]{}\\";

// The path with escapes taken out, but for folders that are there, and for the file if it is kept.
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
    std::string before;  // as it is on the disk
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
