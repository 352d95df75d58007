// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ingest/dense_source.h"

namespace deltasplat {

/// Values that lie in a file one after the other, plain or under gzip.
struct RawFile {
    std::filesystem::path path;
    RawLayout layout;
    bool gzip = false;
    bool mayGoOn = false;  ///< whether bytes may follow the last value
};

/// Checks the size of a file as far as it is known before it is read.
/// @throw Error(kInput) "<path>: got 500 bytes; expected 512 (8x8x8 uint8)"
void requireRawSize(const RawFile& file);

/// Reads the layers of a file; what DenseSource::forEachLayer promises.
void readRawLayers(const RawFile& file, const DenseSource::LayerUse& use, const Listener& listener);

}  // namespace deltasplat
