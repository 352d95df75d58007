// SPDX-License-Identifier: Apache-2.0
#include "ingest/delta/rice_steps.h"

#include <bit>
#include <cstddef>

#include "ingest/delta/bit_reader.h"
#include "ingest/delta/rice_code.h"

namespace deltasplat {
namespace {

// Of larger ones fewer than three numbers lie within a step.
constexpr int kParameters = 3;
using Steps = std::array<RiceStep, std::size_t{1} << RiceStep::kLookedAt>;

RiceStep stepOf(std::uint64_t bits, int parameter) {
    RiceStep step;
    int left = RiceStep::kLookedAt;
    while (step.count < RiceStep::kMostNumbers) {
        const int ones = std::countr_one(bits);
        const int length = ones + 1 + parameter;
        if (ones >= RiceCode::kMostOnes || length > left) break;
        const std::uint64_t remainder = bits >> (ones + 1) & BitReader::lowBits(parameter);
        step.numbers[step.count++] = std::uint8_t(std::uint64_t(ones) << parameter | remainder);
        bits >>= length;
        left -= length;
    }
    step.bits = std::uint16_t(RiceStep::kLookedAt - left);
    return step;
}

std::array<Steps, kParameters> allSteps() {
    std::array<Steps, kParameters> all;
    for (std::size_t parameter = 0; parameter < all.size(); ++parameter) {
        for (std::size_t bits = 0; bits < all[parameter].size(); ++bits)
            all[parameter][bits] = stepOf(bits, int(parameter));
    }
    return all;
}

}  // namespace

const RiceStep* riceSteps(int parameter) {
    static const std::array<Steps, kParameters> all = allSteps();
    return parameter < kParameters ? all[std::size_t(parameter)].data() : nullptr;
}

}  // namespace deltasplat
