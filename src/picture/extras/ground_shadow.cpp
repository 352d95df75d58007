// SPDX-License-Identifier: Apache-2.0
// Based on: Lance Williams, "Casting Curved Shadows on Curved Surfaces", 1978 (a picture from the
// light shows what is lit). Transmittance replaces depths, because all fog lies before the plane.
#include "picture/extras/ground_shadow.h"
#include "volume/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/ground_shadow.h"
#include "deltasplat/prepared_scene.h"
#include "image/srgb.h"
#include "picture/far_groups.h"

namespace deltasplat {

namespace {

// Pixels per side.
constexpr double kMostAcross = 2048;
constexpr double kLeastAcross = 4;
// Distance in radii from which a point's light counts as parallel: it spreads by 1/10000.
constexpr double kFar = 1e4;
// Sine of half the view angle beyond which flat pictures are stretched too much: 50 degrees.
constexpr double kWide = 0.766;

// Returns the camera's axis least parallel to a direction, made perpendicular to it.
glm::dvec3 upOf(const glm::dvec3& direction, const Camera& axes) {
    glm::dvec3 best = axes.up;
    for (const glm::dvec3& axis : {axes.right, axes.direction})
        if (std::abs(glm::dot(axis, direction)) < 0.5 * std::abs(glm::dot(best, direction)))
            best = axis;
    return glm::normalize(best - glm::dot(best, direction) * direction);
}

// Half the extent of the box along an axis.
double reachAlong(const SeenBall& ball, const glm::dvec3& axis) {
    double reach = 0;
    for (const glm::dvec3& edge : ball.halfEdges) reach += std::abs(glm::dot(edge, axis));
    return reach;
}

}  // namespace

SeenBall::SeenBall(const Volume& volume) : voxel(smallestSize(volume)) {
    // Half of the last voxel, and the reach of its footprint.
    constexpr double kBeyond = 1.5;
    const glm::dvec3 low(volume.box().min);
    const glm::dvec3 high(volume.box().max);
    middle = glm::dvec3(volume.worldFromIndex() * glm::dvec4(0.5 * (low + high), 1));
    radius = 0;
    for (int axis = 0; axis < 3; ++axis) {
        halfEdges[axis] =
            (0.5 * (high[axis] - low[axis]) + kBeyond) * glm::dvec3(volume.worldFromIndex()[axis]);
    }
    for (const double u : {-1.0, 1.0}) {
        for (const double v : {-1.0, 1.0})
            radius =
                std::max(radius, glm::length(halfEdges[0] + u * halfEdges[1] + v * halfEdges[2]));
    }
}

LightCamera::LightCamera(const Light& light, const SeenBall& ball, const Camera& axes)
    : ball_(ball) {
    camera_.direction = light.direction;
    if (light.positionWorld) {
        const glm::dvec3 away = ball.middle - *light.positionWorld;
        distance_ = glm::length(away);
        camera_.direction = distance_ > 0 ? away : -axes.up;
        if (distance_ < kFar * ball.radius) eye_ = light.positionWorld;
    }
    camera_.direction = unitVectorOf(camera_.direction);
    camera_.up = upOf(camera_.direction, axes);
    camera_.right = glm::cross(camera_.direction, camera_.up);
    camera_.targetWorld = ball.middle;
    if (!eye_) return;
    if (distance_ * kWide > ball.radius) {
        camera_.projection = Projection::kPerspective;
        camera_.targetDistanceWorld = distance_;
        return;
    }
    camera_.projection = Projection::kLatlong;
    distance_ = std::max(distance_, 0.5 * ball.radius);
    camera_.targetWorld = *eye_ + distance_ * camera_.direction;
    camera_.targetDistanceWorld = distance_;
}

double LightCamera::growthAt(const glm::dvec3& world) const {
    return eye_ ? glm::distance(*eye_, world) / distance_ : 1;
}

Camera LightCamera::of(double pixelWorld) const {
    Camera camera = camera_;
    if (camera.projection == Projection::kLatlong) {
        const double around = 2 * std::numbers::pi * distance_;
        const double rows =
            std::ceil(std::clamp(0.5 * around / pixelWorld, kLeastAcross, 0.5 * kMostAcross));
        camera.sizePixels = {2 * int(rows), int(rows)};
        camera.frameWidthWorld = around;
        return camera;
    }
    glm::dvec2 frame(2 * reachAlong(ball_, camera.right), 2 * reachAlong(ball_, camera.up));
    if (camera.projection == Projection::kPerspective) {
        // Frame of a cone around the ball.
        const double sine = ball_.radius / distance_;
        frame = glm::dvec2(2 * ball_.radius / std::sqrt(1 - sine * sine));
    }
    const double pixel = std::max(pixelWorld, std::max(frame.x, frame.y) / kMostAcross);
    const glm::dvec2 pixels = glm::clamp(glm::ceil(frame / pixel), kLeastAcross, kMostAcross);
    camera.sizePixels = glm::ivec2(pixels);
    camera.frameWidthWorld = pixel * pixels.x;
    return camera;
}

double alphaAt(const Image& image, const Camera& camera, const glm::dvec3& world) {
    const bool isRound = camera.projection == Projection::kLatlong;
    if (camera.projection == Projection::kPerspective &&
        !(glm::dot(world - camera.eyeWorld(), camera.direction) > 0))
        return 0;
    const glm::dvec2 place = camera.pixelFromWorld(world) - 0.5;
    const glm::dvec2 size(image.size);
    if (!(place.x > -1 && place.y > -1 && place.x < size.x && place.y < size.y)) return 0;
    const glm::dvec2 first = glm::floor(place);
    const glm::dvec2 share = place - first;
    const auto readAt = [&](int x, int y) -> double {
        if (isRound) {
            x = (x + image.size.x) % image.size.x;
            y = std::clamp(y, 0, image.size.y - 1);
        }
        const bool isIn = x >= 0 && y >= 0 && x < image.size.x && y < image.size.y;
        return isIn ? image.pixel(x, y)[3] : 0;
    };
    const glm::ivec2 at(first);
    const auto rowAt = [&](int y) {
        return (1 - share.x) * readAt(at.x, y) + share.x * readAt(at.x + 1, y);
    };
    return (1 - share.y) * rowAt(at.y) + share.y * rowAt(at.y + 1);
}

namespace {

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "`ground`", got, expected);
}

void check(const Ground& ground, const RenderOptions& options) {
    if (options.mode != Mode::kComposite)
        refuse("`mode` " + modeName(options.mode), "`mode` composite");
    if (!options.optics.scattering)
        refuse("what shines by itself", "`scattering`, whose lights throw shadows");
    const glm::dvec3& n = ground.normalWorld;
    const glm::dvec3& p = ground.pointWorld;
    if (std::isfinite(n.x + n.y + n.z + p.x + p.y + p.z) && n != glm::dvec3(0)) return;
    refuse("point " + numberText(p) + " and normal " + numberText(n),
           "finite numbers, and a normal other than 0,0,0");
}

// The place of the plane that a pixel sees.
struct SeenPlace {
    glm::dvec3 world{0.0};
    double pixelWorld = 0;  // of the pixel, across the line of sight; 0: the plane is not seen
};

class SeenGround {
  public:
    SeenGround(const Camera& camera, const glm::dvec3& point, const glm::dvec3& normal)
        : camera_(camera),
          point_(point),
          normal_(normal),
          places_(std::size_t(camera.sizePixels.x) * std::size_t(camera.sizePixels.y)) {
        forRows([&](std::size_t first, int y) {
            for (int x = 0; x < camera_.sizePixels.x; ++x)
                places_[first + std::size_t(x)] = placeAt({x + 0.5, y + 0.5});
        });
    }

    const std::vector<SeenPlace>& places() const { return places_; }
    bool isSeen() const {
        return std::any_of(places_.begin(), places_.end(),
                           [](const SeenPlace& place) { return place.pixelWorld > 0; });
    }

    // Calls use(number of a row's first pixel, row) for all rows.
    template <typename Use>
    void forRows(const Use& use) const {
        parallelFor(std::size_t(camera_.sizePixels.y),
                    [&](std::size_t y) { use(y * std::size_t(camera_.sizePixels.x), int(y)); });
    }

    // Smallest pixel needed in a light's picture, at the middle of the volume.
    double finestPixel(const LightCamera& light) const {
        std::vector<double> ofRows(std::size_t(camera_.sizePixels.y),
                                   std::numeric_limits<double>::infinity());
        forRows([&](std::size_t first, int y) {
            double& least = ofRows[std::size_t(y)];
            for (int x = 0; x < camera_.sizePixels.x; ++x) {
                const SeenPlace& place = places_[first + std::size_t(x)];
                if (place.pixelWorld > 0)
                    least = std::min(least, place.pixelWorld / light.growthAt(place.world));
            }
        });
        return *std::min_element(ofRows.begin(), ofRows.end());
    }

  private:
    SeenPlace placeAt(const glm::dvec2& pixel) const {
        const bool isParallel = camera_.projection == Projection::kOrtho;
        const glm::dvec3 start = isParallel ? camera_.worldFromPixel(pixel) : camera_.eyeWorld();
        const glm::dvec3 ray = camera_.rayThrough(pixel);
        const double down = -glm::dot(ray, normal_);
        if (!(down > 0)) return {};
        const double t = glm::dot(start - point_, normal_) / down;
        const SeenPlace place{start + t * ray, pixelAt(t)};
        const bool isNumber = std::isfinite(place.world.x + place.world.y + place.world.z);
        if (isParallel || !isNumber) return isNumber ? place : SeenPlace{};
        const double depth =
            camera_.projection == Projection::kLatlong ? t : t * camera_.targetDistanceWorld;
        return t > 0 && depth >= camera_.nearWorld ? place : SeenPlace{};
    }

    // Size of a pixel at a distance in ray lengths.
    double pixelAt(double rays) const {
        if (camera_.projection == Projection::kLatlong)
            return rays * 2 * std::numbers::pi / camera_.sizePixels.x;
        const double pixel = std::min(camera_.pixelWorld(), camera_.pixelHeightWorld());
        return pixel * (camera_.projection == Projection::kOrtho ? 1 : rays);
    }

    const Camera& camera_;
    glm::dvec3 point_;
    glm::dvec3 normal_;
    std::vector<SeenPlace> places_;  // [height][width]
};

// Irradiance of a place of a plane; 0 if the light comes from below.
glm::dvec3 irradianceAt(const Light& light, const glm::dvec3& world, const glm::dvec3& normal) {
    const glm::dvec3 color = light.strength * light.color;
    if (!light.positionWorld)
        return color * std::max(0.0, glm::dot(-unitVectorOf(light.direction), normal));
    const glm::dvec3 away = *light.positionWorld - world;
    const double above = glm::dot(away, normal);
    if (!(above > 0)) return glm::dvec3(0);
    const double distance = glm::length(away);
    const double least = std::max(distance, light.radiusWorld);
    return color / least / least * (above / distance);
}

bool isAbove(const Light& light, const Ground& ground) {
    const glm::dvec3 color = light.strength * light.color;
    if (!(std::max({color.r, color.g, color.b}) > 0)) return false;
    const glm::dvec3 towards =
        light.positionWorld ? *light.positionWorld - ground.pointWorld : -light.direction;
    return glm::dot(towards, ground.normalWorld) > 0;
}

// Heights of the lowest and the highest voxel centre above the plane, in the world.
glm::dvec2 heightsOf(const Volume& volume, const glm::dvec3& point, const glm::dvec3& normal) {
    glm::dvec2 heights(std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity());
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 world(volume.worldFromIndex() *
                               glm::dvec4(cornerOf(volume.box(), corner), 1));
        const double height = glm::dot(world - point, normal);
        heights = {std::min(heights.x, height), std::max(heights.y, height)};
    }
    return heights;
}

// Returns the part of the volume above the plane; null if there is none.
std::shared_ptr<const Volume> volumeAbove(const Volume& volume, const Ground& ground,
                                          const glm::dvec3& normal, const Listener& listener) {
    const std::shared_ptr<const Volume> all(std::shared_ptr<const Volume>(), &volume);
    if (volume.empty()) return {};
    constexpr double kSlack = 1e-6;  // in voxels, like the tolerance of cuts
    const double slack = kSlack * smallestSize(volume);
    const glm::dvec2 heights = heightsOf(volume, ground.pointWorld, normal);
    if (heights.x >= -slack) return all;
    const bool isBelow = heights.y < -slack;
    listener.warn("`ground`: the volume's box reaches " + numberText(-heights.x) + " below it" +
                  (isBelow ? ", all of it" : "") +
                  "; what lies there is seen as if there were no ground, and throws no shadow");
    if (isBelow) return {};
    Cut cut;
    cut.clipPlanes = {{ground.pointWorld, ground.normalWorld}};
    try {
        return std::make_shared<const Volume>(cutVolume(volume, cut));
    } catch (const Error& error) {
        if (error.code() != ErrorCode::kUsage) throw;
        return {};  // nothing is active above
    }
}

// White optics of the same opacity.
Optics hidingOptics(const Volume& volume, Optics optics) {
    if (!optics.range) optics.range = defaultRange(volume);
    optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    optics.scattering.reset();
    optics.parts.clear();
    optics.colorGrids.reset();
    return optics;
}

// A volume that throws a shadow.
struct Hiding {
    PreparedScene scene;
    SeenBall ball;
};

// Sums the light that is lost on the way to the places.
class LostLight {
  public:
    LostLight(const SeenGround& ground, const Camera& camera, const glm::dvec3& normal)
        : ground_(ground), camera_(camera), normal_(normal), lost_(ground.places().size()) {}

    // @param hiding  volumes that throw shadows, each in a picture of its own
    void add(const std::vector<Hiding>& hiding, const Light& light) {
        std::vector<double> hidden(lost_.size());
        for (const Hiding& one : hiding) hide(one.scene, one.ball, light, hidden);
        forPlaces([&](std::size_t i, const SeenPlace& place) {
            if (hidden[i] > 0) lost_[i] += hidden[i] * irradianceAt(light, place.world, normal_);
        });
    }

    // @param ambient  light that is never lost
    Image shares(const std::vector<Light>& lights, const glm::dvec3& ambient) const {
        Image image(camera_.sizePixels);
        forPlaces([&](std::size_t i, const SeenPlace& place) {
            if (lost_[i] == glm::dvec3(0)) return;
            glm::dvec3 all = ambient;
            for (const Light& light : lights) all += irradianceAt(light, place.world, normal_);
            const auto shareOf = [](double lost, double all) {
                return all > 0 ? float(std::clamp(lost / all, 0.0, 1.0)) : 0.0f;
            };
            for (int c = 0; c < 3; ++c)
                image.rgba[4 * i + std::size_t(c)] = shareOf(lost_[i][c], all[c]);
            image.rgba[4 * i + 3] =
                shareOf(glm::dot(lost_[i], kLuminance), glm::dot(all, kLuminance));
        });
        return image;
    }

  private:
    template <typename Use>
    void forPlaces(const Use& use) const {
        ground_.forRows([&](std::size_t first, int) {
            for (std::size_t i = first; i < first + std::size_t(camera_.sizePixels.x); ++i)
                if (ground_.places()[i].pixelWorld > 0) use(i, ground_.places()[i]);
        });
    }

    // Adds the share of a light hidden by a volume.
    void hide(const PreparedScene& scene, const SeenBall& ball, const Light& light,
              std::vector<double>& hidden) {
        const LightCamera lightCamera(light, ball, camera_);
        // Half a pixel, because reading between pixels blurs; nothing is finer than half a voxel.
        const double finest = 0.5 * std::max(ground_.finestPixel(lightCamera), ball.voxel);
        const Camera camera = lightCamera.of(finest);
        requireMemory("`ground`", 16.0 * camera.sizePixels.x * camera.sizePixels.y);
        // Without a listener, because an empty picture needs no warning.
        const Image image = scene.render(camera);
        forPlaces([&](std::size_t i, const SeenPlace& place) {
            const double share = alphaAt(image, camera, place.world);
            if (share > 0) hidden[i] += (1 - hidden[i]) * share;
        });
    }

    const SeenGround& ground_;
    const Camera& camera_;
    glm::dvec3 normal_;
    std::vector<glm::dvec3> lost_;  // [height][width]
};

}  // namespace

Image renderGroundShadow(const Volume& volume, const RenderOptions& options, const Camera& camera,
                         const Ground& ground, const Listener& listener) {
    const DefaultFloats floats;
    check(ground, options);
    constexpr double kBytesPerPixel = 16 + sizeof(SeenPlace) + sizeof(glm::dvec3);
    requireMemory("`ground`", kBytesPerPixel * camera.sizePixels.x * camera.sizePixels.y);
    const glm::dvec3 normal = unitVectorOf(ground.normalWorld);
    const SeenGround seen(camera, ground.pointWorld, normal);
    if (!seen.isSeen()) {
        listener.warn("`ground`: no line of sight meets it from above: it has no shadow here");
        return Image(camera.sizePixels);
    }
    const Scattering& scattering = *options.optics.scattering;
    std::vector<Light> lights;
    for (const Light& light : scattering.lights)
        if (isAbove(light, ground)) lights.push_back(light);
    if (lights.empty()) {
        listener.warn("`ground`: no light shines on it from above: it has no shadow");
        return Image(camera.sizePixels);
    }
    const std::shared_ptr<const Volume> above = volumeAbove(volume, ground, normal, listener);
    if (!above) return Image(camera.sizePixels);
    SplatOptions splat;
    splat.method = options.splat.method;
    splat.between = 0;  // lit fog is drawn by whole voxels
    std::vector<Hiding> hiding;
    const auto addHiding = [&](const std::shared_ptr<const Volume>& one) {
        hiding.push_back(
            {PreparedScene({one, hidingOptics(volume, options.optics)}, splat), SeenBall(*one)});
    };
    // One picture per far group, because a picture of all would show nothing.
    const std::optional<FarGroups> far = FarGroups::find(*above);
    for (std::size_t i = 0; far && i < far->size(); ++i)
        addHiding(std::make_shared<const Volume>(far->volume(i)));
    if (!far) addHiding(above);
    LostLight lost(seen, camera, normal);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        // Pictures are short, so progress is reported between them.
        lost.add(hiding, lights[i]);
        listener.report(double(i + 1) / double(lights.size()));
    }
    return lost.shares(lights, scattering.ambient);
}

std::vector<ImageChannel> shadowChannels(const Image& shadow) {
    std::vector<ImageChannel> channels;
    for (std::size_t c = 0; c < 3; ++c) {
        ImageChannel channel{std::string("shadow.") + "RGB" [c], {}};
        for (std::size_t i = c; i < shadow.rgba.size(); i += 4)
            channel.values.push_back(shadow.rgba[i]);
        channels.push_back(std::move(channel));
    }
    return channels;
}

void putShadowBehind(Image& image, const Image& shadow) {
    const DefaultFloats floats;
    if (image.size != shadow.size) {
        throw Error(ErrorCode::kUsage, "shadow", dimsText(shadow.size) + " pixels",
                    dimsText(image.size) + ", those of the picture");
    }
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        image.rgba[i] += (1 - image.rgba[i]) * shadow.rgba[i];
}

}  // namespace deltasplat
