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

/// A volume without empty places, read slice by slice from any file: the input of readDense.
struct DenseSource {
    std::string where;     ///< file or folder, for messages
    std::string name;      ///< the volume's name
    glm::i64vec3 dims{1};  ///< voxels along x, y, z; each 1..2^30
    RawType type = RawType::kUint8;
    bool bigEndian = false;  ///< byte order in forEachLayer
    /// A real type stands in for whole numbers, which get codes of whole numbers.
    bool standsForWhole = false;
    glm::dmat4 worldFromIndex{1.0};
    std::string space;                        ///< as Volume::space
    std::string lengthUnit;                   ///< as Volume::lengthUnit
    std::shared_ptr<const LabelList> labels;  ///< as Volume::labels
    /// Voxels that the file declares to be nothing.
    struct Nothing {
        double value = 0;                     ///< of these voxels alone; may be NaN
        RawType valueType = RawType::kUint8;  ///< of the other voxels' values
    };
    std::optional<Nothing> nothing;
    RawType valueType() const { return nothing ? nothing->valueType : type; }
    std::vector<std::string> notes;  ///< warnings about what values do not mean
    std::int64_t volumes = 1;        ///< number of volumes in the file

    /// Receives `slices` slices from slice `first` on, x fastest, without gaps.
    using LayerUse = std::function<void(int first, int slices, const std::byte* bytes)>;
    /// Calls the function for all slices in order, a multiple of kLayerSlices at a time, at most
    /// stepSlices() (fewer at the end), and reports progress. May be called again, from the start.
    /// @throw Error(kInput) if the file is not what it claimed to be
    std::function<void(const LayerUse& use, const Listener& listener)> forEachLayer;

    /// Reads the same values in any order; null unless the file holds them as forEachLayer does.
    std::shared_ptr<const StoredRows> rows;

    static constexpr int kLayerSlices = 8;
    int step = kLayerSlices;  ///< most slices per call of forEachLayer
    int stepSlices() const { return int(std::min<std::int64_t>(dims.z, step)); }
    /// Returns a step with enough work for all threads, or the least under a memory limit.
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

/// Reads a dense volume as readVolume promises: chooses the code book, replaces NaN, and builds the
/// tree layer by layer, so that uniform blocks take no memory.
Volume readDense(const DenseSource& source, const ReadOptions& options, const Listener& listener);

/// Reads a dense volume whose voxels of value `background` (or NaN) are empty, as from a .vdb.
Volume readSparse(const DenseSource& source, double background, const ReadOptions& options,
                  const Listener& listener);

/// Does the same as readDense, but keeps unsigned integers as readCompared does.
Volume readDenseUnsigned(const DenseSource& source, const ReadOptions& options,
                         const Listener& listener);

}  // namespace deltasplat
