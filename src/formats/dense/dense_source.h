// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/memory_limit.h"
#include "files/file_bytes.h"
#include "formats/input_kind.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// A volume without empty places that comes slice by slice, whatever file it lies in: what every
/// reader of dense formats hands to readDense.
struct DenseSource {
    std::string where;     ///< file or folder, for messages
    std::string name;      ///< the volume's name
    glm::i64vec3 dims{1};  ///< voxels along x, y, z; each 1..2^30
    RawType type = RawType::kUint8;
    bool bigEndian = false;  ///< of the bytes that forEachLayer gives
    /// Values are whole numbers that a real type stands in for: codes are those of whole numbers.
    bool standsForWhole = false;
    glm::dmat4 worldFromIndex{1.0};
    std::string space;                        ///< as Volume::space
    std::string lengthUnit;                   ///< as Volume::lengthUnit
    std::shared_ptr<const LabelList> labels;  ///< as Volume::labels
    /// Voxels of which the file says that nothing is there.
    struct Nothing {
        double value = 0;                     ///< what they have, and no other voxel; may be NaN
        RawType valueType = RawType::kUint8;  ///< that of the other voxels' values
    };
    std::optional<Nothing> nothing;
    RawType valueType() const { return nothing ? nothing->valueType : type; }
    std::vector<std::string> notes;  ///< what users may not expect of the values: warnings
    std::int64_t volumes = 1;        ///< how many volumes its file has, one of which it is

    /// Receives `slices` slices from number `first` on, x fastest, without gaps.
    using LayerUse = std::function<void(int first, int slices, const std::byte* bytes)>;
    /// Calls the function for a multiple of kLayerSlices slices, at most stepSlices() (fewer at the
    /// end), from first to last, and reports the share done. May be called more than once, and then
    /// starts again.
    /// @throw Error(kInput) if the file turns out not to be what it claimed
    std::function<void(const LayerUse& use, const Listener& listener)> forEachLayer;

    /// The same values, in any order; null where they do not lie in a file as forEachLayer gives
    /// them.
    std::shared_ptr<const StoredRows> rows;

    static constexpr int kLayerSlices = 8;
    int step = kLayerSlices;  ///< the most slices that forEachLayer gives at a time
    int stepSlices() const { return int(std::min<std::int64_t>(dims.z, step)); }
    /// Returns the step that makes enough work for all threads; the least where memory is limited.
    int enoughSlices() const {
        const std::int64_t mostLayers = memoryLimit() > 0 ? 1 : 16;
        constexpr std::int64_t kBytes = std::int64_t{8} << 20;
        const auto layer = std::max<std::int64_t>(1, std::int64_t(sliceBytes()) * kLayerSlices);
        const std::int64_t layers = std::clamp(kBytes / layer, std::int64_t{1}, mostLayers);
        return int(layers * kLayerSlices);
    }
    std::size_t rowBytes() const { return std::size_t(dims.x) * std::size_t(rawTypeBytes(type)); }
    std::size_t sliceBytes() const { return rowBytes() * std::size_t(dims.y); }
};

/// Reads a dense volume as readVolume promises: chooses the code book, replaces NaN, builds the
/// tree layer by layer, so that what is uniform takes no memory.
Volume readDense(const DenseSource& source, const ReadOptions& options, const Listener& listener);

/// Reads a dense volume of which voxels with the value `background` are empty, or those that are
/// NaN if it is: what a .vdb of the others would be.
Volume readSparse(const DenseSource& source, double background, const ReadOptions& options,
                  const Listener& listener);

/// Reads as readDense, with unsigned integers as readCompared keeps them.
Volume readDenseUnsigned(const DenseSource& source, const ReadOptions& options,
                         const Listener& listener);

}  // namespace deltasplat
