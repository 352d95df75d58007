// SPDX-License-Identifier: Apache-2.0
#include "words/joined_classes.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <vector>

#include "base/portable_math.h"

namespace deltasplat {

namespace {

// Then nothing tells voxels apart but how much light they absorb.
bool areSummed(const ClassTable& classes) {
    return classes.oneColor || classes.looks.size() == 1;
}

// The look that is this over a step of the classes.
Look lookOf(const glm::dvec4& light, const ClassTable& classes) {
    const double unitDistances =
        classes.extinctionScale * (classes.stepWorld / classes.unitDistanceWorld);
    const double extinction = light.a < 1 ? -portable::log1p(-light.a) / unitDistances
                                          : std::numeric_limits<double>::infinity();
    return {light.a > 0 ? extinction : 0, glm::dvec3(light)};
}

}  // namespace

std::vector<glm::dvec4> lightsOf(const ClassTable& classes) {
    std::vector<glm::dvec4> lights;
    const std::vector<double> alphas = classes.alphas();
    const double colored = areSummed(classes) ? 0 : 1;
    for (std::size_t i = 0; i < alphas.size(); ++i)
        lights.emplace_back(colored * alphas[i] * classes.looks[i].color, alphas[i]);
    return lights;
}

bool canBePaired(const ClassTable& classes) {
    return areSummed(classes) || classes.size() * classes.size() <= ClassTable::kMaxClasses;
}

SliceJoiner joinerOf(const ClassTable& classes, const JoinedRun& run) {
    if (areSummed(classes) && run.within == 1) {
        std::vector<double> extinctions;
        for (const Look& look : classes.looks) extinctions.push_back(look.extinction);
        return SliceJoiner::ofSums(extinctions, run.slices);
    }
    if (run.slices == 2 && canBePaired(classes)) return SliceJoiner::ofPairs(classes.size());
    return SliceJoiner::ofLooks(lightsOf(classes.atSteps(run.steps)),
                                {.slices = run.slices,
                                 .lastInFront = run.seenThrough == SeenThrough::kFirst,
                                 .within = run.within});
}

ClassTable joinedClasses(const ClassTable& classes, const SliceJoiner& joiner,
                         const JoinedRun& run) {
    ClassTable joined = classes;
    if (joiner.looks()) {
        joined = classes.atSteps(run.steps);
        joined.looks.clear();
        for (const glm::dvec4& light : joiner.looks()->looks()) {
            joined.looks.push_back(lookOf(light, joined));
            if (areSummed(classes)) joined.looks.back().color = classes.looks.back().color;
        }
        return joined.atSteps(1);
    }
    if (areSummed(classes)) {
        joined.looks.clear();
        for (const double extinction : joiner.levels())
            joined.looks.push_back({extinction, classes.looks.back().color});
    } else {
        joined.pairs = run.seenThrough;
    }
    return joined.atSteps(run.steps);
}

}  // namespace deltasplat
