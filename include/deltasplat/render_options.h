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

/// Which voxels are stamped. All methods give the same pixels, bit for bit.
enum class Method {
    kAuto,        ///< `sparse` or `delta` per slab, by the voxels that each would look at
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
    kDrr         ///< transmission of x-rays by a CT scan: a digitally reconstructed radiograph
};

/// Returns "composite", "xray", "mip", "min", "average" or "drr".
std::string modeName(Mode mode);

struct SplatOptions {
    Method method = Method::kAuto;
    /// Footprint's deviation in voxels, kMinSigma..kMaxSigma; empty: hasOwnPixel, defaultSigma.
    std::optional<double> sigma;
    std::optional<double> resolution;  ///< as in factorize(); empty: by the screen and `between`
    /// Slices of mixed values put between two neighbouring slices, 0..kMostBetween. If any, voxels
    /// have two sheet pixels unless resolution is given, and two values along u and v if the number
    /// is even. Empty: 1 where the screen asks for two sheet pixels per voxel and neither
    /// resolution nor footprintWidth is given. Exceptions with 0: thin volumes (no opacity of the
    /// transfer function above 0.25 per voxel, extinction scale included), jumping colours or
    /// labels (TransferFunction::colorsJump), and, with a warning, more than kMostDivided visible
    /// blocks of 8x8x8 voxels: voxels then have one sheet pixel up to five of the screen. Where the
    /// screen is too coarse to show it, empty lets slices be joined (mostJoined,
    /// RenderStats::joined), unless sigma, resolution or footprintWidth is given.
    std::optional<int> between;
    /// Whether a voxel stays whole where its parts would be almost invisible: nothing vanishes, but
    /// details one voxel thin look larger than they are.
    bool keepsLone = false;
    Tolerance tolerance;                ///< largest error of a voxel's look
    std::optional<int> footprintWidth;  ///< in sheet pixels; empty: 1 (hasOwnPixel) or by sigma
    PictureFilter filter = PictureFilter::kCatmullRom;
    /// Most slices drawn as one, a power of two up to kMostJoined; from 16 on neighbouring voxels
    /// too. More than 2 are joined anew per direction: worth it for one camera, only in parallel
    /// projection, with colours and from 2^28 active voxels on.
    int mostJoined = 2;
};

/// X-rays through a CT scan in Hounsfield units: mu = muWater * (1 + HU / 1000) >= 0 per voxel.
struct Drr {
    /// Attenuation of water per world unit, > 0; default: photons of 50 to 60 keV, per mm.
    double muWater = 0.022;
    std::optional<double> photons;  ///< that a pixel gets past an empty scene, > 0; empty: 1
};

/// Options of a picture. In modes other than kComposite `splat`, extinction, unit distance and
/// colorBy have no effect, and the transfer function only colours `mipColors`.
struct RenderOptions {
    SplatOptions splat;
    Mode mode = Mode::kComposite;
    /// kMip, kMin, kAverage: show the transfer function's colour, opaque, not the value itself.
    bool mipColors = false;
    /// kMip: how much darker the box's farthest place is shown than its nearest, 0..1. Darker
    /// values are nearer to the smallest of all, or to 0 if that is less.
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
    std::uint64_t voxels = 0;  ///< of the bounding box; all counts are of divided or joined voxels
    std::uint64_t visible =
        0;  ///< with a classified colour other than 0; kXray, kDrr: active, with a value, or mu,
            ///< other than 0; kMip, kMin, kAverage: active; from an eye: those in sight
    /// Voxels whose classified colour differs from the slice before, key slices included.
    std::uint64_t deltas = 0;
    std::uint64_t stamps = 0;  ///< footprints added
    int slices = 0;            ///< slices between others included; joined ones count once
    int between = 0;           ///< slices put between two neighbouring ones
    int joined = 1;            ///< slices drawn as one
    int parts = 1;             ///< voxels that each voxel was divided into
    int slabs = 0;
    int sliceAxis = 2;  ///< from an eye, as all counts: of the region that sees most
    double resolution = 1;
    int footprint = 0;
    double prepareSeconds = 0;    ///< classification and taking differences
    double splatSeconds = 0;      ///< walking and stamping, as share of all slabs' wall time; other
                                  ///< modes: following the lines of sight
    double compositeSeconds = 0;  ///< compositing and merging, likewise; kXray, kDrr: the footprint
    double warpSeconds = 0;
    double renderSeconds = 0;  ///< splat, composite, merge and warp
    Tolerance tolerance;
    /// Largest difference from the exact picture's pixels, but for floats' rounding: 0 without a
    /// tolerance, infinity if unknown, as for joined slices (docs/method.md).
    double errorBoundColor = 0;
    double errorBoundAlpha = 0;
};

}  // namespace deltasplat
