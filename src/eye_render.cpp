// SPDX-License-Identifier: Apache-2.0
#include "eye_render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "parallel.h"
#include "ray_picture.h"
#include "rays/depth_shade.h"
#include "rays/eye_ray.h"
#include "shared_progress.h"
#include "stopwatch.h"
#include "view/affine.h"
#include "view/picture_rays.h"

namespace deltasplat {
namespace {

// Rays along each side of a pixel, at most.
constexpr int kMostRays = 8;

// What voxels that are not active are in bricks, where it matters whether any is.
constexpr float kNotActive = std::numeric_limits<float>::quiet_NaN();

RayRule eyeRule(Mode mode) {
    if (showsSums(mode)) return RayRule::kSum;
    if (mode == Mode::kAverage) return RayRule::kMean;
    return mode == Mode::kMin ? RayRule::kMaxActive : RayRule::kMax;
}

// What a ray finds: a sum in voxels' values times slices, or a value and how many slices away.
struct Found {
    double value = 0;
    double distance = 0;
    bool isMet = false;
};

struct SumFinder {
    Found found;
    void take(const SliceTaps& taps) { found.value += taps.share * double(taps.read()); }
    Found result() const { return found; }
};

// Calls use(value, weight) for the voxels of a reading that are active and count.
template <class Use>
void forActive(const SliceTaps& taps, const Use& use) {
    const auto offer = [&](float value, double weight) {
        if (weight > 0 && !std::isnan(value)) use(value, weight);
    };
    const double u = taps.u;
    const double v = taps.v;
    offer(taps.voxels.first, (1 - u) * (1 - v));
    offer(taps.voxels.nextV, (1 - u) * v);
    offer(taps.voxels.nextU, u * (1 - v));
    offer(taps.voxels.nextBoth, u * v);
}

bool isAllActive(const SliceTaps& taps) {
    const BrickTaps& four = taps.voxels;
    return !std::isnan(four.first + four.nextV + four.nextU + four.nextBoth);
}

// The mean of what is active of a reading, by the weights; false if nothing is.
bool meanOfActive(const SliceTaps& taps, double& mean) {
    double sum = 0;
    double weights = 0;
    forActive(taps, [&](float value, double weight) {
        sum += weight * double(value);
        weights += weight;
    });
    if (weights > 0) mean = sum / weights;
    return weights > 0;
}

// What is not active counts as `empty`, or not at all if that is NaN.
struct MaxFinder {
    float empty;
    Found found;

    void take(const SliceTaps& taps) {
        if (isAllActive(taps)) return offer(double(taps.read()), taps.distance);
        double mean = 0;
        if (!meanOfActive(taps, mean)) return;
        offer(std::isnan(empty) ? mean : double(readFilled(taps)), taps.distance);
    }
    float readFilled(SliceTaps taps) const {
        BrickTaps& four = taps.voxels;
        for (float* value : {&four.first, &four.nextV, &four.nextU, &four.nextBoth}) {
            if (std::isnan(*value)) *value = empty;
        }
        return taps.read();
    }
    // Of equal values the nearest is what is seen.
    void offer(double value, double distance) {
        if (!found.isMet || value > found.value) found = {value, distance, true};
    }
    Found result() const { return found; }
};

struct MeanFinder {
    double sum = 0;
    double weights = 0;

    void take(const SliceTaps& taps) {
        if (isAllActive(taps)) {
            sum += taps.share * double(taps.read());
            weights += taps.share;
            return;
        }
        forActive(taps, [&](float value, double weight) {
            sum += taps.share * weight * double(value);
            weights += taps.share * weight;
        });
    }
    Found result() const { return {weights > 0 ? sum / weights : 0, 0, weights > 0}; }
};

// The farthest that anything of the box is from the eye, and the nearest that is seen.
DepthShade shadeOf(const Volume& volume, const Camera& camera, double darker) {
    const bool panorama = camera.projection == Projection::kLatlong;
    DepthShade shade{darker, std::numeric_limits<double>::infinity(), 0};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(volume.box, corner), 1);
        const glm::dvec3 away = glm::dvec3(volume.worldFromIndex * index) - camera.eyeWorld();
        const double depth = panorama ? glm::length(away) : glm::dot(away, camera.direction);
        shade.nearest = std::min(shade.nearest, depth);
        shade.farthest = std::max(shade.farthest, depth);
    }
    // A face may be nearer to what sees all sides than its corners.
    shade.nearest = panorama ? camera.nearWorld : std::max(shade.nearest, camera.nearWorld);
    return shade;
}

// Rays along each side of a pixel: where voxels are smaller than pixels, so many that none is
// stepped over in the middle of the volume.
int raysPerSide(const Camera& camera, const Volume& volume) {
    const double pixels =
        factorizeRegions(camera, volume.box, volume.worldFromIndex, 1).front().pixelsPerVoxel;
    // Less than a tenth of a voxel too few does not matter.
    return pixels > 0 ? int(std::clamp(std::ceil(1 / pixels - 0.1), 1.0, double(kMostRays)))
                      : kMostRays;
}

Camera refined(Camera camera, int rays) {
    camera.sizePixels *= rays;
    return camera;
}

// All that the pixels of a picture have in common.
class EyePicture {
  public:
    EyePicture(const Volume& volume, const RenderOptions& options, const Camera& camera,
               const RayVolume& rays)
        : mode_(options.mode),
          camera_(camera),
          raysPerSide_(raysPerSide(camera, volume)),
          empty_(rays.empty),
          linear_(volume.worldFromIndex),
          rays_(refined(camera, raysPerSide_), glm::inverse(linear_)),
          bricks_(rays, showsSums(options.mode) ? 0 : kNotActive),
          painter_(volume, options, rays),
          shade_(shadeOf(volume, camera, options.mode == Mode::kMip ? options.depthShade : 0)) {
        box_ = {volume.box.min - bricks_.origin(), volume.box.max - bricks_.origin()};
        // From the first voxel, so that numbers stay small.
        const glm::dvec3 first(volume.worldFromIndex * glm::dvec4(bricks_.origin(), 1));
        eye_ = glm::inverse(linear_) * (camera.eyeWorld() - first);
    }

    void paintRow(int y, float* rgba) const {
        for (int x = 0; x < camera_.sizePixels.x; ++x, rgba += 4) paint({x, y}, rgba);
    }

  private:
    // The mean of what a pixel's rays find.
    void paint(glm::ivec2 pixel, float* rgba) const {
        double value = 0;
        double shade = 0;
        int met = 0;
        for (int j = 0; j < raysPerSide_; ++j) {
            for (int i = 0; i < raysPerSide_; ++i) {
                const Found found = find(raysPerSide_ * pixel + glm::ivec2(i, j), shade);
                value += found.value;
                met += found.isMet;
            }
        }
        const int count = raysPerSide_ * raysPerSide_;
        if (showsSums(mode_)) {
            std::fill_n(rgba, 4, float(value / count));
        } else if (2 * met >= count) {
            painter_.paint({float(value / met), float(shade / met), true}, rgba);
        }
    }

    // Follows a ray; adds the shade of a value that it finds.
    Found find(glm::ivec2 at, double& shade) const {
        const glm::dvec3 direction = rays_.at(at.x, at.y);
        EyeRay ray(eye_, direction);
        const glm::dvec3 perSlice =
            linear_ * (direction / std::abs(direction[ray.order[0]]));  // in the world
        const double length = glm::length(perSlice);
        const double depth = camera_.projection == Projection::kPerspective
                                 ? glm::dot(perSlice, camera_.direction)
                                 : length;
        ray.clip(camera_.nearWorld / depth, box_);
        if (showsSums(mode_)) {
            Found found = follow(ray, SumFinder());
            found.value *= length;
            return found;
        }
        if (mode_ == Mode::kAverage) {
            shade += 1;
            return follow(ray, MeanFinder());
        }
        const Found found = follow(ray, MaxFinder{empty_, {}});
        if (found.isMet) shade += shade_.at(depth * found.distance);
        return found;
    }

    template <class Finder>
    Found follow(const EyeRay& ray, Finder finder) const {
        followEyeRay(bricks_, ray, box_, [&](const SliceTaps& taps) { finder.take(taps); });
        return finder.result();
    }

    Mode mode_;
    const Camera& camera_;
    int raysPerSide_;
    float empty_;
    glm::dmat3 linear_;
    PictureRays rays_;
    RayBricks bricks_;
    ValuePainter painter_;
    DepthShade shade_;
    IndexBox box_;         // of voxels, in the bricks' positions
    glm::dvec3 eye_{0.0};  // likewise
};

}  // namespace

void renderFromEye(const Volume& volume, const RenderOptions& options, const Listener& listener,
                   RenderResult& result) {
    const Clock::time_point start = Clock::now();
    const RayVolume rays = makeRayVolume(volume, 0, eyeRule(options.mode), valueMapOf(options));
    const EyePicture picture(volume, options, result.camera, rays);
    RenderStats& stats = result.stats;
    stats.prepareSeconds = secondsSince(start);
    stats.visible = rays.visible;

    const Clock::time_point renderStart = Clock::now();
    Image& image = result.image;
    std::atomic<int> done = 0;
    SharedProgress progress(listener);
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        picture.paintRow(int(y), image.pixel(0, int(y)));
        progress.report(0.1 + 0.8 * ++done / image.size.y);
    });
    stats.footprint = 1;
    stats.splatSeconds = stats.renderSeconds = secondsSince(renderStart);
}

}  // namespace deltasplat
