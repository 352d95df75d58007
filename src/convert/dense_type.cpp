// SPDX-License-Identifier: Apache-2.0
#include "convert/dense_type.h"

#include <optional>

#include "ingest/grids/grid_metadata.h"
#include "ingest/grids/source_grid.h"
#include "number_text.h"

namespace deltasplat {
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

RawType denseType(const Volume& volume, const ValueFacts& facts, bool wide, Notes& notes) {
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
