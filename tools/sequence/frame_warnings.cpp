// SPDX-License-Identifier: Apache-2.0
#include "sequence/frame_warnings.h"

#include <algorithm>
#include <cctype>

namespace deltasplat {
namespace {

bool isOfWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// Without 3, -0.5 and 1e-05, but with what belongs to a name.
std::string withoutNumbers(const std::string& text) {
    std::string rest;
    for (std::size_t i = 0; i < text.size();) {
        const bool begins = std::isdigit(static_cast<unsigned char>(text[i])) != 0 &&
                            (i == 0 || !isOfWord(text[i - 1]));
        if (!begins) {
            rest += text[i++];
            continue;
        }
        if (!rest.empty() && rest.back() == '-') rest.pop_back();
        while (i < text.size() && (isOfWord(text[i]) || text[i] == '.' ||
                                   ((text[i] == '-' || text[i] == '+') && text[i - 1] == 'e')))
            ++i;
    }
    return rest;
}

// Words of one thing and of several are the same: "value is" and "values are".
std::string withoutPlurals(const std::string& text) {
    std::string rest, word;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        if (i < text.size() && isOfWord(text[i])) {
            word += text[i];
            continue;
        }
        if (word == "are") word = "is";
        if (word.ends_with('s')) word.pop_back();
        rest += word;
        word.clear();
        if (i < text.size()) rest += text[i];
    }
    return rest;
}

}  // namespace

std::string frameLine(const FrameFiles& files, const std::string& what) {
    if (files.name.empty()) return "frame " + std::to_string(files.frame) + ": " + what;
    // What went wrong may begin with the name, or that of the file, and perhaps a line in it.
    const std::string input = files.input.string();
    if (!input.empty() && what.starts_with(input + ":"))
        return files.name + what.substr(input.size());
    return what.starts_with(files.name + ":") ? what : files.name + ": " + what;
}

void FrameWarnings::warn(std::size_t i, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (i == next_) {
        show(i, text);
    } else {
        waiting_[i].push_back(text);
    }
}

void FrameWarnings::finish(std::size_t i) {
    const std::lock_guard lock(mutex_);
    finished_.insert(i);
    while (finished_.erase(next_) > 0) {
        ++next_;
        const auto waiting = waiting_.find(next_);
        if (waiting == waiting_.end()) continue;
        for (const std::string& text : waiting->second) show(next_, text);
        waiting_.erase(waiting);
    }
}

void FrameWarnings::show(std::size_t i, const std::string& text) {
    const FrameFiles& files = frames_[i];
    std::string about = text;
    std::string kind;  // what is said of the one file is not what is said of the other
    // A name may end as the other does.
    const std::string names[] = {files.input.string(), files.output.string()};
    const bool isOutputFirst = names[0].size() < names[1].size();
    for (const bool isOutput : {isOutputFirst, !isOutputFirst}) {
        const std::string& file = names[isOutput];
        const std::size_t at = file.empty() ? std::string::npos : about.find(file);
        if (at == std::string::npos) continue;
        about.erase(at, file.size());
        if (isOutput) kind = '\n';
    }
    kind += withoutPlurals(withoutNumbers(about));
    // The first one of its kind is shown.
    const auto [known, isNew] = warnings_.emplace(kind, Warning{i, about, false, false, {}});
    Warning& warning = known->second;
    warning.isOfFrames = warning.isOfFrames || about != text;
    if (isNew) return listener_.warn(frameLine(files, text));
    // All that differs in one frame is shown.
    if (i == warning.first && about != warning.text) listener_.warn(frameLine(files, text));
    if (i == warning.first) return;
    warning.hasOtherNumbers = warning.hasOtherNumbers || about != warning.text;
    warning.others.insert(i);
}

void FrameWarnings::count() const {
    for (const auto& [kind, warning] : warnings_) {
        const std::size_t count = warning.others.size();
        // What is the same of all frames of a sequence need not be counted.
        const bool isOfAll = !warning.isOfFrames && !warning.hasOtherNumbers;
        if (count == 0 || (isOfAll && frames_[0].name.empty())) continue;
        listener_.warn(std::to_string(count) + " other" + word(count) +
                       (warning.hasOtherNumbers ? ", in other numbers: " : ": ") +
                       warning.text.substr(
                           std::min(warning.text.find_first_not_of(": "), warning.text.size())));
    }
}

std::string FrameWarnings::word(std::size_t count) const {
    return std::string(frames_[0].name.empty() ? " frame" : " picture") + (count > 1 ? "s" : "");
}

}  // namespace deltasplat
