// SPDX-License-Identifier: Apache-2.0
#include "optics/label_function.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {

std::optional<double> anyBroken(const Volume& volume) {
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] == 0) continue;
        const double value = volume.codeBook.valueOf(Code(code));
        if (value != std::floor(value)) return value;
    }
    return {};
}

bool holdsLabels(const Volume& volume) {
    return volume.labels && !anyBroken(volume);
}

TransferFunction labelFunction(const std::vector<LabelLook>& looks) {
    TransferFunction function;
    function.categorical = true;
    // Of several points at the same place the last one counts.
    function.opacities = {{looks.front().label - 0.5, 0, 0.5, 0}};
    for (const LabelLook& look : looks) {
        const double begin = look.label - 0.5;
        const double end = look.label + 0.5;
        for (const double x : {begin, end}) function.colors.push_back({x, look.rgb});
        auto& opacities = function.opacities;
        const std::size_t last = opacities.size() - 1;
        if (last > 0 && opacities[last].x == begin && opacities[last - 1].opacity == look.opacity) {
            // As opaque as the label before: no step between them.
            opacities.resize(last - 1);
        } else {
            if (opacities.back().x < begin) opacities.push_back({begin, 0, 0.5, 0});
            opacities.push_back({begin, look.opacity, 0.5, 0});
        }
        opacities.push_back({end, look.opacity, 0.5, 0});
        opacities.push_back({end, 0, 0.5, 0});
    }
    return function;
}

TransferFunction withColors(const TransferFunction& function, const LabelList& labels) {
    TransferFunction colored = function;
    for (const LabelEntry& label : labels.entries) {
        if (!label.rgb) continue;
        // Each label has a colour at either end.
        const auto begin = std::ranges::lower_bound(colored.colors, double(label.value) - 0.5, {},
                                                    &TransferFunction::ColorPoint::x);
        if (std::distance(begin, colored.colors.end()) < 2 || begin->x != double(label.value) - 0.5)
            continue;
        // The end of the label before lies at the same place.
        const auto own = begin[1].x == begin->x ? begin + 1 : begin;
        if (std::distance(colored.colors.begin(), own) % 2 != 0) continue;
        own[0].rgb = own[1].rgb = *label.rgb;
    }
    return colored;
}

std::vector<LabelLook> looksOf(const TransferFunction& function) {
    std::vector<LabelLook> looks;
    // Each label has a colour at either end.
    for (std::size_t i = 0; i + 1 < function.colors.size(); i += 2) {
        const double label = 0.5 * (function.colors[i].x + function.colors[i + 1].x);
        looks.push_back({int(label), function.colors[i].rgb, function.opacityAt(label)});
    }
    return looks;
}

namespace {

// The labels of one kind of change, and what that is called.
struct NamedLabels {
    const char* name;
    std::set<int> labels;
};

std::vector<NamedLabels> namedLabels(const LabelChanges& changes) {
    std::vector<NamedLabels> all = {{"`labels.hidden`", changes.hidden},
                                    {"`labels.shown`", changes.shown},
                                    {"`labels.opacities`", {}}};
    for (const auto& [label, opacity] : changes.opacities) all[2].labels.insert(label);
    std::erase_if(all, [](const NamedLabels& one) { return one.labels.empty(); });
    return all;
}

std::string listOf(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : ", ") + numberText(number);
    return text;
}

std::set<int> labelsOf(const TransferFunction& table) {
    std::set<int> labels;
    for (const LabelLook& look : looksOf(table)) labels.insert(look.label);
    return labels;
}

bool isThere(double label, const Volume& volume) {
    const Code code = volume.codeBook.codeOf(label);
    return volume.codeBook.valueOf(code) == label && volume.histogram[code] > 0;
}

bool isClear(int label, const LabelChanges& changes) {
    const bool isShown = changes.shown.empty() || changes.shown.contains(label);
    return !isShown || changes.hidden.contains(label);
}

}  // namespace

TransferFunction changeLabels(const TransferFunction& function, const LabelChanges& changes) {
    if (changes.empty()) return function;
    if (!function.categorical) {
        throw Error(ErrorCode::kUsage, namedLabels(changes).front().name,
                    "a transfer function of values", "a table of labels");
    }
    std::vector<LabelLook> looks = looksOf(function);
    for (LabelLook& look : looks) {
        const auto opacity = changes.opacities.find(look.label);
        if (opacity != changes.opacities.end()) look.opacity = opacity->second;
        if (isClear(look.label, changes)) look.opacity = 0;
    }
    TransferFunction changed = labelFunction(looks);
    changed.name = function.name;
    return changed;
}

void warnOfAbsentLabels(const LabelChanges& changes, const TransferFunction& table,
                        const Volume& volume, const Listener& listener) {
    if (changes.empty()) return;
    const std::set<int> known = labelsOf(table);
    for (const NamedLabels& named : namedLabels(changes)) {
        std::vector<double> absent[3];
        for (const int label : named.labels) {
            const bool isKnown = known.contains(label);
            const bool isUsed = isThere(label, volume);
            if (!isKnown || !isUsed) absent[isUsed ? 0 : isKnown ? 1 : 2].push_back(label);
        }
        const char* places[] = {"the table", "the volume", "the table or the volume"};
        for (int i = 0; i < 3; ++i) {
            if (absent[i].empty()) continue;
            listener.warn(std::string(named.name) + ": no label " + listOf(absent[i]) + " in " +
                          places[i]);
        }
    }
}

void warnOfUnlistedLabels(const LabelChanges& changes, const TransferFunction& table,
                          const Volume& volume, const Listener& listener) {
    const std::set<int> known = labelsOf(table);
    std::set<double> unlisted;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] == 0) continue;
        const double value = volume.codeBook.valueOf(Code(code));
        // Labels have what is half way to their neighbours, as far as labels go.
        const bool isFar = std::abs(value) > 1e9;
        const int label = isFar ? 0 : int(std::floor(value + 0.5));
        if (value == 0 || known.contains(label)) continue;
        if (isFar || !isClear(label, changes)) unlisted.insert(value);
    }
    if (unlisted.empty()) return;
    constexpr std::size_t kMost = 5;
    const bool areMany = unlisted.size() > kMost + 1;
    auto end = unlisted.begin();
    std::advance(end, areMany ? kMost : unlisted.size());
    const bool isOne = unlisted.size() == 1;
    std::string text = listOf({unlisted.begin(), end});
    if (areMany) text += " and " + std::to_string(unlisted.size() - kMost) + " more";
    listener.warn(std::string("`transferFunction`: ") + (isOne ? "label " : "labels ") + text +
                  " of the volume " + (isOne ? "is" : "are") + " not in the table, and not shown");
}

}  // namespace deltasplat
