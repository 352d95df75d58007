// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/dense_layout.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "base/text.h"
#include "deltasplat/ingest/label_list.h"
#include "formats/vdb/grid_metadata.h"
#include "volume/length_unit.h"
#include "volume/placement.h"
#include "volume/tree_grid.h"

namespace deltasplat {

glm::dvec3 DenseLayout::spacing() const {
    glm::dvec3 lengths;
    for (int axis = 0; axis < 3; ++axis)
        lengths[axis] = glm::length(glm::dvec3(worldFromIndex[axis]));
    return lengths;
}

glm::dmat3 DenseLayout::directions() const {
    glm::dmat3 units;
    for (int axis = 0; axis < 3; ++axis) {
        units[axis] = glm::dvec3(worldFromIndex[axis]) / spacing()[axis];
    }
    return units;
}

bool DenseLayout::isOrthogonal() const {
    constexpr double kNearly = 1e-5;
    const glm::dmat3 units = directions();
    return std::abs(glm::dot(units[0], units[1])) < kNearly &&
           std::abs(glm::dot(units[1], units[2])) < kNearly &&
           std::abs(glm::dot(units[2], units[0])) < kNearly;
}

void DenseLayout::turnTo(const std::string& otherSpace) {
    if (space.empty() || space == otherSpace) return;
    for (int column = 0; column < 4; ++column) {
        // Adding 0 keeps -0, which is no other place, out of the files.
        worldFromIndex[column].x = -worldFromIndex[column].x + 0.0;
        worldFromIndex[column].y = -worldFromIndex[column].y + 0.0;
    }
    space = otherSpace;
}

void DenseLayout::noteLabels(const std::string& format, bool all, WriteNotes& notes) const {
    if (!labels || (!all && labels->entries.empty())) return;
    const std::string named = labels->entries.empty() ? "" : "names and colours of labels";
    const std::string said = all ? "that values are labels" : "";
    notes.loss(named + (named.empty() || said.empty() ? "" : ", and ") + said +
               (all && named.empty() ? " is left out: " : " are left out: ") + format +
               " has no place for " + (all && named.empty() ? "it" : "them") +
               " (.vdb and .seg.nrrd have)");
}

void DenseLayout::turnToMillimetres() {
    if (lengthUnit.empty() || lengthUnit == "mm") return;
    scaleLengths(worldFromIndex, millimetresIn(lengthUnit));
    lengthUnit = "mm";
}

namespace {

std::optional<RawType> typeNamed(const std::string& name) {
    for (int i = 0; i <= int(RawType::kInt64); ++i) {
        if (name == rawTypeName(RawType(i))) return RawType(i);
    }
    return {};
}

std::string sourceType(const Volume& volume) {
    return volume.source ? volume.source->grid.metadata.text(kSourceTypeKey) : "";
}

// Returns what OpenVDB's own types are called here.
std::string denseName(const std::string& type) {
    if (type == "float" || type == "half") return "float32";
    if (type == "double") return "float64";
    return type == "bool" || type == "mask" ? "uint8" : type;
}

RawType chooseType(const Volume& volume, const ValueFacts& facts, bool wide) {
    for (const std::string& name : {sourceType(volume), denseName(volume.type)}) {
        const std::optional<RawType> type = typeNamed(name);
        const bool known = wide || (type != RawType::kInt64 && type != RawType::kUint64);
        if (type && known && facts.fit(*type)) return *type;
    }
    if (volume.type == "int64" && facts.fit(RawType::kInt32)) return RawType::kInt32;
    return facts.fit(RawType::kFloat32) ? RawType::kFloat32 : RawType::kFloat64;
}

}  // namespace

RawType denseType(const Volume& volume, const ValueFacts& facts, bool wide, WriteNotes& notes) {
    const RawType type = chooseType(volume, facts, wide);
    const std::string name = rawTypeName(type);
    const std::string before = sourceType(volume).empty() ? volume.type : sourceType(volume);
    if (!facts.fit(type)) {
        notes.loss(before + " stored as " + name + ", which is off by up to " +
                   numberText(facts.doubleError));
    } else if (name != before && volume.readError == 0 &&
               !(before == "float" && name == "float32") &&
               !(before == "double" && name == "float64")) {
        notes.remark(before + " stored as " + name + ", which holds every value");
    }
    return type;
}

}  // namespace deltasplat
