// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "files/file_bytes.h"
#include "formats/dense/dense_layout.h"
#include "formats/dense/dense_source.h"

namespace deltasplat {

/// Values stored consecutively in a file, plain or gzipped.
struct RawFile {
    std::filesystem::path path;
    RawLayout layout;  ///< one volume, after skipBytes unpacked bytes
    Packing packing = Packing::kNone;
    std::uint64_t packedStart = 0;                     ///< offset of the packed bytes
    std::shared_ptr<const FileBytes> bytes = nullptr;  ///< the file's, if already open
    bool mayGoOn = false;                              ///< whether bytes may follow the last value
    std::int64_t volumes = 1;  ///< consecutive, of this layout; at most 2^62 bytes together
    std::int64_t volume = 0;

    bool isPacked() const { return packing != Packing::kNone; }
    std::uint64_t dataBytes() const { return std::uint64_t(volumes) * layout.dataBytes(); }
    /// Offset of the volume's values, and the number of bytes of later volumes.
    std::uint64_t start() const {
        return layout.skipBytes + std::uint64_t(volume) * layout.dataBytes();
    }
    std::uint64_t laterBytes() const {
        return std::uint64_t(volumes - volume - 1) * layout.dataBytes();
    }
};

/// Checks the size of a file with all its volumes, as far as known before reading.
/// @throw Error(kInput) "<path>: got 500 bytes; expected 512 (8x8x8 uint8)"
void requireRawSize(const RawFile& file);

/// Returns a source for readDense; the caller sets the placement. Reads only the chosen volume of a
/// plain file. Unpacks also preceding ones of a packed file, and once the rest, to check the end.
DenseSource denseSourceOf(const RawFile& file);

/// Reports placement that the file lacks: options can restore some of it, the rest is lost.
/// @param lack     the missing part of the file
/// @param options  further options needed to read the file
void notePlace(const DenseLayout& layout, const std::string& lack, std::string options,
               WriteNotes& notes);

}  // namespace deltasplat
