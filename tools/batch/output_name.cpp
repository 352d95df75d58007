// SPDX-License-Identifier: Apache-2.0
#include "batch/output_name.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/input_files.h"

namespace deltasplat {
namespace {

constexpr std::array<std::string_view, 4> kPlaces{"name", "dir", "frame", "grid"};
constexpr const char* kKnown = "{name}, {dir}, {frame} or {grid}";
constexpr std::string_view kDigits = "0123456789";

bool isKnown(std::string_view place) {
    return std::find(kPlaces.begin(), kPlaces.end(), place) != kPlaces.end();
}

std::string lastNumber(const std::string& name) {
    const std::size_t last = name.find_last_of(kDigits);
    if (last == std::string::npos) return "";
    const std::size_t before = name.find_last_not_of(kDigits, last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    return name.substr(first, last + 1 - first);
}

// A name of a file, or of part of one.
std::string fileText(std::string name) {
    std::replace(name.begin(), name.end(), '/', '_');
    if (name.starts_with('.')) name[0] = '_';
    return name;
}

// A path with 0 in place of signs that stand for themselves, 1 in that of whole folders.
std::string signsOf(const std::string& path) {
    std::string signs;
    for (const NamePart& part : partsOfName(path))
        signs += part.isLiteral ? std::string(part.text.size(), '\1') : maskedEscapes(part.text);
    return signs;
}

}  // namespace

InputParts partsOfInput(const std::filesystem::path& file, const std::filesystem::path& folder) {
    InputParts parts;
    std::error_code ignored;
    // Folders have dots in their names, and no extensions.
    parts.name = std::filesystem::is_directory(file, ignored) ? file.filename().string()
                                                              : nameWithoutExtensions(file);
    parts.folder = folder;
    parts.frame = lastNumber(parts.name);
    return parts;
}

bool hasPlaceholder(const std::filesystem::path& file) {
    const std::string text = signsOf(file.string());
    return std::any_of(kPlaces.begin(), kPlaces.end(), [&](std::string_view place) {
        return text.find("{" + std::string(place) + "}") != std::string::npos;
    });
}

OutputName::OutputName(std::string option, const std::filesystem::path& file)
    : option_(std::move(option)), file_(file.string()) {
    const auto refuse = [&](const std::string& got) {
        throw Error(ErrorCode::kUsage, option_, got, kKnown);
    };
    const std::string signs = signsOf(file_);
    std::string text;
    bool hasAny = false;
    for (std::size_t i = 0; i < file_.size(); ++i) {
        const bool isEscaped = signs[i] == '\0' && isEscape(file_, i);
        if (isEscaped || signs.compare(i, 2, "{{") == 0 || signs.compare(i, 2, "}}") == 0) {
            text += file_[isEscaped ? i + 1 : i];
            ++i;
        } else if (signs[i] != '{') {
            text += file_[i];
        } else {
            const std::size_t end = signs.find('}', i);
            if (end == std::string::npos) refuse("{ without } (a brace by itself is {{)");
            const std::string place = file_.substr(i + 1, end - i - 1);
            if (!isKnown(place)) refuse("{" + place + "} (a brace by itself is {{)");
            pieces_.push_back({std::exchange(text, {}), false});
            pieces_.push_back({place, true});
            hasAny = true;
            i = end;
        }
    }
    pieces_.push_back({text, false});
    if (!hasAny) {
        throw Error(ErrorCode::kUsage, option_, file_ + " with a pattern of inputs",
                    std::string("a name with ") + kKnown);
    }
}

bool OutputName::hasGrid() const {
    return std::any_of(pieces_.begin(), pieces_.end(),
                       [](const Piece& piece) { return piece.isPlace && piece.text == "grid"; });
}

std::filesystem::path OutputName::of(const InputParts& parts,
                                     const std::filesystem::path& input) const {
    std::string text;
    bool dropsSlash = false;
    for (const Piece& piece : pieces_) {
        // A folder that is all of what stands between slashes.
        const bool isFolder =
            piece.isPlace && piece.text == "dir" && (text.empty() || text.ends_with('/'));
        if (!piece.isPlace) {
            text += piece.text.substr(dropsSlash && piece.text.starts_with('/') ? 1 : 0);
        } else if (piece.text == "name") {
            text += parts.name;
        } else if (piece.text == "dir") {
            text += parts.folder.string();
        } else if (piece.text == "grid") {
            text += fileText(parts.grid);
        } else if (!parts.frame.empty()) {
            text += parts.frame;
        } else {
            throw Error(ErrorCode::kUsage, option_, file_ + " for " + input.string(),
                        "inputs with a number in their names for {frame}");
        }
        dropsSlash = isFolder && parts.folder.empty();
    }
    return text;
}

}  // namespace deltasplat
