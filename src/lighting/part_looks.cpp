// SPDX-License-Identifier: Apache-2.0
#include "lighting/part_looks.h"

#include <algorithm>
#include <glm/common.hpp>
#include <memory>

#include "base/affine.h"
#include "deltasplat/ingest/slot.h"
#include "deltasplat/optics/class_table.h"
#include "optics/blackbody.h"
#include "optics/class_numbers.h"
#include "optics/color_curve.h"
#include "volume/code_tree.h"

namespace deltasplat {

Volume withRoom(const Volume& volume, const BlockSet& more) {
    Volume wide = volume;
    if (more.positions.empty()) return wide;
    if (!wide.codes) wide.codes = std::make_shared<const CodeTree>();
    if (volume.empty()) wide.activeCount = 1;
    wide.box = volume.empty() ? more.box : boxOfBoth(volume.box, more.box);
    return wide;
}

namespace {

constexpr std::size_t kMostLooks = 65536;

// Gives the looks of all values that there are, in increasing order, numbers.
template <typename LookOf>
PartLooks numbered(const Volume& levels, const LookOf& lookOf) {
    PartLooks result{{PartLook{}}, std::vector<std::uint16_t>(kSlotCount)};
    for (std::size_t code = 0; code < levels.histogram.size(); ++code) {
        if (levels.histogram[code] == 0) continue;
        const PartLook look = lookOf(levels.codeBook.valueOf(Code(code)));
        if (look == PartLook{}) continue;
        const bool isNew = result.looks.size() == 1 || !(look == result.looks.back());
        // Where all values look different, the last two look alike.
        if (isNew && result.looks.size() < kMostLooks) result.looks.push_back(look);
        result.ofSlot[code + 1] = std::uint16_t(result.looks.size() - 1);
    }
    return result;
}

// Of the grid, not of its levels.
glm::dvec2 rangeOf(const MediumPart& part) {
    return part.range.value_or(defaultRange(*part.volume));
}

PartLooks lookUpAbsorption(const MediumPart& part, const Volume& levels) {
    Optics optics;
    optics.transferFunction = part.transferFunction;
    optics.range = rangeOf(part);
    optics.unitDistance = 1;
    optics.extinctionScale = part.strength;
    const ClassTable classes = classify(levels, optics, 1);
    PartLooks result;
    result.ofSlot.assign(classes.slots->begin(), classes.slots->end());
    for (const Look& look : classes.looks)
        result.looks.push_back({look.extinction * part.strength, look.color, {}});
    return result;
}

}  // namespace

PartLook PartLooks::largest() const {
    PartLook most;
    for (const PartLook& look : looks) {
        most.extinction = std::max(most.extinction, look.extinction);
        most.color = glm::max(most.color, look.color);
        most.glow = glm::max(most.glow, look.glow);
    }
    return most;
}

PartLooks lookUpPart(const MediumPart& part, const Volume& levels, double unitDistances) {
    if (part.kind == MediumPart::Kind::kAbsorption) return lookUpAbsorption(part, levels);
    const double least = kLeastGlow / std::max(unitDistances, 1.0);
    const auto seen = [&](const glm::dvec3& glow) {
        const bool isSeen = std::max({glow.x, glow.y, glow.z}) >= least;
        return PartLook{0, {}, isSeen ? glow : glm::dvec3(0)};
    };
    if (part.kind == MediumPart::Kind::kBlackbody) {
        return numbered(levels, [&](double value) {
            const double kelvin = part.kelvinScale * value + part.kelvinOffset;
            return seen(part.strength * blackbodyGlow(std::min(kelvin, kHottestKelvin)));
        });
    }
    const TransferFunction& function = part.transferFunction;
    const ColorCurve colors(function);
    const FunctionPlace placeOf(function, *part.volume, part.range);
    return numbered(levels, [&](double value) {
        const double x = placeOf(value);
        return seen(part.strength * function.opacityAt(x) * colors.at(x));
    });
}

}  // namespace deltasplat
