// SPDX-License-Identifier: Apache-2.0
#include "batch/file_pattern.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <system_error>
#include <utility>

#include "formats/images/image_stack.h"
#include "formats/input_files.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kAnyFolders = "**";
constexpr std::string_view kTemporary = ".deltasplat.";

struct Character {
    std::uint32_t code;
    std::size_t bytes;
};

// A byte that begins no character of UTF-8 is one by itself, unlike all others.
Character characterAt(std::string_view text, std::size_t at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t bytes = first < 0x80   ? 1
                              : first < 0xc2 ? 0
                              : first < 0xe0 ? 2
                              : first < 0xf0 ? 3
                              : first < 0xf5 ? 4
                                             : 0;
    const Character odd{0x110000U + first, 1};
    if (bytes == 0 || at + bytes > text.size()) return odd;
    if (bytes == 1) return {first, 1};
    std::uint32_t code = first & (0xffU >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) {
        const auto next = static_cast<unsigned char>(text[at + i]);
        if ((next & 0xc0U) != 0x80) return odd;
        code = code << 6 | (next & 0x3fU);
    }
    return {code, bytes};
}

// Where a class that begins at `[` ends, behind its `]`; 0 if it does not. A `]` that comes first
// is one of its characters.
std::size_t classEnd(std::string_view pattern, std::size_t begin) {
    std::size_t at = begin + 1;
    if (at < pattern.size() && (pattern[at] == '!' || pattern[at] == '^')) ++at;
    const std::size_t end = pattern.find(']', at + 1);
    return end == std::string_view::npos ? 0 : end + 1;
}

bool isInClass(std::uint32_t code, std::string_view inner) {
    const bool isTurned = inner[0] == '!' || inner[0] == '^';
    bool isFound = false;
    for (std::size_t at = isTurned ? 1 : 0; at < inner.size();) {
        const Character low = characterAt(inner, at);
        at += low.bytes;
        std::uint32_t high = low.code;
        if (at + 1 < inner.size() && inner[at] == '-') {
            const Character last = characterAt(inner, at + 1);
            high = last.code;
            at += 1 + last.bytes;
        }
        isFound = isFound || (low.code <= code && code <= high);
    }
    return isFound != isTurned;
}

// What a pattern asks of one character, at a place that is no `*`.
struct Place {
    std::size_t length;  // in the pattern
    bool fits;
};

Place placeAt(std::string_view pattern, std::size_t at, std::uint32_t code) {
    if (pattern[at] == '?') return {1, true};
    if (pattern[at] == '[') {
        const std::size_t end = classEnd(pattern, at);
        if (end != 0) return {end - at, isInClass(code, pattern.substr(at + 1, end - at - 2))};
    }
    const std::size_t skipped = pattern[at] == '\\' && at + 1 < pattern.size() ? 1 : 0;
    const Character wanted = characterAt(pattern, at + skipped);
    return {skipped + wanted.bytes, wanted.code == code};
}

bool hasWildcards(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\') {
            ++i;
        } else if (text[i] == '*' || text[i] == '?' || (text[i] == '[' && classEnd(text, i) != 0)) {
            return true;
        }
    }
    return false;
}

// Whether a name with wildcards is that of a file or folder which is there.
bool isNamed(const fs::path& folder, const std::string& name) {
    std::error_code ignored;
    return name != kAnyFolders && fs::exists(folder / name, ignored);
}

// The names between slashes, the last one empty if the pattern ends with one.
std::vector<std::string> partsOf(const std::string& pattern) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = pattern.find('/', begin);
        const std::string part = pattern.substr(begin, end - begin);
        const bool isLast = end == std::string::npos;
        const bool isAgain = part == kAnyFolders && !parts.empty() && parts.back() == kAnyFolders;
        if (!isAgain && (isLast || !part.empty() || parts.empty())) parts.push_back(part);
        if (isLast) return parts;
        begin = end + 1;
    }
}

bool comesBefore(const fs::path& a, const fs::path& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), namedBefore);
}

class Search {
  public:
    Search(const fs::path& pattern, const Listener& listener)
        : listener_(listener), parts_(partsOf(pattern.string())) {
        if (parts_.size() > 1 && parts_.back().empty()) {
            findsFolders_ = true;
            parts_.pop_back();
        }
        // What ends with any folders finds all that is in them.
        if (parts_.back() == kAnyFolders) parts_.emplace_back("*");
    }

    FoundFiles run() {
        fs::path folder = parts_[0].empty() ? "/" : "";
        std::size_t part = parts_[0].empty() ? 1 : 0;
        while (part + 1 < parts_.size() && !isWild(folder, parts_[part]))
            folder /= plain(folder, parts_[part++]);
        look(folder, {}, part);
        FoundFiles result;
        result.base = folder;
        for (const auto& [file, within] : files_) result.files.push_back({file, within});
        std::sort(
            result.files.begin(), result.files.end(),
            [](const FoundFile& a, const FoundFile& b) { return comesBefore(a.file, b.file); });
        result.unread.assign(unread_.begin(), unread_.end());
        return result;
    }

  private:
    using Entries = std::vector<fs::directory_entry>;

    // What is there by the very name is meant.
    static bool isWild(const fs::path& folder, const std::string& wanted) {
        return hasWildcards(wanted) && !isNamed(folder, wanted);
    }
    static std::string plain(const fs::path& folder, const std::string& wanted) {
        return hasSigns(wanted) && isNamed(folder, wanted) ? wanted : withoutEscapes(wanted);
    }

    // Finds what fits the parts from this one on.
    // @param within  the folder, relative to that before the first wildcard
    void look(const fs::path& folder, const fs::path& within, std::size_t part) {
        listener_.report(0);
        const std::string& wanted = parts_[part];
        const bool isLast = part + 1 == parts_.size();
        if (wanted == kAnyFolders) {
            look(folder, within, part + 1);
            for (const fs::directory_entry& entry : entriesOf(folder)) {
                std::error_code ignored;
                const fs::path name = entry.path().filename();
                const bool isOther = name.string().starts_with('.') || entry.is_symlink(ignored);
                if (!isOther && entry.is_directory(ignored))
                    look(folder / name, within / name, part);
            }
        } else if (!isWild(folder, wanted)) {
            const std::string name = plain(folder, wanted);
            if (isLast)
                takeNamed(folder, name, within);
            else
                look(folder / name, within / name, part + 1);
        } else {
            for (const fs::directory_entry& entry : entriesOf(folder)) {
                std::error_code ignored;
                const fs::path name = entry.path().filename();
                if (!fits(name.string(), wanted)) continue;
                if (isLast)
                    take(entry, folder / name, within);
                else if (entry.is_directory(ignored))
                    look(folder / name, within / name, part + 1);
            }
        }
    }

    static bool fits(const std::string& name, const std::string& wanted) {
        const bool isHidden = name.starts_with('.') && !wanted.starts_with('.');
        return !isHidden && !name.starts_with(kTemporary) && fitsPattern(name, wanted);
    }

    void takeNamed(const fs::path& folder, const fs::path& name, const fs::path& within) {
        fs::directory_entry entry;
        std::error_code error;
        entry.assign(folder / name, error);
        noteUnread(folder, error);
        if (!error) take(entry, folder / name, within);
    }

    // A link that leads nowhere is a file that cannot be read, which has to be said.
    void take(const fs::directory_entry& entry, const fs::path& name, const fs::path& within) {
        std::error_code error;
        const fs::file_status status = entry.status(error);
        if (!fs::is_symlink(entry.symlink_status(error)) && !fs::exists(status)) return;
        const bool isFile = fs::is_regular_file(status) || !fs::exists(status);
        if (findsFolders_ ? fs::is_directory(status) : isFile) files_.emplace(name, within);
    }

    Entries entriesOf(const fs::path& folder) {
        Entries entries;
        std::error_code error;
        fs::directory_iterator next(folder.empty() ? "." : folder, error);
        for (; !error && next != fs::directory_iterator(); next.increment(error))
            entries.push_back(*next);
        noteUnread(folder, error);
        return entries;
    }

    // What is not there holds nothing.
    void noteUnread(const fs::path& folder, const std::error_code& error) {
        const bool isAbsent =
            error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory;
        if (error && !isAbsent) unread_.emplace(folder.empty() ? "." : folder, error.message());
    }

    const Listener& listener_;
    std::vector<std::string> parts_;
    bool findsFolders_ = false;
    std::map<fs::path, fs::path> files_;
    std::map<fs::path, std::string> unread_;
};

}  // namespace

bool isPattern(const fs::path& name) {
    std::error_code ignored;
    if (!hasWildcards(name.string()) || fs::exists(fs::symlink_status(name, ignored))) return false;
    const std::vector<NamePart> parts = partsOfName(name.string());
    return std::any_of(parts.begin(), parts.end(), [](const NamePart& part) {
        return !part.isLiteral && hasWildcards(part.text);
    });
}

bool fitsPattern(std::string_view name, std::string_view pattern) {
    std::size_t at = 0, in = 0;
    // Where the last `*` stands, and up to where it has taken the name.
    std::size_t star = std::string_view::npos, taken = 0;
    while (at < name.size()) {
        if (in < pattern.size() && pattern[in] == '*') {
            star = in++;
            taken = at;
            continue;
        }
        const Character next = characterAt(name, at);
        const Place place = in < pattern.size() ? placeAt(pattern, in, next.code) : Place{0, false};
        if (place.fits) {
            in += place.length;
            at += next.bytes;
        } else if (star != std::string_view::npos) {
            in = star + 1;
            taken += characterAt(name, taken).bytes;
            at = taken;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', in) == std::string_view::npos;
}

FoundFiles findFiles(const fs::path& pattern, const Listener& listener) {
    return Search(pattern, listener).run();
}

}  // namespace deltasplat
