// SPDX-License-Identifier: Apache-2.0
#include "info/describe_volume.h"

#include <array>
#include <utility>
#include <vector>

#include "base/text.h"
#include "deltasplat/ingest/value_statistics.h"
#include "deltasplat/optics/class_table.h"
#include "info/slice_plot.h"

namespace deltasplat {
namespace {

// Which codes look alike in a view along an axis, and which cannot be seen.
std::vector<Slot> seenSlots(const GridReport& report, const DescribeOptions& options, int axis) {
    const Volume& volume = report.volume;
    if (options.transferFunction) {
        Optics optics;
        optics.transferFunction = *options.transferFunction;
        if (options.preset) fitPreset(*options.preset, volume, optics);
        return *classify(volume, optics, volume.voxelSize()[axis]).slots;
    }
    if (!report.backgroundGuess) return {};
    return slotsWithout(volume.codeBook(), *report.backgroundGuess);
}

std::string visibleText(const GridReport& report, const DescribeOptions& options) {
    if (options.transferFunction) return "not clear under " + options.transferFunctionFile;
    if (!report.backgroundGuess) return "all voxels";
    const std::string value = numberText(*report.backgroundGuess);
    return report.volume.hasBackground()
               ? "active voxels other than the background " + value
               : "voxels other than " + value + ", the guessed background";
}

}  // namespace

GridReport describeVolume(Volume volume, const DescribeOptions& options, bool plot) {
    GridReport report;
    report.backgroundGuess = guessBackground(volume);
    report.volume = std::move(volume);
    report.visible = visibleText(report, options);
    for (int axis = 0; axis < 3; ++axis) {
        report.counts[axis] = countDeltas(report.volume, axis);
        const std::vector<Slot> seen = seenSlots(report, options, axis);
        report.stamps[axis] = predictStamps(report.volume, axis, seen);
        if (!plot) continue;
        const int slices = report.volume.box().dims()[axis];
        report.columns[axis] =
            countDeltasPerSlice(report.volume, axis, seen, slicesPerColumn(slices));
    }
    // The codes are counted, and with the source the largest thing in memory.
    report.volume = report.volume.withoutVoxels();
    return report;
}

}  // namespace deltasplat
