// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deltasplat/render.h"
#include "optics/value_colors.h"
#include "rays/ray_volume.h"

namespace deltasplat {

/// Checks what only modes other than kComposite are asked.
/// @throw Error(kUsage) naming the option
void checkRayOptions(const RenderOptions& options);

/// Returns what lines of sight meet of a value in a mode other than kComposite. The smallest of
/// values is the largest of what they are below 0.
ValueMap valueMapOf(const RenderOptions& options);

/// Whether a mode shows sums along the line of sight; the others show values, and whether there are
/// any.
bool showsSums(Mode mode);

/// Warns of what makes the picture another than who asked for it may think: numbers that 32-bit
/// floats do not hold, radiographs of what is no CT scan, and
/// x-rays of what is one.
/// @param slices     that are added up
/// @param stepWorld  length of the way through one
void warnOfValues(const Volume& volume, const RenderOptions& options, int slices, double stepWorld,
                  const Listener& listener);

/// What a pixel that shows values has found.
struct FoundValue {
    float value = 0;     ///< as mapped
    float shade = 1;     ///< as DepthShade
    bool isMet = false;  ///< whether there is a value
};

/// Makes pixels of values, as colours or as numbers.
class ValuePainter {
  public:
    /// @param rays  of which values are
    ValuePainter(const Volume& volume, const RenderOptions& options, const RayVolume& rays);

    void paint(const FoundValue& found, float* rgba) const;

  private:
    float lowest_;
    float highest_;
    float darkest_;  // what shading leads to
    float sign_;
    std::optional<ValueColors> colors_;
};

/// Turns integrals of mu, which all channels of a picture hold, into what x-rays leave.
void showTransmission(const Drr& drr, Image& image);

}  // namespace deltasplat
