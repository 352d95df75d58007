// SPDX-License-Identifier: Apache-2.0
#include <glm/gtc/matrix_transform.hpp>

#include "ingest/dense_source.h"
#include "ingest/file_name.h"
#include "ingest/raw_file.h"
#include "ingest/readers.h"

namespace deltasplat {

DenseSource openRaw(const std::filesystem::path& path, const RawFormat& format) {
    const RawFile file{path, resolveRawLayout(path, format), lowerExtension(path) == ".raw.gz",
                       false};
    requireRawSize(file);
    DenseSource source;
    source.where = path.string();
    source.name = nameWithoutExtensions(path);
    source.dims = file.layout.dims;
    source.type = file.layout.type;
    source.bigEndian = file.layout.bigEndian;
    source.worldFromIndex =
        glm::scale(glm::translate(glm::dmat4(1), format.origin), format.spacing);
    source.forEachLayer = rawLayersOf(file);
    return source;
}

}  // namespace deltasplat
