// SPDX-License-Identifier: Apache-2.0
#include "options/volume_choices.h"

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/format.h"
#include "formats/input_kind.h"

namespace deltasplat {
namespace {

bool mayHoldSeveral(const std::filesystem::path& input) {
    const InputKind kind = findInput(input, {});
    const bool isTiff = kind.files.size() == 1 && isTiffName(kind.files.front());
    return isTiff || kind.is(niftiFormat()) || kind.is(npyFormat()) || kind.is(dicomFormat());
}

}  // namespace

std::vector<VolumeChoice> choicesIn(const std::filesystem::path& input,
                                    const ReadOptions& options) {
    if (!mayHoldSeveral(input)) return {{options, {}}};
    std::vector<VolumeChoice> choices;
    for (VolumeEntry& entry : listVolumes(input, options)) {
        VolumeChoice choice{options, std::move(entry)};
        choice.read.series = choice.entry.series;
        if (!options.volume) choice.read.volume = 0;
        choices.push_back(std::move(choice));
    }
    return choices;
}

std::string seriesText(const VolumeEntry& entry) {
    if (!entry.series) return "";
    return (entry.series->empty() ? "\"\"" : printable(*entry.series)) +
           (entry.description.empty() ? "" : ": " + entry.description);
}

bool hasSeveral(const std::filesystem::path& input, const ReadOptions& options) {
    ReadOptions all = options;
    all.volume.reset();
    all.series.reset();
    try {
        const std::vector<VolumeChoice> choices = choicesIn(input, all);
        return choices.size() > 1 || choices.front().entry.volumes > 1;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace deltasplat
