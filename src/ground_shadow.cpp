// SPDX-License-Identifier: Apache-2.0
// Based on: Lance Williams, "Casting Curved Shadows on Curved Surfaces", 1978 (a picture from where
// the light is says what is lit). What fog lets through takes the place of depths, for all of it
// lies before the plane.
#include "deltasplat/ground_shadow.h"

#include <algorithm>
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

#include "default_floats.h"
#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/prepared_scene.h"
#include "dims_text.h"
#include "far_groups.h"
#include "luminance.h"
#include "memory.h"
#include "number_text.h"
#include "parallel.h"
#include "shadow_picture.h"
#include "unit_vector.h"
#include "view/affine.h"

namespace deltasplat {
namespace {

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected("`ground`", got, expected));
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

// Where pixels see the plane.
struct SeenPlace {
    glm::dvec3 world{0.0};
    double pixelWorld = 0;  // of the pixel, across the line of sight; 0: it is not seen
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

    // The finest that a picture from a light is looked at, at the middle of the volume.
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

    // So many rays away from where it begins.
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

// What light brings to a place of a plane that it shines on from above; else 0.
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

// How far the centres of a volume's voxels lie from the plane, in the world.
glm::dvec2 heightsOf(const Volume& volume, const glm::dvec3& point, const glm::dvec3& normal) {
    glm::dvec2 heights(std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity());
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 world(volume.worldFromIndex * glm::dvec4(cornerOf(volume.box, corner), 1));
        const double height = glm::dot(world - point, normal);
        heights = {std::min(heights.x, height), std::max(heights.y, height)};
    }
    return heights;
}

// What of the volume lies above the plane; null if that is nothing.
std::shared_ptr<const Volume> volumeAbove(const Volume& volume, const Ground& ground,
                                          const glm::dvec3& normal, const Listener& listener) {
    const std::shared_ptr<const Volume> all(std::shared_ptr<const Volume>(), &volume);
    if (volume.empty()) return {};
    constexpr double kSlack = 1e-6;  // of a voxel, as cuts have it
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

// White, hiding as much as it does.
Optics hidingOptics(const Volume& volume, Optics optics) {
    if (!optics.range) optics.range = defaultRange(volume);
    optics.transferFunction.colors = {{0, glm::dvec3(1)}};
    optics.scattering.reset();
    optics.parts.clear();
    optics.colorGrids.reset();
    return optics;
}

// What throws a shadow.
struct Hiding {
    PreparedScene scene;
    SeenBall ball;
};

// Adds up what lights lose on their way to the places.
class LostLight {
  public:
    LostLight(const SeenGround& ground, const Camera& camera, const glm::dvec3& normal)
        : ground_(ground), camera_(camera), normal_(normal), lost_(ground.places().size()) {}

    // @param hiding  what throws a shadow, each in a picture of its own
    void add(const std::vector<Hiding>& hiding, const Light& light) {
        std::vector<double> hidden(lost_.size());
        for (const Hiding& one : hiding) hide(one.scene, one.ball, light, hidden);
        forPlaces([&](std::size_t i, const SeenPlace& place) {
            if (hidden[i] > 0) lost_[i] += hidden[i] * irradianceAt(light, place.world, normal_);
        });
    }

    // @param ambient  that nothing is lost of
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

    // Adds what is hidden of a light by one that throws a shadow.
    void hide(const PreparedScene& scene, const SeenBall& ball, const Light& light,
              std::vector<double>& hidden) {
        const LightCamera lightCamera(light, ball, camera_);
        // Half a pixel, for what is read between pixels is blurred; what is finer than half a voxel
        // is not there.
        const double finest = 0.5 * std::max(ground_.finestPixel(lightCamera), ball.voxel);
        const Camera camera = lightCamera.of(finest);
        requireMemory("`ground`", 16.0 * camera.sizePixels.x * camera.sizePixels.y);
        Image image(camera.sizePixels);
        // An empty one is no reason to warn.
        renderer_.render(scene, camera, image, {});
        forPlaces([&](std::size_t i, const SeenPlace& place) {
            const double share = alphaAt(image, camera, place.world);
            if (share > 0) hidden[i] += (1 - hidden[i]) * share;
        });
    }

    const SeenGround& ground_;
    const Camera& camera_;
    glm::dvec3 normal_;
    std::vector<glm::dvec3> lost_;  // [height][width]
    Renderer renderer_;
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
    splat.method = options.method;
    splat.between = 0;  // lit fog is drawn by whole voxels
    std::vector<Hiding> hiding;
    const auto addHiding = [&](const std::shared_ptr<const Volume>& one) {
        hiding.push_back(
            {PreparedScene({one, hidingOptics(volume, options.optics)}, splat), SeenBall(*one)});
    };
    // Voxels that lie far apart, for a picture of all would show none.
    const std::optional<FarGroups> far = FarGroups::find(*above);
    for (std::size_t i = 0; far && i < far->size(); ++i)
        addHiding(std::make_shared<const Volume>(far->volume(i)));
    if (!far) addHiding(above);
    LostLight lost(seen, camera, normal);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        // Reported between pictures: each is short.
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
        throw Error(ErrorCode::kUsage,
                    gotExpected("shadow", dimsText(shadow.size) + " pixels",
                                dimsText(image.size) + ", those of the picture"));
    }
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        image.rgba[i] += (1 - image.rgba[i]) * shadow.rgba[i];
}

}  // namespace deltasplat
