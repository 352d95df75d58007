// SPDX-License-Identifier: Apache-2.0
#include "optics/joined_classes.h"

#include <stdexcept>
#include <vector>

namespace deltasplat {

namespace {

// Then nothing tells voxels apart but how much light they absorb.
bool areSummed(const ClassTable& classes) {
    return classes.oneColor || classes.looks.size() == 1;
}

}  // namespace

bool canBeJoined(const ClassTable& classes) {
    return areSummed(classes) || classes.size() * classes.size() <= ClassTable::kMaxClasses;
}

SliceJoiner joinerOf(const ClassTable& classes) {
    if (!canBeJoined(classes)) throw std::logic_error("slices joined without numbers");
    if (!areSummed(classes)) return SliceJoiner::ofPairs(classes.size());
    std::vector<double> extinctions;
    for (const Look& look : classes.looks) extinctions.push_back(look.extinction);
    return SliceJoiner::ofSums(extinctions);
}

ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         SeenThrough seenThrough, double steps) {
    ClassTable joined = classes;
    if (areSummed(classes)) {
        joined.looks.clear();
        for (const double extinction : joiner.levels())
            joined.looks.push_back({extinction, classes.looks.back().color});
    } else {
        joined.pairs = seenThrough;
    }
    return joined.atSteps(steps);
}

}  // namespace deltasplat
