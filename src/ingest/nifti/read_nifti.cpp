// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/label_list.h"
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
    RawFile file{header.dataFile, header.layout, packingOf(header.dataFile)};
    file.mayGoOn = true;
    file.volumes = header.volumes;
    requireRawSize(file);
    file.volume =
        chooseVolume(path.string(), "dims " + header.dims, header.volumes, options.volume);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = header.worldFromIndex;
    source.where = path.string();
    source.name = nameWithoutExtensions(path);
    source.space = header.space;
    source.lengthUnit = header.lengthUnit;
    if (header.isLabels) source.labels = std::make_shared<const LabelList>();
    return rescaled(std::move(source), header.rescale);
}

}  // namespace deltasplat
