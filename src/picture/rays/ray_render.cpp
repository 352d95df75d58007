// SPDX-License-Identifier: Apache-2.0
#include "picture/rays/ray_render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/render.h"
#include "deltasplat/threads.h"
#include "optics/value_colors.h"
#include "picture/far_groups.h"
#include "picture/render_views.h"
#include "rays/picture_lines.h"
#include "rays/ray_follower.h"
#include "rays/ray_volume.h"
#include "screen/clear_image.h"

namespace deltasplat {

namespace {

/// A volume and the pixels for which rays go through it.
struct RayTask {
    const Volume& volume;  ///< not empty
    const RenderOptions& options;
    const Camera& camera;
    PixelBox part;            ///< the part that images show
    IndexBox whole;           ///< of the whole volume, also for one of its groups
    bool keepsFound = false;  ///< as in ValuePainter
};

/// Checks the options of modes other than kComposite.
/// @throw Error(kUsage) naming the option
void checkRayOptions(const RenderOptions& options);

/// Returns a ray mode's map of values; the minimum is the maximum of negated values.
ValueMap valueMapOf(const RenderOptions& options);

/// Whether a mode shows sums along lines of sight; other modes show values, if there are any.
bool showsSums(Mode mode);

/// Warns of numbers beyond floats, radiographs of other than CT scans, and x-rays of CT scans.
/// @param slices     number of summed slices
/// @param stepWorld  length of the way through a slice
void warnOfValues(const Volume& volume, const RenderOptions& options, int slices, double stepWorld,
                  const Listener& listener);

/// The finding of a pixel that shows values.
struct FoundValue {
    float value = 0;     ///< mapped
    float shade = 1;     ///< see DepthShade
    bool isMet = false;  ///< whether there is a value
    float weight = 1;    ///< for means: amount of active voxels
};

/// Writes values to pixels as colours or numbers; or keeps findings there for merging.
class ValuePainter {
  public:
    /// @param rays  source of the values
    ValuePainter(const Volume& volume, const RenderOptions& options, const RayVolume& rays,
                 bool keepsFound = false);

    void paint(const FoundValue& found, float* rgba) const;
    /// Returns the finding kept in a pixel.
    static FoundValue keptIn(const float* rgba) { return {rgba[0], rgba[1], rgba[3] > 0, rgba[2]}; }

  private:
    float lowest_;
    float highest_;
    float darkest_;  // colour at full shade
    float sign_;
    bool keepsFound_;
    std::optional<ValueColors> colors_;
};

/// Turns integrals of mu, in all channels of a picture, into transmitted x-rays.
void showTransmission(const Drr& drr, Image& image);

void requirePositive(const char* option, double number) {
    if (std::isfinite(number) && number > 0) return;
    throw Error(ErrorCode::kUsage, option, numberText(number), "a finite number > 0");
}

// Warns if 32-bit floats, which rays use, do not suffice.
void warnOfFloats(const Volume& volume, const RenderOptions& options, int slices, double stepWorld,
                  const Listener& listener) {
    const ValueMap map = valueMapOf(options);
    const bool sums = showsSums(options.mode);
    const double largest =
        std::max(std::abs(map(volume.valueMin())), std::abs(map(volume.valueMax())));
    // Smaller numbers lose digits: 1e5 times the least float for 1e-5 of the largest value.
    constexpr double kSmallest = 1e5 * double(std::numeric_limits<float>::min());
    const std::string values = "values of up to " + numberText(largest);
    // Values are summed before the sum is multiplied by the step.
    const double step = sums ? stepWorld : 1;
    const double sum = largest * slices * std::max(step, 1.0);
    if (largest > kLargestRayValue) {
        listener.warn(values +
                      ": those beyond +-8.5e+37 are taken for that, as x-rays and largest "
                      "values are 32-bit floats");
    } else if (largest > 0 && largest * std::min(step, 1.0) < kSmallest) {
        listener.warn(values + " lose digits, or become 0, as 32-bit floats");
    }
    const bool adds = sums || options.mode == Mode::kAverage;
    if (adds && sum > double(std::numeric_limits<float>::max())) {
        listener.warn(values +
                      " may add up to more than a 32-bit float holds: pixels are wrong where they "
                      "do");
    }
}

// Attenuation is known for Hounsfield units only.
void warnOfOtherUnits(const Volume& volume, const Listener& listener) {
    if (isHounsfield(volume)) return;
    const std::string values =
        "values from " + numberText(volume.valueMin()) + " to " + numberText(volume.valueMax());
    listener.warn("`mode` drr: is for Hounsfield units (air -1000, water 0), which " + values +
                  (volume.space().empty()
                       ? " of a file that names no patient's space may not be"
                       : ", with hardly any air or hardly any soft tissue, seem not to be"));
}

// Integrals of Hounsfield units mean little: air counts less than the outside of the scan.
void warnOfHounsfield(const Volume& volume, const Listener& listener) {
    if (!isHounsfield(volume)) return;
    listener.warn(
        "`mode` xray: adds up Hounsfield units, where air is -1000 and what is outside of the scan "
        "counts as 0, as water does: the less a line of sight has of the scan, the brighter; "
        "`mode` drr makes radiographs");
}

void checkRayOptions(const RenderOptions& options) {
    requirePositive("`drr.muWater`", options.drr.muWater);
    if (options.drr.photons) requirePositive("`drr.photons`", *options.drr.photons);
    if (!(options.depthShade >= 0 && options.depthShade <= 1)) {
        throw Error(ErrorCode::kUsage, "`depthShade`", numberText(options.depthShade),
                    "a number from 0 to 1");
    }
}

ValueMap valueMapOf(const RenderOptions& options) {
    if (options.mode == Mode::kMin) return {.scale = -1};
    if (options.mode == Mode::kDrr) {
        const double mu = options.drr.muWater;
        return {.scale = mu / 1000, .offset = mu, .least = 0};
    }
    return {};
}

bool showsSums(Mode mode) {
    return mode == Mode::kXray || mode == Mode::kDrr;
}

void warnOfValues(const Volume& volume, const RenderOptions& options, int slices, double stepWorld,
                  const Listener& listener) {
    if (options.mode == Mode::kDrr) warnOfOtherUnits(volume, listener);
    if (options.mode == Mode::kXray) warnOfHounsfield(volume, listener);
    warnOfFloats(volume, options, slices, stepWorld, listener);
}

ValuePainter::ValuePainter(const Volume& volume, const RenderOptions& options,
                           const RayVolume& rays, bool keepsFound)
    : lowest_(rays.lowest),
      highest_(rays.highest),
      darkest_(std::min(rays.lowest, 0.0f)),
      sign_(options.mode == Mode::kMin ? -1.0f : 1.0f),
      keepsFound_(keepsFound) {
    if (options.mipColors) colors_.emplace(volume, options.optics);
}

void ValuePainter::paint(const FoundValue& found, float* rgba) const {
    rgba[3] = found.isMet ? 1.0f : 0.0f;
    if (!found.isMet) {
        std::fill_n(rgba, 3, 0.0f);
        return;
    }
    if (keepsFound_) {
        rgba[0] = found.value;
        rgba[1] = found.shade;
        rgba[2] = found.weight;
        return;
    }
    // Adding 0 avoids -0.
    const float value = sign_ * std::clamp(found.value, lowest_, highest_) + 0.0f;
    if (colors_) {
        const glm::vec3 color = found.shade * colors_->colorOf(value);
        for (int c = 0; c < 3; ++c) rgba[c] = color[c];
    } else {
        const bool isFull = found.shade == 1;
        std::fill_n(rgba, 3, isFull ? value : darkest_ + found.shade * (value - darkest_));
    }
}

void showTransmission(const Drr& drr, Image& image) {
    const double photons = drr.photons.value_or(1);
    parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
        float* rgba = image.pixel(0, int(y));
        for (int x = 0; x < image.size.x; ++x, rgba += 4) {
            std::fill_n(rgba, 3, float(photons * portable::exp(-double(rgba[0]))));
            rgba[3] = 1;
        }
    });
}

// Lines of sight per side of a tile. Values of eight slices for a tile stay in the second-level
// cache. Maxima and minima skip much, and more in small tiles.
int tileLines(Mode mode) {
    return mode == Mode::kMip || mode == Mode::kMin ? 32 : 64;
}

constexpr int kSquare = 8;

RayRule ruleOf(Mode mode) {
    if (showsSums(mode)) return RayRule::kSum;
    if (mode == Mode::kAverage) return RayRule::kMean;
    return mode == Mode::kMin ? RayRule::kMaxActive : RayRule::kMax;
}

// Range of distances: from the nearest visible place to the farthest corner of the box.
DepthShade shadeOf(const RayTask& task) {
    const Camera& camera = task.camera;
    const double darker = task.options.mode == Mode::kMip ? task.options.depthShade : 0;
    const bool panorama = camera.projection == Projection::kLatlong;
    DepthShade shade{darker, std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity()};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index(cornerOf(task.whole, corner), 1);
        const glm::dvec3 away =
            glm::dvec3(task.volume.worldFromIndex() * index) - camera.eyeWorld();
        const double depth = panorama ? glm::length(away) : glm::dot(away, camera.direction);
        shade.nearest = std::min(shade.nearest, depth);
        shade.farthest = std::max(shade.farthest, depth);
    }
    if (camera.projection == Projection::kOrtho) return shade;
    // A face may be nearer to a panorama's eye than its corners.
    shade.nearest = panorama ? camera.nearWorld : std::max(shade.nearest, camera.nearWorld);
    return shade;
}

std::size_t rowMajor(glm::ivec2 pixel, int width) {
    return std::size_t(pixel.y) * std::size_t(width) + std::size_t(pixel.x);
}

class RayPicture {
  public:
    RayPicture(const RayTask& task, const RayVolume& rays)
        : mode_(task.options.mode),
          rays_(rays),
          part_(task.part),
          lines_(task.volume, task.camera, countLines(task.volume, task.camera).perSide),
          cells_(lines_, rays, tileLines(mode_)),
          painter_(task.volume, task.options, rays, task.keepsFound),
          shade_(shadeOf(task)) {}

    // @param image  of the part
    void render(Image& image, const Listener& listener) const {
        const int pixels = std::max(1, tileLines(mode_) / lines_.perSide());
        const glm::ivec2 tiles = (image.size + pixels - 1) / pixels;
        const int count = tiles.x * tiles.y;
        std::atomic<int> next = 0;
        std::atomic<int> done = 0;
        SharedProgress progress(listener);
        parallelFor(std::size_t(std::min(threadCount(), count)), [&](std::size_t) {
            Tile tile{RayFollower(rays_, ruleOf(mode_)), {}, {}, {}, {}, {}};
            for (int i = next++; i < count; i = next++) {
                const glm::ivec2 first = pixels * glm::ivec2(i % tiles.x, i / tiles.x);
                paintTile(first, glm::min(first + pixels, image.size), tile, image);
                progress.report(0.1 + 0.8 * ++done / count);
            }
        });
    }

  private:
    // Sums over a pixel's lines of sight.
    struct PixelSum {
        double value = 0, shade = 0, weight = 0;
        std::int64_t met = 0;
    };

    struct Tile {
        RayFollower follower;
        std::vector<glm::ivec2> places;  // of lines
        std::vector<PictureLine> lines;
        std::vector<SightRay> rays;
        std::vector<RayFound> found;
        std::vector<PixelSum> sums;  // row by row
    };

    void paintTile(glm::ivec2 first, glm::ivec2 last, Tile& tile, Image& image) const {
        const int n = lines_.perSide();
        const glm::ivec2 pixels = last - first;
        tile.sums.assign(std::size_t(pixels.x) * std::size_t(pixels.y), {});
        const glm::ivec2 from = n * (part_.min + first), to = n * (part_.min + last);
        const PixelBox seen{glm::max(from, lines_.seen().min), glm::min(to, lines_.seen().max)};
        const int side = tileLines(mode_);
        // A pixel of many lines is processed in parts.
        for (int top = from.y + (seen.min.y - from.y) / side * side; top < seen.max.y;
             top += side) {
            for (int left = from.x + (seen.min.x - from.x) / side * side; left < seen.max.x;
                 left += side) {
                const glm::ivec2 begin(left, top);
                const PixelBox wanted{glm::max(begin, seen.min), glm::min(begin + side, seen.max)};
                if (!cells_.areUnknown()) {
                    const std::vector<std::uint32_t> blocks = cells_.blocksBehind(wanted);
                    if (blocks.empty()) continue;
                    tile.follower.lookAt(blocks);
                }
                follow(wanted, begin, tile);
                for (std::size_t i = 0; i < tile.lines.size(); ++i) {
                    const glm::ivec2 pixel = (tile.places[i] - from) / n;
                    addTo(tile.sums[rowMajor(pixel, pixels.x)], tile.found[i], tile.lines[i]);
                }
            }
        }
        for (int y = first.y; y < last.y; ++y) {
            for (int x = first.x; x < last.x; ++x) {
                const glm::ivec2 at = glm::ivec2(x, y) - first;
                paint(tile.sums[rowMajor(at, pixels.x)], image.pixel(x, y));
            }
        }
    }

    // Squares keep lines that are followed together close to each other.
    // @param begin  of the squares
    void follow(const PixelBox& wanted, glm::ivec2 begin, Tile& tile) const {
        tile.places.clear();
        tile.lines.clear();
        tile.rays.clear();
        for (int top = begin.y; top < wanted.max.y; top += kSquare) {
            for (int left = begin.x; left < wanted.max.x; left += kSquare) {
                const glm::ivec2 low = glm::max(wanted.min, glm::ivec2(left, top));
                const glm::ivec2 high = glm::min(wanted.max, glm::ivec2(left, top) + kSquare);
                for (int y = low.y; y < high.y; ++y) {
                    for (int x = low.x; x < high.x; ++x) {
                        tile.places.emplace_back(x, y);
                        tile.lines.push_back(lines_.at(x, y));
                        tile.rays.push_back(tile.lines.back().ray);
                    }
                }
            }
        }
        tile.found.resize(tile.rays.size());
        tile.follower.follow(tile.rays, tile.found);
    }

    void addTo(PixelSum& sum, const RayFound& found, const PictureLine& line) const {
        if (!found.isMet) return;
        sum.value += found.value * (showsSums(mode_) ? line.lengthWorld : 1);
        sum.shade += mode_ == Mode::kMip ? shade_.at(line.depthAt(found.slice)) : 1;
        sum.weight += found.weight;
        ++sum.met;
    }

    // Writes the mean over a pixel's lines of sight.
    void paint(const PixelSum& sum, float* rgba) const {
        const double all = double(lines_.perSide()) * lines_.perSide();
        const auto met = double(sum.met);
        if (showsSums(mode_)) {
            std::fill_n(rgba, 4, float(sum.value / all));
        } else if (2 * met >= all) {
            painter_.paint(
                {float(sum.value / met), float(sum.shade / met), true, float(sum.weight)}, rgba);
        }
    }

    Mode mode_;
    const RayVolume& rays_;
    PixelBox part_;
    PictureLines lines_;
    LineCells cells_;
    ValuePainter painter_;
    DepthShade shade_;
};

// @param image  of the task's part
void renderTask(const RayTask& task, const Listener& listener, Image& image, RenderStats& stats) {
    const Clock::time_point start = Clock::now();
    const RayRule rule = ruleOf(task.options.mode);
    const RayVolume rays = makeRayVolume(task.volume, rule, valueMapOf(task.options));
    const RayPicture picture(task, rays);
    stats.prepareSeconds += secondsSince(start);
    stats.visible = rays.visible;
    const Clock::time_point renderStart = Clock::now();
    picture.render(image, listener);
    const double seconds = secondsSince(renderStart);
    stats.splatSeconds += seconds;
    stats.renderSeconds += seconds;
}

// @param apart  distance of lines of sight in voxels
void warnOfLines(double apart, const Camera& camera, const Listener& listener) {
    constexpr double kHardlyApart = 1.5;
    if (apart <= kHardlyApart) return;
    listener.warn("picture: its pixels are so large that lines of sight are " +
                  numberText(std::round(apart)) +
                  " voxels apart, and may miss what is thinner; a larger `sizePixels`" +
                  (camera.projection == Projection::kOrtho ? " or a smaller `frameWidthWorld`"
                                                           : " or a nearer camera") +
                  " shows it");
}

bool isEmpty(const Image& image) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        if (image.rgba[i] != 0) return false;
    return true;
}

// Merges a group's findings into the picture.
// @param found  for a part of the picture
void putTogether(const Image& found, glm::ivec2 first, Mode mode, Image& all) {
    parallelFor(std::size_t(found.size.y), [&](std::size_t y) {
        const float* rgba = found.pixel(0, int(y));
        float* out = all.pixel(first.x, first.y + int(y));
        for (int x = 0; x < found.size.x; ++x, rgba += 4, out += 4) {
            if (showsSums(mode)) {
                for (int c = 0; c < 4; ++c) out[c] += rgba[c];
                continue;
            }
            FoundValue one = ValuePainter::keptIn(rgba);
            const FoundValue before = ValuePainter::keptIn(out);
            if (!one.isMet) continue;
            if (before.isMet && mode == Mode::kAverage) {
                one.value = (before.weight * before.value + one.weight * one.value) /
                            (before.weight + one.weight);
                one.weight += before.weight;
            } else if (before.isMet && before.value >= one.value) {
                continue;
            }
            out[0] = one.value;
            out[1] = one.shade;
            out[2] = one.weight;
            out[3] = 1;
        }
    });
}

// Widens a part to the tiles of a picture of the volume alone, because bits depend on tiles.
PixelBox wholeTiles(const PixelBox& part, const Volume& volume, const Camera& camera, Mode mode) {
    const int pixels = std::max(1, tileLines(mode) / countLines(volume, camera).perSide);
    return {part.min / pixels * pixels,
            glm::min((part.max + pixels - 1) / pixels * pixels, camera.sizePixels)};
}

// Follows rays through far groups one by one. Returns whether it warned of a picture of dots.
bool renderFar(const FarGroups& far, const RayTask& whole, const Listener& listener,
               RenderResult& result) {
    const std::vector<std::size_t> order = far.frontToBack(whole.camera);
    double apart = 1;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const FarGroups::Seen seen = far.seenBy(whole.camera, order[i]);
        if (showsSums(whole.options.mode) ? seen.part.empty() : seen.isNothing()) continue;
        const Volume volume = far.volume(order[i]);
        const PixelBox part = wholeTiles(seen.part, volume, whole.camera, whole.options.mode);
        Image image = clearImage(part.size());
        const double count = double(order.size());
        renderTask({volume, whole.options, whole.camera, part, whole.whole, true},
                   partOf(listener, double(i) / count, double(i + 1) / count), image, result.stats);
        apart = std::max(apart, countLines(volume, whole.camera).voxelsApart);
        putTogether(image, part.min, whole.options.mode, result.image);
    }
    const bool saysDots = far.warnOfDots(whole.camera, listener);
    if (!saysDots) warnOfLines(apart, whole.camera, listener);
    if (showsSums(whole.options.mode)) return saysDots;
    // The range of values is the whole volume's in any group.
    const Volume one = far.volume(0);
    const RayVolume rays = makeRayVolume(one, RayRule::kMax, valueMapOf(whole.options));
    const ValuePainter painter(whole.volume, whole.options, rays);
    parallelFor(std::size_t(result.image.size.y), [&](std::size_t y) {
        float* rgba = result.image.pixel(0, int(y));
        for (int x = 0; x < result.image.size.x; ++x, rgba += 4)
            painter.paint(ValuePainter::keptIn(rgba), rgba);
    });
    return saysDots;
}

}  // namespace

void renderRays(const Volume& volume, const RenderOptions& options, const Listener& listener,
                RenderResult& result) {
    checkRayOptions(options);
    const bool parallel = options.camera.projection == Projection::kOrtho;
    // For pictures from an eye, whose axis varies, the middle's.
    const Factorization view =
        factorize(result.camera, volume.worldFromIndex(),
                  parallel ? options.splat.resolution : std::optional<double>(1));
    result.stats.sliceAxis = view.sliceAxis;
    result.stats.slices = volume.box().dims()[view.sliceAxis];
    if (!volume.empty()) {
        const std::optional<FarGroups> far = FarGroups::find(volume);
        const RayTask whole{
            volume, options, result.camera, {{0, 0}, result.camera.sizePixels}, volume.box()};
        warnOfValues(volume, options, far ? 1 : result.stats.slices, view.sliceStepWorld, listener);
        bool saysDots = false;
        if (far) {
            saysDots = renderFar(*far, whole, listener, result);
        } else {
            warnOfLines(countLines(volume, result.camera).voxelsApart, result.camera, listener);
            renderTask(whole, listener, result.image, result.stats);
        }
        // Sums may be 0 though there are voxels.
        if (!showsSums(options.mode) && !saysDots && isEmpty(result.image))
            listener.warn(emptyPictureText(volume, "fills less than half of any pixel"));
    }
    if (options.mode == Mode::kDrr) showTransmission(options.drr, result.image);
}

}  // namespace deltasplat
