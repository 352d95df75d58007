// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/render_aovs.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "deltasplat/prepared_scene.h"
#include "listener_part.h"
#include "memory.h"

namespace deltasplat {
namespace {

constexpr std::array kAll{Aov::kDepth,   Aov::kPosition, Aov::kEmission,
                          Aov::kAmbient, Aov::kDirect,   Aov::kTransmittance};

bool absorbs(const MediumPart& part) {
    return part.kind == MediumPart::Kind::kAbsorption;
}

[[noreturn]] void refuse(Aov aov, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected("`aovs` " + aovName(aov), got, expected));
}

void check(Aov aov, const Optics& optics) {
    const bool isOfLight = aov == Aov::kAmbient || aov == Aov::kDirect;
    if (isOfLight && !optics.scattering)
        refuse(aov, "what shines by itself", "`scattering`, light in fog");
    if (aov == Aov::kEmission && optics.shading)
        refuse(aov, "what reflects lights", "what shines by itself, or fog");
    if (aov != Aov::kDepth && aov != Aov::kPosition) return;
    if (optics.surface) refuse(aov, "a surface", "what a transfer function shows");
    if (std::any_of(optics.parts.begin(), optics.parts.end(), absorbs))
        refuse(aov, "a medium of several grids that swallow light", "one that does");
}

// What is seen alone of what optics show; all hide as much as they did.
Optics withoutGlow(Optics optics) {
    std::erase_if(optics.parts, [](const MediumPart& part) { return !absorbs(part); });
    return optics;
}

Optics onlyGlow(Optics optics) {
    // Without scattering what the volume shows shines by itself as well.
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

// @param light  empty: all of them
Optics onlyLights(const Optics& optics, std::optional<std::size_t> light) {
    Optics direct = withoutGlow(optics);
    direct.scattering->ambient = glm::dvec3(0);
    if (light) direct.scattering->lights = {optics.scattering->lights[*light]};
    return direct;
}

// Places in the box of voxel centres, from 0 to 1 along each index.
Optics places(Optics optics) {
    optics.colorBy = ColorBy::kIndex;
    optics.shading.reset();
    optics.scattering.reset();
    optics.parts.clear();
    optics.colorGrids.reset();
    return optics;
}

class AovRender {
  public:
    AovRender(const Volume& volume, const RenderOptions& options, const Camera& camera)
        : volume_(std::shared_ptr<const Volume>(), &volume), options_(options), camera_(camera) {
        const Optics& optics = options.optics;
        // All are drawn as the picture is: of all of its voxels, and none divided if its are not.
        if (optics.scattering || !optics.parts.empty() || optics.colorGrids) options_.between = 0;
        if (optics.parts.empty()) return;
        Optics unlit = optics;
        unlit.scattering.reset();
        volume_ = PreparedScene({volume_, unlit}, options).scene().volume;
    }

    std::vector<ImageChannel> take() { return std::move(channels_); }

    void add(Aov aov, bool withDepth, bool withPosition, const Listener& listener) {
        const Optics& optics = options_.optics;
        switch (aov) {
            case Aov::kDepth:
            case Aov::kPosition:
                return addPlaces(withDepth, withPosition, listener);
            case Aov::kEmission:
                return addColors("emission", onlyGlow(optics), listener);
            case Aov::kAmbient:
                return addColors("ambient", onlyAmbient(optics), listener);
            case Aov::kDirect:
                return addDirect(listener);
            case Aov::kTransmittance:
                break;
        }
        addTransmittance(listener);
    }

  private:
    Image picture(Optics optics, const Listener& listener) const {
        const PreparedScene scene({volume_, std::move(optics)}, options_);
        Image image(camera_.sizePixels);
        renderComposite(scene, camera_, image, listener);
        return image;
    }

    // @param valueOf  of a pixel's four numbers
    template <typename ValueOf>
    void addChannel(const std::string& name, const Image& image, const ValueOf& valueOf) {
        ImageChannel channel{name, std::vector<float>(image.rgba.size() / 4)};
        for (std::size_t i = 0; i < channel.values.size(); ++i)
            channel.values[i] = float(valueOf(&image.rgba[4 * i]));
        channels_.push_back(std::move(channel));
    }

    void addColors(const std::string& name, Optics optics, const Listener& listener) {
        const Image image = picture(std::move(optics), listener);
        for (int c = 0; c < 3; ++c) {
            addChannel(name + "." + "RGB"[c], image, [&](const float* rgba) { return rgba[c]; });
        }
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
        const Image image = picture(withoutGlow(options_.optics), listener);
        addChannel("transmittance", image, [](const float* rgba) { return 1 - rgba[3]; });
    }

    // World position of the mean place of a pixel; none where nothing is seen.
    std::optional<glm::dvec3> meanPlace(const float* rgba) const {
        if (!(rgba[3] > 0)) return {};
        const IndexBox& box = volume_->box;
        glm::dvec3 index;
        for (int i = 0; i < 3; ++i) {
            const double share = std::clamp(double(rgba[i]) / rgba[3], 0.0, 1.0);
            index[i] = box.min[i] + share * (double(box.max[i]) - box.min[i]);
        }
        return glm::dvec3(volume_->worldFromIndex * glm::dvec4(index, 1));
    }

    double depthOf(const glm::dvec3& world) const {
        const glm::dvec3 away = world - camera_.eyeWorld();
        return camera_.projection == Projection::kLatlong ? glm::length(away)
                                                          : glm::dot(away, camera_.direction);
    }

    void addPlaces(bool withDepth, bool withPosition, const Listener& listener) {
        const Image image = picture(places(options_.optics), listener);
        if (withDepth) {
            addChannel("Z", image, [&](const float* rgba) {
                const auto place = meanPlace(rgba);
                return place ? depthOf(*place) : double(kNoDepth);
            });
        }
        for (int axis = 0; withPosition && axis < 3; ++axis) {
            addChannel(std::string("P.") + "XYZ"[axis], image, [&](const float* rgba) {
                const auto place = meanPlace(rgba);
                return place ? (*place)[axis] : 0.0;
            });
        }
    }

    std::shared_ptr<const Volume> volume_;
    RenderOptions options_;
    const Camera& camera_;
    std::vector<ImageChannel> channels_;
};

}  // namespace

std::string aovName(Aov aov) {
    switch (aov) {
        case Aov::kDepth:
            return "depth";
        case Aov::kPosition:
            return "position";
        case Aov::kEmission:
            return "emission";
        case Aov::kAmbient:
            return "ambient";
        case Aov::kDirect:
            return "direct";
        case Aov::kTransmittance:
            break;
    }
    return "transmittance";
}

std::span<const Aov> allAovs() {
    return kAll;
}

std::vector<ImageChannel> renderAovs(const Volume& volume, const RenderOptions& options,
                                     const Camera& camera, std::span<const Aov> aovs,
                                     const Listener& listener) {
    const DefaultFloats floats;
    if (options.mode != Mode::kComposite && !aovs.empty())
        refuse(aovs.front(), "`mode` " + modeName(options.mode), "composite");
    const auto isWanted = [&](Aov aov) {
        return std::find(aovs.begin(), aovs.end(), aov) != aovs.end();
    };
    for (const Aov aov : kAll)
        if (isWanted(aov)) check(aov, options.optics);
    // A picture, and what is made of it.
    constexpr double kBytesPerPixel = 16 + 4 * 6;
    requireMemory("`aovs`",
                  kBytesPerPixel * double(aovs.size()) * camera.sizePixels.x * camera.sizePixels.y);
    AovRender render(volume, options, camera);
    const bool withDepth = isWanted(Aov::kDepth);
    const bool withPosition = isWanted(Aov::kPosition);
    for (std::size_t i = 0; i < kAll.size(); ++i) {
        // Depths and places are one picture.
        const bool isDone = kAll[i] == Aov::kPosition && withDepth;
        if (!isWanted(kAll[i]) || isDone) continue;
        render.add(kAll[i], withDepth, withPosition,
                   partOf(listener, double(i) / kAll.size(), double(i + 1) / kAll.size()));
    }
    return render.take();
}

}  // namespace deltasplat
