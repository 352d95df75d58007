// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/read_exact_deltas.h"

#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "formats/delta/decode_deltas.h"
#include "formats/delta/restored_grid.h"
#include "formats/dense/dense_source.h"
#include "volume/tree_grid.h"

namespace deltasplat {
namespace {

// Hands on a tree's box, layer by layer.
template <typename Tree>
void forEachLayer(const Tree& tree, const glm::ivec3& size, const DenseSource::LayerUse& use,
                  const Listener& listener) {
    using Value = typename Tree::ValueType;
    using Layer = openvdb::tools::Dense<Value, openvdb::tools::LayoutXYZ>;
    std::vector<Value> values(std::size_t(size.x) * std::size_t(size.y) *
                              DenseSource::kLayerSlices);
    for (int first = 0; first < size.z; first += DenseSource::kLayerSlices) {
        const int slices = std::min(size.z - first, DenseSource::kLayerSlices);
        Layer layer({{0, 0, first}, {size.x - 1, size.y - 1, first + slices - 1}}, values.data());
        openvdb::tools::copyToDense(tree, layer);
        use(first, slices, reinterpret_cast<const std::byte*>(values.data()));
        listener.report(double(first + slices) / double(size.z));
    }
}

constexpr RawType kRawTypes[] = {RawType::kFloat32, RawType::kFloat64, RawType::kInt32,
                                 RawType::kInt64};

DenseSource denseSource(const TreeGrid& grid, const DeltaHeader& header,
                        const GridCodesOptions& options, const Volume& volume) {
    DenseSource source;
    source.where = options.where;
    source.name = volume.name;
    source.dims = glm::i64vec3(header.box.dims());
    source.type = kRawTypes[int(*header.exact)];
    source.bigEndian = std::endian::native == std::endian::big;
    // Of 64 bits and without sign; whole numbers of other types are stored as such.
    source.standsForWhole = header.sourceType == "uint64";
    source.worldFromIndex = volume.worldFromIndex;
    source.space = header.space;
    source.lengthUnit = volume.lengthUnit;
    source.labels = volume.labels;
    source.forEachLayer = [&grid, size = header.box.dims()](const DenseSource::LayerUse& use,
                                                            const Listener& listener) {
        grid.apply<ExactTrees>([&](const auto& tree) { forEachLayer(tree, size, use, listener); });
    };
    return source;
}

}  // namespace

void readExactDeltas(TreeGrid& deltas, const DeltaHeader& header, const VdbMetadata& fileMetadata,
                     const GridCodesOptions& options, Volume& volume) {
    const std::string& where = options.where;
    const Listener decoding = partOf(options.listener, 0, 0.5);
    Listener reading = partOf(options.listener, 0.5, 1);
    TreeGrid source = restoreGrid(header, decodeValues(deltas, header, where, decoding), deltas,
                                  volume.worldFromIndex);
    requireActiveCount(source.tree->activeVoxelCount(), header, where);
    if (header.restActive) {
        ReadOptions codesOnly = options.reading;
        codesOnly.keepSource = codesOnly.keepInexact = false;
        // Who keeps the source has its values.
        if (options.reading.keepSource && !options.reading.bits) reading.warning = {};
        Volume dense = readDense(denseSource(source, header, options, volume), codesOnly, reading);
        dense.origin = volume.origin;
        dense.type = header.sourceType;
        dense.gridClass = volume.gridClass;
        volume = std::move(dense);
    } else {
        fillFromGrid(source, options, volume);
    }
    const bool isExact = volume.codeBook.isExact();
    const bool keeps = options.reading.keepSource ? volume.hasBackground || !isExact
                                                  : options.reading.keepInexact && !isExact;
    if (keeps)
        volume.source =
            std::make_shared<const SourceGrid>(SourceGrid{std::move(source), fileMetadata});
}

}  // namespace deltasplat
