// SPDX-License-Identifier: Apache-2.0
// Based on: L. Westover, Footprint Evaluation for Volume Rendering, 1990, with slices parallel to
// an index plane; T. Porter and T. Duff, Compositing Digital Images, 1984.
#include "reference/reference_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "reference/formulas.h"

namespace reference {
namespace {

// One volume seen along one direction: slices along axis `s`, the others are `u` and `v`.
class SliceView {
  public:
    SliceView(const Volume& volume, const View& view, double sigma)
        : volume_(volume), view_(view), sigma_(sigma) {
        const Vector ray = indexComponents(volume.axes, view.direction);
        for (int axis = 1; axis < 3; ++axis) {
            if (std::abs(ray[axis]) >= std::abs(ray[s_]) * (1 - 1e-9)) s_ = axis;
        }
        u_ = (s_ + 1) % 3;
        v_ = (s_ + 2) % 3;
        forward_ = ray[s_] > 0;
        du_ = ray[u_] / ray[s_];
        dv_ = ray[v_] / ray[s_];
        stepWorld_ = 1 / std::abs(ray[s_]);
    }

    int firstSlice() const { return volume_.first[s_]; }
    int sliceCount() const { return volume_.dims[s_]; }
    // The n-th slice that light comes from, counted from the camera.
    int sliceFromFront(int n) const { return firstSlice() + (forward_ ? n : sliceCount() - 1 - n); }

    // Where the ray of a pixel's centre goes through slice `slice`.
    std::array<double, 2> crossing(int x, int y, double slice) const {
        const Vector index = indexOfPixel(view_, volume_.axes, volume_.origin, x, y);
        return slid({index[u_], index[v_]}, slice - index[s_]);
    }

    // Follows the ray through (u, v) by a number of slices.
    std::array<double, 2> slid(const std::array<double, 2>& p, double slices) const {
        return {p[0] + slices * du_, p[1] + slices * dv_};
    }

    // What is seen of slice `slice` at (u, v): voxels weighted by the Gaussian, whose sum over all
    // places of the lattice, voxels or not, is made 1.
    Rgba seenAt(int slice, double u, double v) const {
        const int reach = int(std::ceil(reachVoxels()));
        Rgba sum{};
        double weights = 0;
        for (int j = int(std::floor(v)) - reach; j <= int(std::floor(v)) + reach + 1; ++j) {
            for (int i = int(std::floor(u)) - reach; i <= int(std::floor(u)) + reach + 1; ++i) {
                const double weight = gaussian(u - i, v - j);
                weights += weight;
                const Rgba rgba = classified(slice, i, j);
                for (int c = 0; c < 4; ++c) sum[c] += weight * rgba[c];
            }
        }
        for (double& value : sum) value /= weights;
        return sum;
    }

    // Beyond five standard deviations nothing is left.
    double reachVoxels() const { return 5 * sigma_ * std::sqrt(1 + du_ * du_ + dv_ * dv_); }

    int first(int k) const { return volume_.first[k == 0 ? u_ : v_]; }
    int count(int k) const { return volume_.dims[k == 0 ? u_ : v_]; }

  private:
    // exp(-q/2), q the square of the distance by the inverse of sigma^2 (I + d d^T), written out.
    double gaussian(double x, double y) const {
        const double a = 1 + du_ * du_;
        const double b = du_ * dv_;
        const double c = 1 + dv_ * dv_;
        const double q = (c * x * x - 2 * b * x * y + a * y * y) / (a * c - b * b);
        return std::exp(-0.5 * q / (sigma_ * sigma_));
    }

    Rgba classified(int slice, int i, int j) const {
        std::array<int, 3> at{};
        at[s_] = slice - volume_.first[s_];
        at[u_] = i - volume_.first[u_];
        at[v_] = j - volume_.first[v_];
        for (int k = 0; k < 3; ++k) {
            if (at[k] < 0 || at[k] >= volume_.dims[k]) return {};
        }
        const std::size_t place =
            (std::size_t(at[2]) * volume_.dims[1] + at[1]) * volume_.dims[0] + at[0];
        const Voxel& voxel = volume_.voxels[place];
        const double alpha = 1 - std::exp(-voxel.extinction * stepWorld_);
        return {alpha * voxel.color[0], alpha * voxel.color[1], alpha * voxel.color[2], alpha};
    }

    const Volume& volume_;
    const View& view_;
    double sigma_;
    int s_ = 0, u_ = 0, v_ = 0;
    bool forward_ = true;
    double du_ = 0, dv_ = 0;  // what u and v gain along the ray from one slice index to the next
    double stepWorld_ = 0;
};

void putBehind(Rgba& front, const Rgba& back) {
    const double left = 1 - front[3];
    for (int c = 0; c < 4; ++c) front[c] += left * back[c];
}

// Samples at (a, b) / resolution, for a and b from `first` on.
struct Samples {
    std::array<int, 2> first{}, count{};
    std::vector<Rgba> values;

    Samples(std::array<int, 2> low, std::array<int, 2> high)
        : first(low), count{high[0] - low[0] + 1, high[1] - low[1] + 1} {
        values.resize(std::size_t(count[0]) * count[1]);
    }
    Rgba at(int a, int b) const {
        const int i = a - first[0];
        const int j = b - first[1];
        if (i < 0 || j < 0 || i >= count[0] || j >= count[1]) return {};
        return values[std::size_t(j) * count[0] + i];
    }
    Rgba& at(int a, int b) { return values[std::size_t(b - first[1]) * count[0] + (a - first[0])]; }
};

// Sums samples around a place with weights kernel(distance) along both directions.
template <typename Kernel>
Rgba filtered(const Samples& samples, double a, double b, int reach, const Kernel& kernel) {
    const int a0 = int(std::floor(a));
    const int b0 = int(std::floor(b));
    Rgba sum{};
    for (int j = b0 - reach + 1; j <= b0 + reach; ++j) {
        for (int i = a0 - reach + 1; i <= a0 + reach; ++i) {
            const double weight = kernel(a - i) * kernel(b - j);
            const Rgba value = samples.at(i, j);
            for (int c = 0; c < 4; ++c) sum[c] += weight * value[c];
        }
    }
    return sum;
}

Samples sampledSlice(const SliceView& slices, int slice, int resolution) {
    std::array<int, 2> low{}, high{};
    for (int k = 0; k < 2; ++k) {
        const int margin = int(std::ceil(slices.reachVoxels())) + 1;
        low[k] = (slices.first(k) - margin) * resolution;
        high[k] = (slices.first(k) + slices.count(k) - 1 + margin) * resolution;
    }
    Samples samples(low, high);
    for (int b = low[1]; b <= high[1]; ++b) {
        for (int a = low[0]; a <= high[0]; ++a) {
            samples.at(a, b) = slices.seenAt(slice, double(a) / resolution, double(b) / resolution);
        }
    }
    return samples;
}

// Composites all slices at the samples of the plane of the first slice that any of them reaches.
Samples compositedPlane(const SliceView& slices, int resolution) {
    std::vector<Samples> sheets;
    std::array<int, 2> low{1 << 30, 1 << 30}, high{-(1 << 30), -(1 << 30)};
    for (int n = 0; n < slices.sliceCount(); ++n) {
        const int slice = slices.sliceFromFront(n);
        sheets.push_back(sampledSlice(slices, slice, resolution));
        const std::array<double, 2> moved = slices.slid({0, 0}, slices.firstSlice() - slice);
        for (int k = 0; k < 2; ++k) {
            const double first = sheets.back().first[k] + resolution * moved[k];
            low[k] = std::min(low[k], int(std::floor(first)));
            high[k] = std::max(high[k], int(std::ceil(first)) + sheets.back().count[k]);
        }
    }
    Samples plane(low, high);
    for (int b = low[1]; b <= high[1]; ++b) {
        for (int a = low[0]; a <= high[0]; ++a) {
            for (int n = 0; n < slices.sliceCount(); ++n) {
                const std::array<double, 2> moved =
                    slices.slid({0, 0}, slices.sliceFromFront(n) - slices.firstSlice());
                putBehind(plane.at(a, b), filtered(sheets[n], a + resolution * moved[0],
                                                   b + resolution * moved[1], 1, tent));
            }
        }
    }
    return plane;
}

// Four values through a Catmull-Rom filter, no farther than the middle two.
double between(const std::array<double, 4>& values, double share) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += catmullRom(share - (i - 1)) * values[std::size_t(i)];
    return std::clamp(sum, std::min(values[1], values[2]), std::max(values[1], values[2]));
}

// Reads samples along their first axis, then along their second.
Rgba sharplySeen(const Samples& plane, double a, double b) {
    const int i = int(std::floor(a));
    const int j = int(std::floor(b));
    Rgba seen{};
    for (std::size_t c = 0; c < 4; ++c) {
        std::array<double, 4> across{};
        for (int l = 0; l < 4; ++l) {
            std::array<double, 4> along{};
            for (int k = 0; k < 4; ++k) along[std::size_t(k)] = plane.at(i - 1 + k, j - 1 + l)[c];
            across[std::size_t(l)] = between(along, a - i);
        }
        seen[c] = between(across, b - j);
    }
    return seen;
}

}  // namespace

Picture renderContinuous(const Volume& volume, const View& view, double sigma) {
    const SliceView slices(volume, view, sigma);
    Picture picture(std::size_t(view.width) * view.height);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            Rgba& pixel = picture[std::size_t(y) * view.width + x];
            for (int n = 0; n < slices.sliceCount(); ++n) {
                const int slice = slices.sliceFromFront(n);
                const std::array<double, 2> p = slices.crossing(x, y, slice);
                putBehind(pixel, slices.seenAt(slice, p[0], p[1]));
            }
        }
    }
    return picture;
}

Picture renderSampled(const Volume& volume, const View& view, double sigma, int resolution) {
    const SliceView slices(volume, view, sigma);
    const Samples plane = compositedPlane(slices, resolution);
    Picture picture(std::size_t(view.width) * view.height);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const std::array<double, 2> p = slices.crossing(x, y, slices.firstSlice());
            picture[std::size_t(y) * view.width + x] =
                sharplySeen(plane, p[0] * resolution, p[1] * resolution);
        }
    }
    return picture;
}

}  // namespace reference
