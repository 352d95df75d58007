// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ingest/dense/dense_source.h"

namespace deltasplat {

/// Reads as readDense, with unsigned integers as readCompared keeps them.
Volume readDenseUnsigned(const DenseSource& source, const ReadOptions& options,
                         const Listener& listener);

}  // namespace deltasplat
