// SPDX-License-Identifier: Apache-2.0
#include "reference/reference_rays.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/formulas.h"

namespace reference {
namespace {

// A value on every point of a lattice around the volume, 0 beyond.
struct Lattice {
    std::array<int, 2> first{}, count{};
    std::vector<double> values;

    double at(int a, int b) const {
        a -= first[0];
        b -= first[1];
        if (a < 0 || b < 0 || a >= count[0] || b >= count[1]) return 0;
        return values[std::size_t(b) * count[0] + a];
    }
};

class Rays {
  public:
    Rays(const ValueVolume& volume, const View& view) : volume_(volume), view_(view) {
        const Vector ray = indexComponents(volume.axes, view.direction);
        for (int axis = 1; axis < 3; ++axis) {
            if (std::abs(ray[axis]) >= std::abs(ray[s_]) * (1 - 1e-9)) s_ = axis;
        }
        u_ = s_ == 0 ? 1 : 0;
        v_ = s_ == 2 ? 1 : 2;
        du_ = ray[u_] / ray[s_];
        dv_ = ray[v_] / ray[s_];
        step_ = 1 / std::abs(ray[s_]);
        bool any = false;
        for (std::size_t i = 0; i < volume.values.size(); ++i) {
            if (!volume.active[i]) continue;
            empty_ = any ? std::min(empty_, volume.values[i]) : volume.values[i];
            any = true;
        }
        empty_ = std::min(empty_, 0.0);
    }

    double step() const { return step_; }
    double du() const { return du_; }
    double dv() const { return dv_; }
    double empty() const { return empty_; }
    int slices() const { return volume_.dims[s_]; }

    // Whether voxel (i, j) of the n-th slice is active, and its value.
    bool voxel(int n, int i, int j, double& value) const {
        std::array<int, 3> at{};
        at[s_] = n;
        at[u_] = i - volume_.first[u_];
        at[v_] = j - volume_.first[v_];
        for (int k = 0; k < 3; ++k) {
            if (at[k] < 0 || at[k] >= volume_.dims[k]) return false;
        }
        const std::size_t place =
            (std::size_t(at[2]) * volume_.dims[1] + at[1]) * volume_.dims[0] + at[0];
        value = volume_.values[place];
        return volume_.active[place];
    }

    // Calls use(weight, value) for the active voxels of the n-th slice around the ray through
    // (a, b) of the first one, if they have any weight.
    template <typename Use>
    void forActive(int n, int a, int b, const Use& use) const {
        const double u = a + n * du_;
        const double v = b + n * dv_;
        for (int j = int(std::floor(v)); j <= int(std::floor(v)) + 1; ++j) {
            for (int i = int(std::floor(u)); i <= int(std::floor(u)) + 1; ++i) {
                const double weight = tent(u - i) * tent(v - j);
                double value;
                if (weight > 1e-12 && voxel(n, i, j, value)) use(weight, value);
            }
        }
    }

    // Reads the n-th slice where the ray through (a, b) of the first one meets it.
    bool read(int n, int a, int b, double empty, double& value) const {
        bool met = false;
        value = empty;
        forActive(n, a, b, [&](double weight, double one) {
            met = true;
            value += weight * (one - empty);
        });
        return met;
    }

    bool readActive(int n, int a, int b, double& value) const {
        double sum = 0;
        double weights = 0;
        forActive(n, a, b, [&](double weight, double one) {
            sum += weight * one;
            weights += weight;
        });
        value = sum / weights;
        return weights > 0;
    }

    Lattice lattice(const std::function<double(int a, int b)>& valueAt) const {
        Lattice lattice;
        const int reach = slices() + 8;
        lattice.first = {volume_.first[u_] - reach, volume_.first[v_] - reach};
        lattice.count = {volume_.dims[u_] + 2 * reach, volume_.dims[v_] + 2 * reach};
        for (int b = 0; b < lattice.count[1]; ++b) {
            for (int a = 0; a < lattice.count[0]; ++a)
                lattice.values.push_back(valueAt(lattice.first[0] + a, lattice.first[1] + b));
        }
        return lattice;
    }

    // What a pixel shows of a lattice on the first slice, through a filter that reaches three
    // points.
    template <typename Filter>
    double seen(const Lattice& lattice, int x, int y, const Filter& filter) const {
        const Vector index = indexOfPixel(view_, volume_.axes, volume_.origin, x, y);
        const double u = index[u_] + (volume_.first[s_] - index[s_]) * du_;
        const double v = index[v_] + (volume_.first[s_] - index[s_]) * dv_;
        double sum = 0;
        for (int j = int(std::floor(v)) - 2; j <= int(std::floor(v)) + 3; ++j) {
            for (int i = int(std::floor(u)) - 2; i <= int(std::floor(u)) + 3; ++i)
                sum += filter(u - i) * filter(v - j) * lattice.at(i, j);
        }
        return sum;
    }

  private:
    const ValueVolume& volume_;
    const View& view_;
    int s_ = 0, u_ = 0, v_ = 0;
    double du_ = 0, dv_ = 0, step_ = 0, empty_ = 0;
};

// Weighs a lattice's points with a Gaussian of covariance sigma^2 (I + d d^T).
double blurred(const Lattice& lattice, int a, int b, double du, double dv, double sigma) {
    const double determinant = 1 + du * du + dv * dv;
    const int reach = int(std::ceil(5 * sigma * std::sqrt(determinant)));
    double sum = 0;
    double weights = 0;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            const double q =
                ((1 + dv * dv) * x * x - 2 * du * dv * x * y + (1 + du * du) * y * y) / determinant;
            const double weight = std::exp(-0.5 * q / (sigma * sigma));
            weights += weight;
            sum += weight * lattice.at(a + x, b + y);
        }
    }
    return sum / weights;
}

}  // namespace

std::vector<Seen> lineIntegrals(const ValueVolume& volume, const View& view, double sigma) {
    const Rays rays(volume, view);
    const Lattice sums = rays.lattice([&](int a, int b) {
        double sum = 0;
        for (int n = 0; n < rays.slices(); ++n) {
            double value;
            rays.read(n, a, b, 0, value);
            sum += value * rays.step();
        }
        return sum;
    });
    const Lattice smooth = rays.lattice(
        [&](int a, int b) { return blurred(sums, a, b, rays.du(), rays.dv(), sigma); });
    std::vector<Seen> picture;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x)
            picture.push_back({rays.seen(smooth, x, y, quinticSpline), 0});
    }
    return picture;
}

namespace {

// What isMore() than all else of what read(n, a, b, value) gives of slices.
template <typename Read, typename IsMore>
std::vector<Seen> extremeValues(const Rays& rays, const View& view, const Read& read,
                                const IsMore& isMore) {
    const auto extreme = [&](int a, int b, double& found) {
        bool met = false;
        for (int n = 0; n < rays.slices(); ++n) {
            double value;
            if (!read(n, a, b, value)) continue;
            if (!met || isMore(value, found)) found = value;
            met = true;
        }
        return met;
    };
    const Lattice values = rays.lattice([&](int a, int b) {
        double found = 0;
        extreme(a, b, found);
        return found;
    });
    const Lattice met = rays.lattice([&](int a, int b) {
        double found;
        return extreme(a, b, found) ? 1.0 : 0.0;
    });
    std::vector<Seen> picture;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const double share = rays.seen(met, x, y, linear);
            picture.push_back({share >= 0.5 ? rays.seen(values, x, y, linear) / share : 0, share});
        }
    }
    return picture;
}

}  // namespace

std::vector<Seen> largestValues(const ValueVolume& volume, const View& view) {
    const Rays rays(volume, view);
    const auto read = [&](int n, int a, int b, double& value) {
        return rays.read(n, a, b, rays.empty(), value);
    };
    return extremeValues(rays, view, read, std::greater<>());
}

std::vector<Seen> smallestValues(const ValueVolume& volume, const View& view) {
    const Rays rays(volume, view);
    const auto read = [&](int n, int a, int b, double& value) {
        return rays.readActive(n, a, b, value);
    };
    return extremeValues(rays, view, read, std::less<>());
}

}  // namespace reference
