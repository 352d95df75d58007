// SPDX-License-Identifier: Apache-2.0
#include "formats/input_kind.h"

#include <algorithm>
#include <optional>
#include <set>
#include <system_error>

#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/dicom/dicom_sniff.h"
#include "formats/format.h"
#include "formats/images/image_stack.h"

namespace deltasplat {
namespace {

using Files = std::vector<std::filesystem::path>;

// Returns the visible files, sorted by name. Refuses entries that are neither files nor folders,
// because they may stand for missing slices.
Files filesIn(const std::filesystem::path& folder) {
    Files files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        std::error_code ignored;
        const std::string name = entry.path().filename().string();
        if (name[0] == '.' || entry.is_directory(ignored)) continue;
        requireRegularFile(entry.path());
        files.push_back(entry.path());
    }
    if (error) refuseFile(folder, "a folder that cannot be read", "a readable folder");
    sortByNumbers(files);
    return files;
}

void warnOfOthers(const std::filesystem::path& folder, const Files& all, const Files& taken,
                  const std::string& what, const Listener& listener) {
    if (all.size() == taken.size()) return;
    // Both lists have the same order.
    const auto other = std::mismatch(all.begin(), all.end(), taken.begin(), taken.end()).first;
    const std::string one = what == "images" ? "image" : what;
    listener.warn(folder.string() + ": " +
                  countText(all.size() - taken.size(),
                            "file that is no " + one + " is passed over,",
                            "files that are no " + what + " are passed over, the first") +
                  " " + printable(other->filename().string()));
}

template <typename Test>
Files filesThat(const Files& files, const Test& test) {
    Files taken;
    std::copy_if(files.begin(), files.end(), std::back_inserter(taken), test);
    return taken;
}

// Returns the extension if it has a letter; a bare number only counts slices.
std::string kindExtension(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    const bool word = std::any_of(extension.begin(), extension.end(),
                                  [](char c) { return c >= 'a' && c <= 'z'; });
    return word ? extension : "";
}

// Slice names may be numbers with dots.
std::string nameOfSlice(const std::filesystem::path& file) {
    return kindExtension(file).empty() ? file.filename().string() : nameWithoutExtensions(file);
}

bool isNamedAsContents(const std::filesystem::path& file) {
    return lowerCase(file.filename().string()) == "dicomdir";
}

// Tables of contents are DICOM files too.
bool isContents(const std::filesystem::path& file) {
    if (isNamedAsContents(file)) return true;
    const std::optional<DicomStart> start = dicomStart(file);
    return start && start->isContents;
}

// Refuses non-DICOM files named like slices: without them the volume looks right but is wrong.
void requireNoCutSlice(const std::filesystem::path& folder, const Files& all, const Files& dicom) {
    std::set<std::string> names;
    std::set<std::string> extensions{".dcm"};
    for (const std::filesystem::path& file : dicom) {
        names.insert(withoutNumbers(file.filename().string()));
        extensions.insert(kindExtension(file));
    }
    extensions.erase("");
    Files others;
    std::set_difference(all.begin(), all.end(), dicom.begin(), dicom.end(),
                        std::back_inserter(others), namedBefore);
    for (const std::filesystem::path& file : others) {
        const bool alike = names.contains(withoutNumbers(file.filename().string())) ||
                           extensions.contains(kindExtension(file));
        if (!alike || isContents(file)) continue;
        refuseFile(folder,
                   printable(file.filename().string()) +
                       ", which is named as its slices are but is no DICOM",
                   "whole slices");
    }
}

bool isSlice(const std::filesystem::path& file) {
    return !isNamedAsContents(file) && isDicom(file);
}

// Whether a folder holds slices, among other files.
bool holdsSlices(const std::filesystem::path& folder) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        std::error_code ignored;
        const bool isHidden = entry.path().filename().string()[0] == '.';
        if (isHidden || !entry.is_regular_file(ignored)) continue;
        try {
            if (isSlice(entry.path())) return true;
        } catch (const Error&) {
            // An unreadable file may be anything.
        }
    }
    return false;
}

// Returns the visible subfolders, sorted by name, without links.
Files foldersIn(const std::filesystem::path& folder) {
    Files folders;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        std::error_code ignored;
        const bool isHidden = entry.path().filename().string()[0] == '.';
        if (!isHidden && entry.is_directory(ignored) && !entry.is_symlink(ignored))
            folders.push_back(entry.path());
    }
    sortByNumbers(folders);
    return folders;
}

struct Study {
    Files all;
    Files dicom;
};

// Adds slices from subfolders, as in studies and on discs.
void addSlicesBelow(const std::filesystem::path& folder, int depth, Study& study) {
    constexpr int kMostDepth = 8;
    if (depth == kMostDepth) return;
    for (const std::filesystem::path& below : foldersIn(folder)) {
        if (holdsSlices(below)) {
            const Files all = filesIn(below);
            const Files dicom = filesThat(all, isSlice);
            requireNoCutSlice(below, all, dicom);
            study.all.insert(study.all.end(), all.begin(), all.end());
            study.dicom.insert(study.dicom.end(), dicom.begin(), dicom.end());
        }
        addSlicesBelow(below, depth + 1, study);
    }
}

// Whether there are several images whose names differ in numbers only, like slices.
bool areNamedAsStack(const Files& images) {
    return images.size() > 1 &&
           std::all_of(images.begin(), images.end(), [&](const std::filesystem::path& image) {
               return withoutNumbers(image.filename().string()) ==
                      withoutNumbers(images.front().filename().string());
           });
}

// Returns a folder's slices, plus those below if it has none or is a disc's. Ignores pictures
// beside them, unless the pictures are named as a stack and outnumber slices found only below.
std::optional<InputKind> findSlices(const std::filesystem::path& folder, const Files& all,
                                    const Listener& listener) {
    Study study{all, filesThat(all, isSlice)};
    const bool hasOwn = !study.dicom.empty();
    const bool isDisc = std::any_of(all.begin(), all.end(), isContents);
    if (hasOwn) requireNoCutSlice(folder, all, study.dicom);
    if (!hasOwn || isDisc) addSlicesBelow(folder, 0, study);
    if (study.dicom.empty()) return {};
    const Files images = filesThat(all, isImageName);
    const bool isStack = areNamedAsStack(images) && images.size() > study.dicom.size();
    if (isStack && !hasOwn && !isDisc) return {};
    warnOfOthers(folder, study.all, study.dicom, "DICOM", listener);
    return InputKind{&dicomFormat(), folderName(folder), study.dicom};
}

InputKind findInFolder(const std::filesystem::path& folder, const Listener& listener) {
    const Files all = filesIn(folder);
    if (std::optional<InputKind> slices = findSlices(folder, all, listener)) return *slices;
    const Files images = filesThat(all, isImageName);
    if (images.empty()) {
        const Files grids = filesThat(all, [](const auto& file) { return isVdbName(file); });
        const Files others =
            filesThat(all, [](const auto& file) { return formatOf(file) != nullptr; });
        std::string such;
        if (!grids.empty()) {
            such = " such as " + grids.front().string() + " (render takes '" +
                   (folder / "*.vdb").string() + "')";
        } else if (!others.empty()) {
            such = " such as " + others.front().string();
        }
        refuseFile(folder, "a folder without DICOM files and images",
                   "a DICOM folder, a folder of images, or a file" + such);
    }
    const std::string extension = lowerExtension(images.front());
    for (const std::filesystem::path& image : images) {
        if (lowerExtension(image) == extension) continue;
        refuseFile(folder,
                   "images of several kinds (" + extension + ", " + lowerExtension(image) + ")",
                   "a folder with the images of one stack");
    }
    requireNoHole(folder, images);
    warnOfOthers(folder, all, images, "images", listener);
    return {&imageFormat(), folderName(folder), images};
}

std::string nameOfPattern(const StackPattern& pattern) {
    const std::size_t end = pattern.before.find_last_not_of("._- ");
    return end == std::string::npos ? "stack" : pattern.before.substr(0, end + 1);
}

}  // namespace

bool isImageName(const std::filesystem::path& file) {
    return formatOf(file) == &imageFormat();
}

bool isTiffName(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    return extension == ".tif" || extension == ".tiff";
}

InputKind findInput(const std::filesystem::path& input, const Listener& listener) {
    std::error_code error;
    if (std::filesystem::is_directory(input, error)) return findInFolder(input, listener);
    const std::optional<StackPattern> pattern = stackPattern(input);
    if (pattern && isImageName(input) && !std::filesystem::exists(input, error)) {
        return {&imageFormat(), nameOfPattern(*pattern), stackFiles(input, *pattern)};
    }
    requireRegularFile(input);
    // A disc's table of contents means the whole disc.
    if (isNamedAsContents(input) && dicomStart(input))
        return findInFolder(input.has_parent_path() ? input.parent_path() : ".", listener);
    const std::string extension = lowerExtension(input);
    const Format* const format = formatOf(input);
    if ((!format || extension == ".img") && dicomStart(input))
        return {&dicomFormat(), nameOfSlice(input), {input}};
    if (!format) {
        refuseFile(input, "extension \"" + extension + "\"",
                   readableText() + (extension == ".usda"    ? " (render reads .usda)"
                                     : extension == ".slabs" ? " (fold reads .slabs)"
                                                             : ""));
    }
    return {format, nameWithoutExtensions(input), {input}};
}

}  // namespace deltasplat
