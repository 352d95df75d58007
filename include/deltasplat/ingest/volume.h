// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/index_box.h"
#include "deltasplat/ingest/code_book.h"
#include "deltasplat/ingest/source_values.h"

namespace deltasplat {

/// The OpenVDB tree of codes; defined in src/volume/code_tree.h for the stages that walk it.
struct CodeTree;

/// The source's own grid of values; defined in src/volume/tree_grid.h.
struct SourceGrid;

/// Names and looks of labels; defined in deltasplat/ingest/label_list.h.
struct LabelList;

/// How the delta grid was made that a volume has been read from.
struct DeltaOrigin {
    int sliceAxis = 2;  ///< 0 = x, 1 = y, 2 = z
    int keyInterval = 8;
    std::uint64_t deltas = 0;
    std::string codeBook;       ///< as DeltaFileEntry::codeBook
    double tolerance = 0;       ///< relative
    double toleranceValue = 0;  ///< in data units
    double maxError = 0;  ///< largest distance of a value from its source's, measured at making
};

/// One scalar volume in memory: codes on a sparse grid, what they mean, and where they are.
///
/// Every voxel of a raw volume is active; a .vdb brings its own active states. What is inactive is
/// empty.
struct Volume {
    std::string name;           ///< grid name, or the file's name without folder and extensions
    std::string type;           ///< value type of the source: "uint8", "float", "half", "bool", ...
    std::string gridClass;      ///< "fog volume", "level set", "staggered" or "unknown"
    bool fromLevelSet = false;  ///< a fog volume that a level set was made into
    /// Whether voxels may be inactive and then hold `background`: true for .vdb and for values in
    /// memory with a background, false for others.
    bool hasBackground = false;
    double background = 0;                  ///< value of inactive voxels
    CodeBook codeBook;                      ///< what the codes mean
    std::shared_ptr<const CodeTree> codes;  ///< active voxels in the source's index space
    /// Of a volume that was cut: the codes before, for gradients; else null.
    std::shared_ptr<const CodeTree> uncut;
    IndexBox box;  ///< raw: all voxels; .vdb: bounding box of the active voxels
    glm::dmat4 worldFromIndex{
        1.0};                       ///< affine; maps (i, j, k) to the voxel's centre in world units
    std::uint64_t activeCount = 0;  ///< active voxels, those in active tiles included
    std::vector<std::uint64_t> histogram;  ///< [65536]: how many active voxels have each code
    /// Coordinate system of the patient that world space is: "RAS" (x to the right, y to the front,
    /// z up), "LPS" (x to the left, y to the back, z up), or empty where the file names none.
    std::string space;
    /// Unit of world lengths: "mm" in a patient's space of which the file names a unit (its lengths
    /// are converted), elsewhere the file's own: "km", "m", "dm", "cm", "mm", "um", "nm", "pm",
    /// "angstrom", "in", "ft". Empty where the file names none.
    std::string lengthUnit;
    /// What the file says of its labels; null where it does not say that its values are labels.
    std::shared_ptr<const LabelList> labels;
    /// What codes cannot tell, if ReadOptions::keepSource asked for it: where hasBackground always,
    /// otherwise only if the code book is not exact (then a grid of the source's value type).
    std::shared_ptr<const SourceGrid> source;
    std::optional<DeltaOrigin> origin;  ///< only of a volume read from a delta grid
    std::uint64_t replaced = 0;         ///< NaN and infinities that ReadOptions::nanValue replaced
    /// Largest difference between a 64-bit integer of the file and what was read, which only
    /// unsigned ones beyond 2^53 have.
    double readError = 0;
    double valueMin = 0;  ///< smallest active value of the source; 0 if none
    double valueMax = 0;  ///< largest active value of the source; 0 if none
    /// The value that most active voxels have, of several the smallest. Where the code book is not
    /// exact that is one of the source's, unless there is a background; a count of 0 says that none
    /// is that of a fifth of the voxels.
    std::optional<FrequentValue> mostFrequent;
    CodeError codeError;  ///< how far codes are from the source's values

    bool empty() const { return activeCount == 0; }
    /// World lengths of one index step along i, j and k.
    glm::dvec3 voxelSize() const {
        return {glm::length(glm::dvec3(worldFromIndex[0])),
                glm::length(glm::dvec3(worldFromIndex[1])),
                glm::length(glm::dvec3(worldFromIndex[2]))};
    }
};

}  // namespace deltasplat
