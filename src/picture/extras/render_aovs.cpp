// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render_aovs.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "base/kept_memory.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/prepared_scene.h"
#include "picture/extras/render_deep.h"
#include "picture/far_groups.h"
#include "screen/deep_builder.h"

namespace deltasplat {
namespace {

constexpr std::array kAll{Aov::kDepth,         Aov::kFront,    Aov::kBack,    Aov::kPosition,
                          Aov::kNormal,        Aov::kEmission, Aov::kAmbient, Aov::kDirect,
                          Aov::kTransmittance, Aov::kMattes,   Aov::kSamples};

bool absorbs(const MediumPart& part) {
    return part.kind == MediumPart::Kind::kAbsorption;
}

bool severalAbsorb(const Optics& optics) {
    return std::any_of(optics.parts.begin(), optics.parts.end(), absorbs);
}

[[noreturn]] void refuse(Aov aov, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, "`aovs` " + aovName(aov), got, expected);
}

void check(Aov aov, const Optics& optics) {
    const bool isOfLight = aov == Aov::kAmbient || aov == Aov::kDirect;
    if (isOfLight && !optics.scattering)
        refuse(aov, "what shines by itself", "`scattering`, light in fog");
    if (aov == Aov::kEmission && optics.shading)
        refuse(aov, "what reflects lights", "what shines by itself, or fog");
    if (aov == Aov::kNormal && severalAbsorb(optics))
        refuse(aov, "a medium of several grids that swallow light", "one that does");
}

void checkOpacity(double opacity) {
    if (opacity >= kLeastDepthOpacity && opacity <= 1) return;
    throw Error(ErrorCode::kUsage, "`depthOpacity`", numberText(opacity),
                "a number within 0.001..1");
}

// Only the light of absorbing matter; opacity stays.
Optics withoutGlow(Optics optics) {
    std::erase_if(optics.parts, [](const MediumPart& part) { return !absorbs(part); });
    return optics;
}

Optics onlyGlow(Optics optics) {
    // Without `scattering` the volume would glow.
    if (optics.scattering) {
        optics.scattering->lights.clear();
        optics.scattering->ambient = glm::dvec3(0);
    }
    return optics;
}

Optics onlyAmbient(const Optics& optics) {
    Optics ambient = withoutGlow(optics);
    ambient.scattering->lights.clear();
    return ambient;
}

// @param light  empty: all lights
Optics onlyLights(const Optics& optics, std::optional<std::size_t> light) {
    Optics direct = withoutGlow(optics);
    direct.scattering->ambient = glm::dvec3(0);
    if (light) direct.scattering->lights = {optics.scattering->lights[*light]};
    return direct;
}

// Same opacity, whatever the colour.
Optics unlit(const Optics& optics) {
    Optics unlit = withoutGlow(optics);
    unlit.colorBy = ColorBy::kValue;
    unlit.shading.reset();
    unlit.scattering.reset();
    unlit.colorGrids.reset();
    return unlit;
}

Optics outline(const Optics& optics) {
    Optics outline = unlit(optics);
    outline.transferFunction.colors = {{0, glm::dvec3(1)}};
    return outline;
}

// Three layers from `firstLayer` on in red, green and blue, the others black.
Optics mattes(const Optics& optics, int firstLayer) {
    Optics mattes = unlit(optics);
    int layer = 0;
    const auto colorNext = [&](TransferFunction& function) {
        const int channel = layer++ - firstLayer;
        glm::dvec3 color(0);
        if (channel >= 0 && channel < 3) color[channel] = 1;
        function.colors = {{0, color}};
    };
    colorNext(mattes.transferFunction);
    for (MediumPart& part : mattes.parts) colorNext(part.transferFunction);
    return mattes;
}

// White, lit along or against the world's axes in red, green and blue: normals' components.
Optics facing(const Optics& optics, double way) {
    Optics facing = outline(optics);
    if (facing.surface) facing.surface->color = glm::dvec3(1);
    Shading shading{0, 1, 0, 1, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Light& light = shading.lights.emplace_back();
        light.frame = LightFrame::kWorld;
        light.direction = light.color = glm::dvec3(0);
        light.direction[axis] = -way;
        light.color[axis] = 1;
    }
    facing.shading = shading;
    return facing;
}

// Places in the box of voxel centres, 0 to 1 along each index.
Optics places(const Optics& optics) {
    Optics places = unlit(optics);
    places.colorBy = ColorBy::kIndex;
    return places;
}

// Whether voxels always have their own colours.
bool isColored(const Optics& optics) {
    return optics.surface || severalAbsorb(optics);
}

// In the world; empty if nothing is seen.
using Place = std::optional<glm::dvec3>;

class AovRender {
  public:
    AovRender(const Volume& volume, const RenderOptions& options, const AovOptions& aovOptions,
              const Camera& camera)
        : volume_(std::shared_ptr<const Volume>(), &volume),
          options_(options),
          aovOptions_(aovOptions),
          camera_(camera) {
        const Optics& optics = options.optics;
        // All channels use the picture's voxels, undivided if the picture's are.
        const bool isWhole =
            optics.scattering || !optics.parts.empty() || optics.colorGrids ||
            (!options.splat.between && !optics.surface && optics.transferFunction.colorsJump());
        if (isWhole) options_.splat.between = 0;
        if (optics.parts.empty()) return;
        Optics unlit = optics;
        unlit.scattering.reset();
        volume_ = PreparedScene({volume_, unlit}, options.splat).scene().volume;
    }

    std::vector<ImageChannel> take() { return std::move(channels_); }

    void add(Aov aov, const Listener& listener) {
        const Optics& optics = options_.optics;
        switch (aov) {
            case Aov::kDepth:
                return addDepth(listener);
            case Aov::kFront:
                return channels_.push_back({"depth_front.Z", depths(listener).front(), kNoDepth});
            case Aov::kBack:
                return channels_.push_back({"ZBack", depths(listener).back(), kNoDepth});
            case Aov::kPosition:
                return addPosition(listener);
            case Aov::kNormal:
                return addNormal(listener);
            case Aov::kEmission:
                return addColors("emission", onlyGlow(optics), listener);
            case Aov::kAmbient:
                return addColors("ambient", onlyAmbient(optics), listener);
            case Aov::kDirect:
                return addDirect(listener);
            case Aov::kTransmittance:
                return addTransmittance(listener);
            case Aov::kMattes:
                return addMattes(listener);
            case Aov::kSamples:
                break;
        }
        channels_.push_back({"samples", depths(listener).samples()});
    }

  private:
    Image picture(Optics optics, const Listener& listener) const {
        return PreparedScene({volume_, std::move(optics)}, options_.splat)
            .render(camera_, listener);
    }

    // @param valueOf  of a pixel, by its number
    // @param nothing  as ImageChannel::nothing
    template <typename ValueOf>
    void addChannel(const std::string& name, const ValueOf& valueOf, float nothing = 0) {
        const glm::ivec2 size = camera_.sizePixels;
        ImageChannel channel{name, std::vector<float>(std::size_t(size.x) * std::size_t(size.y)),
                             nothing};
        for (std::size_t i = 0; i < channel.values.size(); ++i)
            channel.values[i] = float(valueOf(i));
        channels_.push_back(std::move(channel));
    }

    void addChannel(const std::string& name, const Image& image, int channel) {
        addChannel(name, [&](std::size_t i) { return image.rgba[4 * i + std::size_t(channel)]; });
    }

    void addColors(const std::string& name, Optics optics, const Listener& listener) {
        const Image image = picture(std::move(optics), listener);
        for (int c = 0; c < 3; ++c) addChannel(name + "." + "RGB"[c], image, c);
    }

    void addDirect(const Listener& listener) {
        const Optics& optics = options_.optics;
        const std::size_t lights = optics.scattering->lights.size();
        const bool each = lights > 1 && lights <= std::size_t(kMostLightChannels);
        addColors("direct", onlyLights(optics, {}), partOf(listener, 0, each ? 0.5 : 1));
        for (std::size_t i = 0; each && i < lights; ++i)
            addColors("direct_" + std::to_string(i + 1), onlyLights(optics, i), {});
    }

    void addTransmittance(const Listener& listener) {
        std::optional<Image> made;
        if (!aovOptions_.picture) made = picture(withoutGlow(options_.optics), listener);
        const Image& image = made ? *made : *aovOptions_.picture;
        addChannel(
            "transmittance", [&](std::size_t i) { return 1 - image.rgba[4 * i + 3]; }, 1);
    }

    void addMattes(const Listener& listener) {
        // All white, slices might be joined that are not in the picture.
        options_.splat.mostJoined = joinedOfPicture();
        const auto layers = 1 + int(withoutGlow(options_.optics).parts.size());
        for (int first = 0; first < layers; first += 3) {
            const Image image = picture(mattes(options_.optics, first),
                                        partOf(listener, double(first) / layers,
                                               std::min(first + 3.0, double(layers)) / layers));
            for (int i = first; i < std::min(first + 3, layers); ++i)
                addChannel("matte_" + std::to_string(i + 1), image, i - first);
        }
    }

    int joinedOfPicture() const {
        const Optics& optics = options_.optics;
        if (optics.scattering || optics.shading || !optics.parts.empty()) return 1;
        const PreparedScene scene({volume_, optics}, options_.splat);
        if (!scene.impl().far) return joinedOf(scene.impl());
        int joined = kMostJoined;
        for (std::size_t i = 0; i < scene.impl().far->size(); ++i) {
            if (!scene.impl().far->seenBy(camera_, i).isNothing())
                joined = std::min(joined, joinedOf(PreparedScene::Impl(scene.impl(), i)));
        }
        return joined;
    }

    int joinedOf(const PreparedScene::Impl& scene) const {
        return planPicture(scene, camera_, DrawnFor::kSlabs, {}).joined();
    }

    // Made for the first channel that needs it, like the members below.
    const DepthBuilder& depths(const Listener& listener) {
        if (depths_) return *depths_;
        const Optics& optics = options_.optics;
        depths_.emplace(
            camera_, aovOptions_.depthOpacity,
            optics.surface ? DepthBuilder::Growth::kSurface : DepthBuilder::Growth::kFog);
        const PreparedScene scene({volume_, outline(optics)}, options_.splat);
        KeptMemory memory;
        Image image(camera_.sizePixels);
        DeepSink singleSlices(0, *depths_, image);
        renderViews(scene.impl(), camera_, memory, singleSlices, listener);
        return *depths_;
    }

    const std::vector<Place>& meanPlaces(const Listener& listener) {
        if (!places_.empty()) return places_;
        // Colours are too coarse for places that lie far apart.
        if (isColored(options_.optics) || FarGroups::find(*volume_)) {
            findPlaces(depths(listener).mean());
        } else {
            findPlaces(picture(places(options_.optics), listener));
        }
        return places_;
    }

    void findPlaces(const Image& indices) {
        for (std::size_t i = 0; i < indices.rgba.size(); i += 4)
            places_.push_back(meanPlace(&indices.rgba[i]));
    }

    void findPlaces(const std::vector<float>& depths) {
        const auto width = std::size_t(camera_.sizePixels.x);
        for (std::size_t i = 0; i < depths.size(); ++i) {
            const glm::dvec2 pixel = glm::dvec2(i % width, i / width) + 0.5;
            places_.push_back(depths[i] == kNoDepth ? Place() : placeAt(pixel, depths[i]));
        }
    }

    // World position of a pixel's mean place.
    Place meanPlace(const float* rgba) const {
        if (!(rgba[3] > 0)) return {};
        const IndexBox& box = volume_->box();
        glm::dvec3 index;
        for (int i = 0; i < 3; ++i) {
            const double share = std::clamp(double(rgba[i]) / rgba[3], 0.0, 1.0);
            index[i] = box.min[i] + share * (double(box.max[i]) - box.min[i]);
        }
        return glm::dvec3(volume_->worldFromIndex() * glm::dvec4(index, 1));
    }

    glm::dvec3 placeAt(glm::dvec2 pixel, double depth) const {
        const glm::dvec3 eye = camera_.eyeWorld();
        if (camera_.projection == Projection::kOrtho) {
            const glm::dvec3 aside = camera_.worldFromPixel(pixel) - camera_.targetWorld;
            return eye + aside + depth * camera_.direction;
        }
        const glm::dvec3 ray = camera_.rayThrough(pixel);
        return eye + depth / depthOf(eye + ray) * ray;
    }

    double depthOf(const glm::dvec3& world) const {
        const glm::dvec3 away = world - camera_.eyeWorld();
        return camera_.projection == Projection::kLatlong ? glm::length(away)
                                                          : glm::dot(away, camera_.direction);
    }

    void addDepth(const Listener& listener) {
        const std::vector<Place>& places = meanPlaces(listener);
        addChannel(
            "Z", [&](std::size_t i) { return places[i] ? depthOf(*places[i]) : kNoDepth; },
            kNoDepth);
    }

    void addPosition(const Listener& listener) {
        const std::vector<Place>& places = meanPlaces(listener);
        for (int axis = 0; axis < 3; ++axis) {
            addChannel(std::string("P.") + "XYZ"[axis],
                       [&](std::size_t i) { return places[i] ? (*places[i])[axis] : 0; });
        }
    }

    void addNormal(const Listener& listener) {
        const Image along = picture(facing(options_.optics, 1), partOf(listener, 0, 0.5));
        const Image against = picture(facing(options_.optics, -1), partOf(listener, 0.5, 1));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            addChannel(std::string("N.") + "XYZ"[axis], [&](std::size_t i) {
                const double alpha = along.rgba[4 * i + 3];
                const double turned = double(along.rgba[4 * i + axis]) - against.rgba[4 * i + axis];
                return alpha > 0 ? std::clamp(turned / alpha, -1.0, 1.0) : 0;
            });
        }
    }

    std::shared_ptr<const Volume> volume_;
    RenderOptions options_;
    AovOptions aovOptions_;
    const Camera& camera_;
    std::vector<ImageChannel> channels_;
    std::optional<DepthBuilder> depths_;
    std::vector<Place> places_;  // [height][width]
};

}  // namespace

std::string aovName(Aov aov) {
    return enumName(aov, {"depth", "front", "back", "position", "normal", "emission", "ambient",
                          "direct", "transmittance", "mattes", "samples"});
}

std::span<const Aov> allAovs() {
    return kAll;
}

std::vector<ImageChannel> renderAovs(const Volume& volume, const RenderOptions& options,
                                     const Camera& camera, std::span<const Aov> aovs,
                                     const AovOptions& aovOptions, const Listener& listener) {
    const DefaultFloats floats;
    if (options.mode != Mode::kComposite && !aovs.empty())
        refuse(aovs.front(), "`mode` " + modeName(options.mode), "composite");
    const auto isWanted = [&](Aov aov) {
        return std::find(aovs.begin(), aovs.end(), aov) != aovs.end();
    };
    for (const Aov aov : kAll)
        if (isWanted(aov)) check(aov, options.optics);
    checkOpacity(aovOptions.depthOpacity);
    if (aovOptions.picture && aovOptions.picture->size != camera.sizePixels) {
        throw Error(ErrorCode::kUsage, "`picture`", dimsText(aovOptions.picture->size) + " pixels",
                    dimsText(camera.sizePixels) + ", those of the camera");
    }
    // Per channel a picture and its results; and places.
    const double bytesPerPixel = (16 + 4 * 6) * double(aovs.size()) + sizeof(Place);
    requireMemory("`aovs`", bytesPerPixel * camera.sizePixels.x * camera.sizePixels.y);
    AovRender render(volume, options, aovOptions, camera);
    for (std::size_t i = 0; i < kAll.size(); ++i) {
        if (!isWanted(kAll[i])) continue;
        render.add(kAll[i], partOf(listener, double(i) / kAll.size(), double(i + 1) / kAll.size()));
    }
    return render.take();
}

}  // namespace deltasplat
