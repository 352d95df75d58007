// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/simd.h"

#include <algorithm>
#include <cctype>

#include "deltasplat/error.h"
// Before Highway.
#include "base/simd_targets.h"

#include "hwy/highway.h"

namespace deltasplat {
namespace {

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

// The levels that the kernels are compiled for and the machine has, best first (lowest bit first).
std::vector<std::int64_t> usableTargets() {
    hwy::SetSupportedTargetsForTest(0);
    std::vector<std::int64_t> targets;
    for (std::int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
        targets.push_back(rest & -rest);
    }
    return targets;
}

// 0 = the best level.
std::int64_t& chosenTarget() {
    static std::int64_t target = 0;
    return target;
}

}  // namespace

std::vector<std::string> simdLevels() {
    std::vector<std::string> names;
    for (const std::int64_t target : usableTargets()) names.emplace_back(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(chosenTarget());
    return names;
}

std::string simdLevel() {
    return chosenTarget() == 0 ? simdLevels().front() : hwy::TargetName(chosenTarget());
}

void setSimdLevel(const std::string& name) {
    std::int64_t wanted = 0;
    std::string known = "auto";
    for (const std::int64_t target : usableTargets()) {
        known += std::string(", ") + hwy::TargetName(target);
        if (upper(hwy::TargetName(target)) == upper(name)) wanted = target;
    }
    if (wanted == 0 && upper(name) != "AUTO") {
        hwy::SetSupportedTargetsForTest(chosenTarget());
        throw Error(ErrorCode::kUsage, "SIMD level", name, "one of " + known);
    }
    chosenTarget() = wanted;
    hwy::SetSupportedTargetsForTest(wanted);
    hwy::GetChosenTarget().DeInit();
}

}  // namespace deltasplat
