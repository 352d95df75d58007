// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>

#include "deltasplat/error.h"
#include "ingest/byte_source.h"
#include "ingest/dense_source.h"
#include "ingest/file_name.h"
#include "ingest/readers.h"

namespace deltasplat {
namespace {

struct RawFile {
    std::filesystem::path path;
    RawLayout layout;
    bool gzip;
};

[[noreturn]] void throwSize(const RawFile& file, std::uint64_t bytes) {
    throw Error(ErrorCode::kInput,
                gotExpected(file.path.string(),
                            std::to_string(bytes) + (file.gzip ? " bytes unpacked" : " bytes"),
                            file.layout.expectedSize()));
}

// A plain file's size is known before anything is read; a gzip file's only at its end.
void checkPlainSize(const RawFile& file) {
    if (file.gzip) return;
    const std::uint64_t bytes = std::filesystem::file_size(file.path);
    if (bytes != file.layout.skipBytes + file.layout.dataBytes()) throwSize(file, bytes);
}

void readLayers(const RawFile& file, std::size_t sliceBytes, const DenseSource::LayerUse& use,
                const Listener& listener) {
    ByteSource source(file.path, file.gzip);
    const auto beat = [&](double share) { return [&listener, share] { listener.report(share); }; };
    std::uint64_t done = source.skip(file.layout.skipBytes, beat(0));
    const int slices = int(file.layout.dims.z);
    const std::size_t layerBytes =
        sliceBytes * std::size_t(std::min(slices, DenseSource::kLayerSlices));
    const auto bytes = std::make_unique_for_overwrite<std::byte[]>(layerBytes);
    for (int first = 0; first < slices; first += DenseSource::kLayerSlices) {
        const int count = std::min(DenseSource::kLayerSlices, slices - first);
        const std::size_t wanted = sliceBytes * std::size_t(count);
        const std::size_t got = source.read(bytes.get(), wanted);
        done += got;
        if (got != wanted) throwSize(file, done);
        use(first, count, bytes.get());
        listener.report(double(first + count) / slices);
    }

    // What follows the last voxel says that the dims are wrong: count it for the message.
    const std::uint64_t more = source.skip(std::numeric_limits<std::uint64_t>::max(), beat(1));
    if (more != 0) throwSize(file, done + more);
}

}  // namespace

Volume readRaw(const std::filesystem::path& path, const ReadOptions& options,
               const Listener& listener) {
    const RawFile file{path, resolveRawLayout(path, options.raw),
                       lowerExtension(path) == ".raw.gz"};
    checkPlainSize(file);
    DenseSource source;
    source.where = path.string();
    source.name = nameWithoutExtensions(path);
    source.dims = file.layout.dims;
    source.type = file.layout.type;
    source.bigEndian = file.layout.bigEndian;
    source.worldFromIndex =
        glm::scale(glm::translate(glm::dmat4(1), options.raw.origin), options.raw.spacing);
    const std::size_t sliceBytes = source.sliceBytes();
    source.forEachLayer = [&file, sliceBytes](const DenseSource::LayerUse& use,
                                              const Listener& layers) {
        readLayers(file, sliceBytes, use, layers);
    };
    return readDense(source, options, listener);
}

}  // namespace deltasplat
