// SPDX-License-Identifier: Apache-2.0
#include "optics/label_changes.h"

#include <functional>
#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "optics/label_function.h"

namespace deltasplat {
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

void warnOfMissing(const LabelChanges& changes, const std::function<bool(int)>& isThere,
                   const std::string& where, const Listener& listener) {
    for (const NamedLabels& named : namedLabels(changes)) {
        std::string missing;
        for (const int label : named.labels) {
            if (isThere(label)) continue;
            if (!missing.empty()) missing += ", ";
            missing += std::to_string(label);
        }
        if (missing.empty()) continue;
        missing += " in " + where;
        listener.warn(std::string(named.name) + ": no label " + missing);
    }
}

}  // namespace

TransferFunction changeLabels(const TransferFunction& function, const LabelChanges& changes,
                              const Listener& listener) {
    if (changes.empty()) return function;
    if (!function.categorical) {
        throw Error(ErrorCode::kUsage,
                    gotExpected(namedLabels(changes).front().name, "a transfer function of values",
                                "a table of labels"));
    }
    std::vector<LabelLook> looks = looksOf(function);
    std::set<int> known;
    for (LabelLook& look : looks) {
        known.insert(look.label);
        const auto opacity = changes.opacities.find(look.label);
        if (opacity != changes.opacities.end()) look.opacity = opacity->second;
        const bool isShown = changes.shown.empty() || changes.shown.contains(look.label);
        if (!isShown || changes.hidden.contains(look.label)) look.opacity = 0;
    }
    warnOfMissing(
        changes, [&](int label) { return known.contains(label); }, "the table", listener);
    TransferFunction changed = labelFunction(looks);
    changed.name = function.name;
    return changed;
}

void warnOfAbsentLabels(const LabelChanges& changes, const Volume& volume,
                        const Listener& listener) {
    const auto isThere = [&](int label) {
        const Code code = volume.codeBook.codeOf(label);
        return volume.codeBook.valueOf(code) == label && volume.histogram[code] > 0;
    };
    warnOfMissing(changes, isThere, "the volume", listener);
}

}  // namespace deltasplat
