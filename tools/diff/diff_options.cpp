// SPDX-License-Identifier: Apache-2.0
#include "diff/diff_options.h"

#include "base/text.h"
#include "options/input_options.h"

namespace deltasplat {

void addDiffOptions(CLI::App& app, DiffOptions& options) {
    OptionGroup arguments(app, "Arguments");
    arguments
        .addValue("A", "FILE", options.a, anyText(),
                  std::string("File to compare: ") + kInputFormats)
        .required();
    arguments
        .addValue("B", "FILE", options.b, anyText(),
                  "File to compare it with. Without --grid, two .vdb are\n"
                  "compared grid by grid, by name")
        .required();

    CompareOptions& compare = options.compare;
    DiffLimits& limits = options.limits;
    const Parser<double> threshold = number(0);
    OptionGroup group(app, "Thresholds (data units; also with one dash, as idiff's)");
    group.addValue("--fail", "A", compare.fail, threshold,
                   withDefault("Errors over A count as failures", numberText(compare.fail)));
    group.addValue("--failpercent", "B", limits.failPercent, number(0, 100),
                   withDefault("Up to B percent of the voxels may be failures",
                               numberText(limits.failPercent)));
    group.addValue("--hardfail", "C", limits.hardFail, threshold,
                   "Different if any error is over C (default: no limit)");
    group.addValue("--warn", "A", compare.warn, threshold,
                   withDefault("Errors over A count as warnings", numberText(compare.warn)));
    group.addValue("--warnpercent", "B", limits.warnPercent, number(0, 100),
                   withDefault("Up to B percent of the voxels may be warnings",
                               numberText(limits.warnPercent)));
    group.addValue("--hardwarn", "C", limits.hardWarn, threshold,
                   "Warning if any error is over C (default: no limit)");
    group.addValue("--shift", "V", compare.shift, threshold,
                   withDefault("Different if a voxel's place differs by more than V voxels, and\n"
                               "by more than the coarser of both formats can tell.\n"
                               "Transforms a whole number of voxels apart, as those of a .vdb\n"
                               "and of what it was converted to, agree: voxels at the same\n"
                               "place in the world are compared",
                               numberText(compare.shift)));
    group.addFlag("--ignore-active", limits.ignoreActive,
                  "Active states may differ (a dense volume has no inactive voxels)");
    group.addFlag("--ignore-missing", limits.ignoreMissing,
                  "Grids that are compared with nothing do not matter: those that\n"
                  "only one file has, vectors, points, and those with NaN (default:\n"
                  "they make files different, unless --grid asks for another one)");
    OptionGroup(app, "Output").addFlag("--json", options.json, "Print one JSON object");
    addFrameList(app, options.frames);
    addInputOptions(app, options.read);
}

}  // namespace deltasplat
