// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "files/file_bytes.h"
#include "formats/dense/dense_layout.h"
#include "formats/dense/dense_source.h"

namespace deltasplat {

/// Values that lie in a file one after the other, plain or under gzip.
struct RawFile {
    std::filesystem::path path;
    RawLayout layout;  ///< of one volume, behind skipBytes of what is unpacked
    Packing packing = Packing::kNone;
    std::uint64_t packedStart = 0;  ///< place in the file where packed bytes begin
    std::shared_ptr<const FileBytes> bytes = nullptr;  ///< of the file, if it is open already
    bool mayGoOn = false;                              ///< whether bytes may follow the last value
    /// How many volumes of this layout there are, one behind the other, and which one is read. All
    /// of their bytes fit into 62 bits.
    std::int64_t volumes = 1;
    std::int64_t volume = 0;

    bool isPacked() const { return packing != Packing::kNone; }
    std::uint64_t dataBytes() const { return std::uint64_t(volumes) * layout.dataBytes(); }
    /// Where the values of the volume begin, and how many bytes of others follow them.
    std::uint64_t start() const {
        return layout.skipBytes + std::uint64_t(volume) * layout.dataBytes();
    }
    std::uint64_t laterBytes() const {
        return std::uint64_t(volumes - volume - 1) * layout.dataBytes();
    }
};

/// Checks the size of a file, with all of its volumes, as far as it is known before it is read.
/// @throw Error(kInput) "<path>: got 500 bytes; expected 512 (8x8x8 uint8)"
void requireRawSize(const RawFile& file);

/// Returns what readDense takes for a file; where it lies in the world is left to be said. Other
/// volumes of a plain file are not touched, those of a packed one are unpacked and passed over:
/// what follows the volume only the first time, when the file is checked up to its end.
DenseSource denseSourceOf(const RawFile& file);

/// Says what a file does not say of where voxels lie and options can, and what nothing brings back.
/// @param lack     what the file does not have
/// @param options  that it has to be read with besides
void notePlace(const DenseLayout& layout, const std::string& lack, std::string options,
               WriteNotes& notes);

}  // namespace deltasplat
