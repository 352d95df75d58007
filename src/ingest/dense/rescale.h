// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ingest/dense/dense_source.h"

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

/// Returns the type of whole numbers that holds the values from `least` to `most` rescaled; nothing
/// if they become real or too large.
std::optional<RawType> rescaledWholeType(double least, double most, const Rescale& rescale);

/// Rescales `count` values of `type` into `to`, in the processor's byte order, as `toType`. What
/// whole numbers cannot hold goes to the nearest that they can.
void rescaleValues(const std::byte* from, std::size_t count, RawType type, bool bigEndian,
                   const Rescale& rescale, RawType toType, std::byte* to);

/// Returns the source with its values rescaled; itself if the rescale is the identity.
/// @param type  that they get; empty: rescaledType
DenseSource rescaled(DenseSource source, const Rescale& rescale, std::optional<RawType> type = {});

}  // namespace deltasplat
