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

struct DeltaFileOptions {
    std::optional<int> sliceAxis;  ///< 0 = x, 1 = y, 2 = z; empty: the axis with the fewest deltas
    int keyInterval = 0;           ///< a multiple of 8; 0 = defaultKeyInterval
    Tolerance tolerance;
    /// Stores the volume's codes, which pictures are made of, even if inexact: a smaller file.
    bool codesOnly = false;
    /// Writes deltas as a stream of bits: mostly half the bytes of voxels, and faster to read.
    /// Unpacked, each change is a voxel that other programs see.
    bool pack = true;
    /// Largest allowed error, in data units; empty: any.
    std::optional<double> maxError;
};

struct DeltaFileEntry {
    int sliceAxis = 2;
    int keyInterval = 8;
    std::uint64_t deltas = 0;
    double maxError = 0;  ///< largest |restored - source|, measured over every voxel
    bool lossless = true;
    /// As CodeBook::name, or "float32", "float64", "int32" or "int64" for values stored as bits.
    std::string codeBook;
};

/// A .vdb of delta grids, in the format of docs/delta-grid.md. Grids are added one by one, so only
/// one volume is in memory besides the output.
class DeltaFile {
  public:
    DeltaFile();
    ~DeltaFile();
    DeltaFile(const DeltaFile&) = delete;
    DeltaFile& operator=(const DeltaFile&) = delete;

    /// Takes the differences of a volume that was read with ReadOptions::keepSource, and measures
    /// the error against the source. Without a tolerance, values without an exact code book are
    /// stored by their own bits, unless options.codesOnly is set. Multi-threaded; deterministic.
    /// @throw Error(kUsage) if the key interval is no multiple of 8, a tolerance is negative or
    ///        below the code book's error, or memory runs out; Error(kFailed) above maxError
    DeltaFileEntry add(const Volume& volume, const DeltaFileOptions& options,
                       const Listener& listener = {});
    /// @throw Error(kOutput) if it cannot be written
    void write(const std::filesystem::path& file) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
