// SPDX-License-Identifier: Apache-2.0
#include "ingest/choose_volume.h"
#include "ingest/dense/dense_source.h"
#include "ingest/files/file_name.h"
#include "ingest/nifti/nifti_header.h"
#include "ingest/raw/raw_file.h"
#include "ingest/readers.h"

namespace deltasplat {

DenseSource openNifti(const std::filesystem::path& path, const ReadOptions& options,
                      const Listener& listener) {
    const NiftiHeader header = readNiftiHeader(path, listener);
    RawFile file{path, header.layout, lowerExtension(path) == ".nii.gz", true, header.volumes};
    requireRawSize(file);
    file.volume =
        chooseVolume(path.string(), "dims " + header.dims, header.volumes, options.volume);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = header.worldFromIndex;
    source.space = header.space;
    return rescaled(std::move(source), header.rescale);
}

}  // namespace deltasplat
