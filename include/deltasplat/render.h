// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "deltasplat/delta/tolerance.h"
#include "deltasplat/image/image.h"
#include "deltasplat/ingest/volume.h"
#include "deltasplat/optics/class_table.h"
#include "deltasplat/progress.h"
#include "deltasplat/splat/footprint.h"
#include "deltasplat/view/camera.h"
#include "deltasplat/view/factorization.h"

namespace deltasplat {

/// Which voxels are stamped. All give the same pixels, bit for bit.
enum class Method {
    kAuto,        ///< `sparse` or `delta` for each slab, by the stamps each would need
    kDelta,       ///< every changed voxel
    kSparse,      ///< every visible voxel
    kTraditional  ///< every voxel of the bounding box (Westover 1990)
};

/// Returns "auto", "delta", "sparse" or "traditional".
std::string methodName(Method method);

struct RenderOptions {
    Method method = Method::kAuto;
    CameraOptions camera;
    Optics optics;
    /// Footprint's standard deviation in voxels, kMinSigma..kMaxSigma; empty: defaultSigma.
    std::optional<double> sigma;
    std::optional<int> resolution;  ///< sheet pixels a voxel; empty: chosen from the screen
    Tolerance tolerance;            ///< how far what is shown of a voxel may be from what is true
    std::optional<int> footprintWidth;  ///< in sheet pixels; empty: as wide as sigma asks for
};

/// What was done and how long it took. Times are wall-clock seconds.
struct RenderStats {
    Method method = Method::kAuto;
    std::uint64_t voxels = 0;   ///< of the bounding box
    std::uint64_t visible = 0;  ///< whose classified colour is not zero
    std::uint64_t deltas =
        0;  ///< whose classified colour differs from the slice before, key slices included
    std::uint64_t stamps = 0;  ///< footprints added
    int slices = 0;
    int slabs = 0;
    int sliceAxis = 2;
    int resolution = 1;
    int footprint = 0;            ///< width and height of the footprint in sheet pixels
    double prepareSeconds = 0;    ///< classification and taking differences
    double splatSeconds = 0;      ///< walking and stamping, its share of the wall time of all slabs
    double compositeSeconds = 0;  ///< compositing and merging, likewise
    double warpSeconds = 0;
    double renderSeconds = 0;  ///< splat, composite, merge and warp
    Tolerance tolerance;
    /// Most that a pixel may differ from the exact picture's, but for the rounding of floats
    /// (docs/method.md): 0 without a tolerance, infinity where it is not known.
    double errorBoundColor = 0;
    double errorBoundAlpha = 0;
};

struct RenderResult {
    Image image;
    Camera camera;
    RenderStats stats;
};

/// Renders one picture. The same volume and options give the same pixels, bit for bit, for every
/// method, thread count and SIMD level. An empty volume gives a transparent picture.
/// @throw Error(kUsage) for options out of range, or a picture that does not fit this machine's
/// memory;
///        whatever `listener.progress` throws
RenderResult render(const Volume& volume, const RenderOptions& options,
                    const Listener& listener = {});

}  // namespace deltasplat
