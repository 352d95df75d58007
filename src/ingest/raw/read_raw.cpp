// SPDX-License-Identifier: Apache-2.0
#include <glm/gtc/matrix_transform.hpp>

#include "ingest/dense/dense_source.h"
#include "ingest/files/file_name.h"
#include "ingest/raw/raw_file.h"
#include "ingest/readers.h"

namespace deltasplat {

DenseSource openRaw(const std::filesystem::path& path, const RawFormat& format) {
    RawFile file{path, resolveRawLayout(path, format)};
    requireRegularFile(path);
    // What it begins with tells, but that values may begin as gzip does, and a packed file be cut
    // or damaged: then name and size do.
    const bool named = lowerExtension(path) == ".raw.gz";
    const std::uint64_t plain = file.layout.skipBytes + file.layout.dataBytes();
    const bool fits = std::filesystem::file_size(path) == plain;
    file.packing = named != fits ? (named ? Packing::kGzip : Packing::kNone) : packingOf(path);
    requireRawSize(file);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = glm::scale(glm::translate(glm::dmat4(1), format.origin),
                                       format.spacing.value_or(glm::dvec3(1)));
    return source;
}

}  // namespace deltasplat
