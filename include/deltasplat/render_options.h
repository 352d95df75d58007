// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "deltasplat/image/picture_filter.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/splat/footprint.h"
#include "deltasplat/tolerance.h"
#include "deltasplat/view/camera.h"
#include "deltasplat/view/factorization.h"

namespace deltasplat {

/// Which voxels are stamped. All give the same pixels, bit for bit.
enum class Method {
    kAuto,        ///< `sparse` or `delta` for each slab, by what each would look at
    kDelta,       ///< every changed voxel
    kSparse,      ///< every visible voxel
    kTraditional  ///< every voxel of the bounding box (Westover 1990)
};

/// Returns "auto", "delta", "sparse" or "traditional".
std::string methodName(Method method);

/// What a pixel shows of the volume along its line of sight.
enum class Mode {
    kComposite,  ///< emission and absorption through the transfer function, by splatting
    kXray,       ///< the integral of the value
    kMip,        ///< the largest value
    kMin,        ///< the smallest value
    kAverage,    ///< the mean of the values of active voxels
    kDrr         ///< what x-rays let through of a CT scan: a digitally reconstructed radiograph
};

/// Returns "composite", "xray", "mip", "min", "average" or "drr".
std::string modeName(Mode mode);

/// How voxels are splatted.
struct SplatOptions {
    Method method = Method::kAuto;
    /// Footprint's deviation in voxels, kMinSigma..kMaxSigma; empty: hasOwnPixel, defaultSigma.
    std::optional<double> sigma;
    std::optional<double> resolution;  ///< as in factorize(); empty: by the screen, and between
    /// Slices put between two neighbouring ones, 0..kMostBetween, values mixed. If any, voxels have
    /// two sheet pixels unless resolution is given, and two values along u and v if their number is
    /// even. Empty: 1 where the screen asks for two sheet pixels a voxel (and neither resolution
    /// nor footprintWidth is given), but 0 where what is shown is thin (no opacity of the transfer
    /// function above 0.25 a voxel, extinction scale included), where colours jump or values are
    /// labels (TransferFunction::colorsJump), or, with a warning, where more than kMostDivided
    /// blocks of 8x8x8 voxels can be seen: each has one sheet pixel up to five of the screen. Where
    /// that is too coarse to see it, empty lets slices be drawn as one (mostJoined,
    /// RenderStats::joined), unless sigma, resolution or footprintWidth is given.
    std::optional<int> between;
    /// Whether a voxel that is divided stays whole where next to nothing of it would be seen in
    /// what it becomes: nothing vanishes, but what is a voxel thin looks larger than it is.
    bool keepsLone = false;
    Tolerance tolerance;  ///< how far what is shown of a voxel may be from what is true
    std::optional<int> footprintWidth;  ///< in sheet pixels; empty: 1 (hasOwnPixel) or by sigma
    PictureFilter filter = PictureFilter::kCatmullRom;
    /// How many slices may be drawn as one, a power of two, kMostJoined at most; from 16 on also
    /// voxels beside each other. More than 2 are joined anew for every direction, which is worth it
    /// for one camera, only in parallel projection, and of colours from 2^28 active voxels on.
    int mostJoined = 2;
};

/// How x-rays get through a CT scan of values in Hounsfield units: mu = muWater * (1 + HU / 1000),
/// at least 0, for each voxel.
struct Drr {
    /// Attenuation of water per world unit, > 0: of photons of 50 to 60 keV where that is 1 mm.
    double muWater = 0.022;
    std::optional<double> photons;  ///< that a pixel would get past nothing, > 0; empty: 1
};

/// What can be asked for. Under all modes but kComposite `splat`, extinction, unit distance and
/// colorBy have no effect; the transfer function has none but
/// for the colours of `mipColors`.
struct RenderOptions {
    SplatOptions splat;
    Mode mode = Mode::kComposite;
    /// kMip, kMin, kAverage: the transfer function's colour of the value, opaque, instead of the
    /// value itself.
    bool mipColors = false;
    /// kMip: how much darker the farthest place of the volume's box is shown than the nearest,
    /// 0..1. Values that are darker are nearer to the smallest of all, or 0 where that is less.
    double depthShade = 0;
    Drr drr;
    CameraOptions camera;
    Optics optics;
};

inline constexpr int kMostBetween = 7;
inline constexpr std::size_t kMostDivided = std::size_t{1} << 16;

/// What was done and how long it took. Times are wall-clock seconds.
struct RenderStats {
    Method method = Method::kAuto;
    Mode mode = Mode::kComposite;
    std::uint64_t voxels = 0;   ///< of the bounding box, those that they are divided into or joined
                                ///< to: what is counted below, too
    std::uint64_t visible = 0;  ///< whose classified colour is not zero; kXray, kDrr: active ones
                                ///< whose value, or mu, is not 0; kMip, kMin, kAverage: active
                                ///< ones; from an eye, of what may be seen
    std::uint64_t deltas =
        0;  ///< whose classified colour differs from the slice before, key slices included
    std::uint64_t stamps = 0;  ///< footprints added
    int slices = 0;            ///< those put between others among them; joined ones
    int between = 0;           ///< slices put between two neighbouring ones
    int joined = 1;            ///< slices that are drawn as one
    int parts = 1;             ///< voxels that each was divided into: those are what is counted
    int slabs = 0;
    int sliceAxis = 2;  ///< from an eye, of the region that sees most, which the counts are of
    double resolution = 1;
    int footprint = 0;            ///< width and height of the footprint in sheet pixels
    double prepareSeconds = 0;    ///< classification and taking differences
    double splatSeconds = 0;      ///< walking and stamping, its share of the wall time of all
                                  ///< slabs; other modes: following the lines of sight
    double compositeSeconds = 0;  ///< compositing and merging, likewise; kXray, kDrr: the footprint
    double warpSeconds = 0;
    double renderSeconds = 0;  ///< splat, composite, merge and warp
    Tolerance tolerance;
    /// Most that a pixel may differ from the exact picture's, but for floats' rounding: 0 without
    /// a tolerance, infinity where it is not known, as of joined slices (docs/method.md).
    double errorBoundColor = 0;
    double errorBoundAlpha = 0;
};

}  // namespace deltasplat
