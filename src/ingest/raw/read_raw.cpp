// SPDX-License-Identifier: Apache-2.0
#include <glm/gtc/matrix_transform.hpp>

#include "ingest/dense/dense_source.h"
#include "ingest/files/file_name.h"
#include "ingest/raw/raw_file.h"
#include "ingest/readers.h"

namespace deltasplat {

DenseSource openRaw(const std::filesystem::path& path, const RawFormat& format) {
    const RawFile file{path, resolveRawLayout(path, format), lowerExtension(path) == ".raw.gz",
                       false};
    requireRawSize(file);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex =
        glm::scale(glm::translate(glm::dmat4(1), format.origin), format.spacing);
    return source;
}

}  // namespace deltasplat
