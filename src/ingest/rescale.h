// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ingest/dense_source.h"

namespace deltasplat {

/// value = slope * stored + intercept
struct Rescale {
    double slope = 1;
    double intercept = 0;
    bool isIdentity() const { return slope == 1 && intercept == 0; }
};

/// Returns the type that holds rescaled values: float32 for what has at most 16 bits and for
/// float32, float64 for others.
RawType rescaledType(RawType type);

/// Rescales `count` values of `type` into `to`, in the processor's byte order, as `toType`: float32
/// or float64.
void rescaleValues(const std::byte* from, std::size_t count, RawType type, bool bigEndian,
                   const Rescale& rescale, RawType toType, std::byte* to);

/// Returns the source with its values rescaled; itself if the rescale is the identity.
DenseSource rescaled(DenseSource source, const Rescale& rescale);

}  // namespace deltasplat
