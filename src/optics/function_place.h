// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// Tells at which place of a transfer function a data value lies.
class FunctionPlace {
  public:
    /// @param range  of a normalized one; empty: defaultRange of the volume
    FunctionPlace(const TransferFunction& function, const Volume& volume,
                  const std::optional<glm::dvec2>& range)
        : isNormalized_(function.normalized),
          range_(function.normalized ? range.value_or(defaultRange(volume)) : glm::dvec2(0, 1)) {}

    double operator()(double value) const {
        if (!isNormalized_) return value;
        return (0.5 * value - 0.5 * range_.x) / (0.5 * range_.y - 0.5 * range_.x);
    }

  private:
    bool isNormalized_;
    glm::dvec2 range_;
};

}  // namespace deltasplat
