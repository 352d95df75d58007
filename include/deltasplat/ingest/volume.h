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

/// OpenVDB tree of codes; defined in src/volume/code_tree.h for the stages that walk it.
struct CodeTree;

/// The source's own grid of values; defined in src/volume/tree_grid.h.
struct SourceGrid;

/// Names and looks of labels; defined in deltasplat/ingest/label_list.h.
struct LabelList;

/// The making of the delta grid that a volume was read from.
struct DeltaOrigin {
    int sliceAxis = 2;  ///< 0 = x, 1 = y, 2 = z
    int keyInterval = 8;
    std::uint64_t deltas = 0;
    std::string codeBook;       ///< as DeltaFileEntry::codeBook
    double tolerance = 0;       ///< relative
    double toleranceValue = 0;  ///< in data units
    double maxError = 0;        ///< largest error of a value against its source's
};

/// Contents of a Volume, filled by readers and makers of volumes.
struct VolumeData {
    std::string name;           ///< grid name, or the file's name without folder and extensions
    std::string type;           ///< value type of the source: "uint8", "float", "half", "bool", ...
    std::string gridClass;      ///< "fog volume", "level set", "staggered" or "unknown"
    bool fromLevelSet = false;  ///< fog volume made from a level set
    /// Whether voxels may be inactive, of value `background`: .vdb, or values in memory with one.
    bool hasBackground = false;
    double background = 0;  ///< value of inactive voxels
    CodeBook codeBook;
    std::shared_ptr<const CodeTree> codes;  ///< active voxels in the source's index space
    /// Of a cut volume: the codes before the cut, for gradients; else null.
    std::shared_ptr<const CodeTree> uncut;
    IndexBox box;  ///< raw: all voxels; .vdb: bounding box of the active voxels
    glm::dmat4 worldFromIndex{
        1.0};                       ///< affine; maps (i, j, k) to the voxel's centre in world units
    std::uint64_t activeCount = 0;  ///< active voxels, those in active tiles included
    std::vector<std::uint64_t> histogram;  ///< [65536]: how many active voxels have each code
    /// The patient's coordinate system of world space: "RAS" (x to the right, y to the front, z
    /// up), "LPS" (x to the left, y to the back, z up), or empty if unknown.
    std::string space;
    /// Unit of world lengths: "mm" in a patient's space with a unit (lengths are converted), else
    /// the file's: "km", "m", "dm", "cm", "mm", "um", "nm", "pm", "angstrom", "in", "ft"; or empty.
    std::string lengthUnit;
    /// The file's labels; null unless the file says that values are labels.
    std::shared_ptr<const LabelList> labels;
    /// Values that codes lose, for ReadOptions::keepSource: always with hasBackground, else only if
    /// the code book is not exact (then a grid of the source's value type).
    std::shared_ptr<const SourceGrid> source;
    std::optional<DeltaOrigin> origin;  ///< only of a volume read from a delta grid
    std::uint64_t replaced = 0;         ///< NaN and infinities that ReadOptions::nanValue replaced
    /// Largest error of a 64-bit integer as read; only unsigned ones beyond 2^53 have one.
    double readError = 0;
    double valueMin = 0;  ///< smallest active value of the source; 0 if none
    double valueMax = 0;  ///< largest active value of the source; 0 if none
    /// The active voxels' most frequent value, of several the smallest. An inexact code book
    /// without background gives a value of the source; count 0: none reaches a fifth of the voxels.
    std::optional<FrequentValue> mostFrequent;
    CodeError codeError;  ///< error of codes against the source's values

    bool empty() const { return activeCount == 0; }
    glm::dvec3 voxelSize() const {
        return {glm::length(glm::dvec3(worldFromIndex[0])),
                glm::length(glm::dvec3(worldFromIndex[1])),
                glm::length(glm::dvec3(worldFromIndex[2]))};
    }
};

/// One scalar volume in memory: codes on a sparse grid, their meaning and their place. Every voxel
/// of a raw volume is active; a .vdb has its own active states. Inactive voxels are empty.
///
/// A volume never changes and is cheap to copy: copies share one VolumeData, for which:
///   - histogram() has 65536 numbers, or none;
///   - valueMin() <= valueMax(), both finite;
///   - box() holds a place if any voxel is active;
///   - worldFromIndex() gives every voxel a place of its own;
///   - lengthUnit() and space() are one of the names that VolumeData lists, or empty.
class Volume {
  public:
    /// A volume without voxels.
    Volume();
    /// @throw Error(kUsage) "volume: got ...; expected ..." if a condition above does not hold
    explicit Volume(VolumeData data);

    /// Returns the same voxels with another name, place or labels.
    /// @throw Error(kUsage) if the place gives voxels none
    Volume withName(std::string name) const;
    Volume withPlace(const glm::dmat4& worldFromIndex, std::string space,
                     std::string lengthUnit) const;
    Volume withLabels(std::shared_ptr<const LabelList> labels) const;
    /// Returns the same description without codes, or without codes and source. Their memory comes
    /// back once no copy has them.
    Volume withoutCodes() const;
    Volume withoutVoxels() const;
    /// Returns the parts of this volume, to make another volume from.
    const VolumeData& data() const { return *data_; }

    // Members of VolumeData, described there.
    const std::string& name() const { return data_->name; }
    const std::string& type() const { return data_->type; }
    const std::string& gridClass() const { return data_->gridClass; }
    bool fromLevelSet() const { return data_->fromLevelSet; }
    bool hasBackground() const { return data_->hasBackground; }
    double background() const { return data_->background; }
    const CodeBook& codeBook() const { return data_->codeBook; }
    const std::shared_ptr<const CodeTree>& codes() const { return data_->codes; }
    const std::shared_ptr<const CodeTree>& uncut() const { return data_->uncut; }
    const IndexBox& box() const { return data_->box; }
    const glm::dmat4& worldFromIndex() const { return data_->worldFromIndex; }
    std::uint64_t activeCount() const { return data_->activeCount; }
    const std::vector<std::uint64_t>& histogram() const { return data_->histogram; }
    const std::string& space() const { return data_->space; }
    const std::string& lengthUnit() const { return data_->lengthUnit; }
    const std::shared_ptr<const LabelList>& labels() const { return data_->labels; }
    const std::shared_ptr<const SourceGrid>& source() const { return data_->source; }
    const std::optional<DeltaOrigin>& origin() const { return data_->origin; }
    std::uint64_t replaced() const { return data_->replaced; }
    double readError() const { return data_->readError; }
    double valueMin() const { return data_->valueMin; }
    double valueMax() const { return data_->valueMax; }
    const std::optional<FrequentValue>& mostFrequent() const { return data_->mostFrequent; }
    CodeError codeError() const { return data_->codeError; }

    bool empty() const { return activeCount() == 0; }
    glm::dvec3 voxelSize() const { return data_->voxelSize(); }

  private:
    std::shared_ptr<const VolumeData> data_;
};

}  // namespace deltasplat
