// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ingest/dense/dense_source.h"
#include "ingest/files/input_kind.h"

namespace deltasplat {

/// Opens what is no .vdb, whatever it is, by its headers.
/// @param kind  as findInput returns it for `input`
/// @throw as readVolume
DenseSource openDense(const std::filesystem::path& input, const InputKind& kind,
                      const ReadOptions& options, const Listener& listener);

}  // namespace deltasplat
