// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deltasplat/image/pixel_box.h"
#include "deltasplat/render.h"
#include "optics/value_colors.h"
#include "rays/ray_volume.h"

namespace deltasplat {

/// What rays are followed through, for some pixels of a picture.
struct RayTask {
    const Volume& volume;  ///< not empty
    const RenderOptions& options;
    const Camera& camera;
    PixelBox part;            ///< what images are of
    IndexBox whole;           ///< of the volume, or of all that it is a group of
    bool keepsFound = false;  ///< as ValuePainter
};

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
    float weight = 1;    ///< of means: how much of active voxels has been met
};

/// Makes pixels of values, as colours or as numbers; or keeps in them what has been found, for
/// several to be put together.
class ValuePainter {
  public:
    /// @param rays  of which values are
    ValuePainter(const Volume& volume, const RenderOptions& options, const RayVolume& rays,
                 bool keepsFound = false);

    void paint(const FoundValue& found, float* rgba) const;
    /// Returns what a pixel has kept.
    static FoundValue keptIn(const float* rgba) { return {rgba[0], rgba[1], rgba[3] > 0, rgba[2]}; }

  private:
    float lowest_;
    float highest_;
    float darkest_;  // what shading leads to
    float sign_;
    bool keepsFound_;
    std::optional<ValueColors> colors_;
};

/// Turns integrals of mu, which all channels of a picture hold, into what x-rays leave.
void showTransmission(const Drr& drr, Image& image);

}  // namespace deltasplat
