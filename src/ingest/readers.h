// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "ingest/dense/dense_source.h"

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

/// @throw Error(kInput) if `high - low` is no finite number: no code book spans it
void requireFiniteSpan(const std::string& where, double low, double high);

/// @throw Error(kUsage) if what is to replace NaN is no finite number itself
void requireFiniteNan(const ReadOptions& options);

/// @throw Error(kUsage) if `nanValue`, which is to replace a value, is no finite float
void requireFloatNan(double nanValue);

/// Sets activeCount, valueMin, valueMax and mostFrequent from the histogram and the code book: the
/// source's own if that is exact.
void summarize(Volume& volume);

/// Warns if values are kept so badly that a picture may show it.
void warnOfCodeError(const std::string& where, const Volume& volume, const ReadOptions& options,
                     const Listener& listener);

}  // namespace deltasplat
