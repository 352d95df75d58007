// SPDX-License-Identifier: Apache-2.0
#include "formats/raw/raw_note.h"

#include <glm/gtc/matrix_transform.hpp>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {
namespace {

// Whether the file's name says so: "head_uint16be.raw".
bool namesBigEndian(const std::string& file, const DenseLayout& layout) {
    RawFormat format;
    format.dims = glm::i64vec3(layout.dims);
    format.type = rawTypeName(layout.type);
    try {
        return resolveRawLayout(file, format).bigEndian;
    } catch (const Error&) {
        return false;  // 64-bit integers, which raw files are not read as
    }
}

}  // namespace

void notePlace(const DenseLayout& layout, const std::string& lack, std::string options,
               WriteNotes& notes) {
    const glm::dvec3 spacing = layout.spacing(), origin = layout.origin();
    if (spacing != glm::dvec3(1)) options += " `spacing` " + numberText(spacing);
    if (origin != glm::dvec3(0)) options += " `origin` " + numberText(origin);

    const glm::dmat4 readBack = glm::scale(glm::translate(glm::dmat4(1), origin), spacing);
    std::string dropped;
    if (readBack != layout.worldFromIndex) dropped += " axis directions";
    if (!layout.space.empty())
        dropped += (dropped.empty() ? " " : " and ") + layout.space + " space";
    if (layout.space.empty() && !layout.lengthUnit.empty())
        dropped += (dropped.empty() ? " " : " and ") + std::string("that lengths are in ") +
                   layout.lengthUnit;
    if (!options.empty()) notes.remark(lack + "; read it with" + options);
    if (!dropped.empty()) notes.loss(lack + ", which drops" + dropped);
}

// A file without a header: what its name does not say, the options have to when it is read.
void settleRaw(DenseLayout& layout, const std::string& file, WriteNotes& notes) {
    std::string options;
    const bool ordered = rawTypeBytes(layout.type) > 1;
    layout.bigEndian = ordered && namesBigEndian(file, layout);
    if (!saysLayout(file, {layout.dims, layout.type, layout.bigEndian, 0})) {
        options += " `dims` " + dimsText(layout.dims) + " `type` " + rawTypeName(layout.type);
        if (ordered) options += layout.bigEndian ? " `bigEndian=true`" : " `bigEndian=false`";
    }
    notePlace(layout, "no header", options, notes);
    layout.noteLabels("a file without a header", true, notes);
}

}  // namespace deltasplat
