// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

/// A slow, plain renderer in double precision that shares no code with the library: an independent
/// answer to what a picture ought to be. It knows neither sheets that are updated nor integers nor
/// shear and warp matrices; every formula is written out for one ray at a time.
namespace reference {

using Vector = std::array<double, 3>;
using Rgba = std::array<double, 4>;

/// What one voxel does to light.
struct Voxel {
    double extinction = 0;  ///< per world unit; infinity for opaque
    Vector color{};         ///< scene-linear, not premultiplied
};

struct Volume {
    std::array<int, 3> first{};  ///< index of the first voxel, may be negative
    std::array<int, 3> dims{};
    std::vector<Voxel> voxels;  ///< [z][y][x]
    /// World = axes[0] * i + axes[1] * j + axes[2] * k + origin, the centre of voxel (i, j, k).
    std::array<Vector, 3> axes{};
    Vector origin{};
};

/// An orthographic view; the three directions are orthonormal, right x up = -direction.
struct View {
    Vector direction{}, right{}, up{}, target{};
    double pixelWorld = 1;  ///< world units a pixel
    int width = 0, height = 0;
};

/// Premultiplied RGBA `[height][width]`, rows top to bottom.
using Picture = std::vector<Rgba>;

/// Follows the ray through every pixel's centre, slice by slice of the index axis most parallel to
/// it (ties: the later axis). In each slice the ray sees the weighted mean of the voxels, with the
/// weights of a Gaussian of covariance sigma^2 (I + d d^T) around the place where it goes through;
/// slices are composited with over.
Picture renderContinuous(const Volume& volume, const View& view, double sigma);

/// The same, but slices are seen through rasters of `resolution` samples a voxel, read bilinearly,
/// and composited at the samples of a raster on the plane of the first slice, through which the
/// picture is seen with a Catmull-Rom filter, along each axis clamped to the nearest two. The
/// picture must be at least as fine as the raster.
Picture renderSampled(const Volume& volume, const View& view, double sigma, int resolution);

}  // namespace reference
