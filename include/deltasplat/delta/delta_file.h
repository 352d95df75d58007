// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/progress.h"
#include "deltasplat/tolerance.h"

namespace deltasplat {

/// How a volume becomes a delta grid in a file.
struct DeltaFileOptions {
    std::optional<int> sliceAxis;  ///< 0 = x, 1 = y, 2 = z; empty: the one with the fewest deltas
    int keyInterval = 0;           ///< a multiple of 8; 0 = defaultKeyInterval
    Tolerance tolerance;
    /// Stores the volume's codes even where they are not exact: what pictures are made of, in a
    /// smaller file.
    bool codesOnly = false;
    /// Writes deltas as a stream of bits: mostly half the bytes of voxels, and read more quickly.
    /// As voxels, each change is one, which other programs see.
    bool pack = true;
    /// The largest error that is let through, in data units; empty: any.
    std::optional<double> maxError;
};

/// What became of a volume.
struct DeltaFileEntry {
    int sliceAxis = 2;
    int keyInterval = 8;
    std::uint64_t deltas = 0;
    double maxError = 0;  ///< largest |restored - source|, measured over every voxel
    bool lossless = true;
    /// As CodeBook::name, or "float32", "float64", "int32" or "int64" where values are stored by
    /// their own bits.
    std::string codeBook;
};

/// A .vdb of delta grids, the format of docs/delta-grid.md: grid by grid, so that only one volume
/// is in memory besides what will be written.
class DeltaFile {
  public:
    DeltaFile();
    ~DeltaFile();
    DeltaFile(const DeltaFile&) = delete;
    DeltaFile& operator=(const DeltaFile&) = delete;

    /// Takes the differences of a volume that was read with ReadOptions::keepSource, and measures
    /// how far what comes back is from the source. Without a tolerance values for which there is no
    /// exact code book are stored by their own bits, unless options.codesOnly is set.
    /// Multi-threaded; deterministic.
    /// @throw Error(kUsage) if the key interval is no multiple of 8, if a tolerance is negative or
    ///        smaller than the code book's own error, or if memory does not suffice;
    ///        Error(kFailed) if the error is larger than options.maxError
    DeltaFileEntry add(const Volume& volume, const DeltaFileOptions& options,
                       const Listener& listener = {});
    /// Writes all grids added.
    /// @throw Error(kOutput) if it cannot be written
    void write(const std::filesystem::path& file) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
