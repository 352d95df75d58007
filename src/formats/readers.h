// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "formats/dense/dense_source.h"
#include "volume/volume_checks.h"

namespace deltasplat {

// Each of these looks at the headers only. All throw as readVolume.

/// Opens a .raw or .raw.gz file.
DenseSource openRaw(const std::filesystem::path& file, const RawFormat& format);

/// Opens a .nii file, or a .hdr and .img pair.
DenseSource openNifti(const std::filesystem::path& file, const ReadOptions& options,
                      const Listener& listener);

/// Opens a .nrrd or .nhdr file.
DenseSource openNrrd(const std::filesystem::path& file, const ReadOptions& options,
                     const Listener& listener);

/// Opens a .mhd or .mha file.
DenseSource openMetaImage(const std::filesystem::path& file, const ReadOptions& options,
                          const Listener& listener);

/// Opens a stack of images, or the pages of one.
/// @param input   for messages
/// @param files   in order
DenseSource openImages(const std::filesystem::path& input, const std::string& name,
                       const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                       const Listener& listener);

/// Reads one scalar grid of a .vdb file, or with `all` (and no grid name) every one; as
/// forEachVolume.
void readVdb(const std::filesystem::path& file, const ReadOptions& options, bool all,
             const VolumeVisitor& visitor, const Listener& listener);

}  // namespace deltasplat
