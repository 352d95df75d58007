// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "deltasplat/image/write_image.h"
#include "deltasplat/render.h"

namespace deltasplat {

/// What a picture can be told of beside its colours. Each is a picture of its own of the same scene
/// and camera, and takes as long.
enum class Aov {
    kDepth,          ///< `Z`: mean depth of what is seen, in world units
    kFront,          ///< `depth_front.Z`: depth where alpha passes AovOptions::depthOpacity
    kBack,           ///< `ZBack`: depth behind which alpha grows by less than 2^-10
    kPosition,       ///< `P.X`, `P.Y`, `P.Z`: its mean place in the world
    kNormal,         ///< `N.X`, `N.Y`, `N.Z`: mean of the normals that Shading has, in the world
    kEmission,       ///< `emission.R`, `.G`, `.B`: what shines by itself
    kAmbient,        ///< `ambient.R`, ...: what fog scatters of light from everywhere
    kDirect,         ///< `direct.R`, ...: of all lights, and `direct_1.R`, ... of each, if several
    kTransmittance,  ///< `transmittance`: the share of light from behind that gets through
    kMattes,         ///< `matte_1`, ...: the share of alpha of each layer that swallows light
    kSamples,        ///< `samples`: how many slices hide something of a pixel
};

/// Returns "depth", "front", "back", "position", "normal", "emission", "ambient", "direct",
/// "transmittance", "mattes" or "samples".
std::string aovName(Aov aov);
/// Returns all of them, in order.
std::span<const Aov> allAovs();

/// How channels are made.
struct AovOptions {
    double depthOpacity = 0.5;  ///< of kFront: kLeastDepthOpacity..1
    /// What render makes of the same, if that is there: kTransmittance is read from it, and takes
    /// no time. Null: it is rendered.
    const Image* picture = nullptr;
};

inline constexpr double kLeastDepthOpacity = 0.001;

/// Lights that get channels of their own, beside their sum.
inline constexpr int kMostLightChannels = 8;

/// Renders channels beside a picture of Mode::kComposite. Premultiplied: `emission` + `ambient` +
/// `direct` is the picture, as far as each is told of a voxel (ClassTable: to 2^-8). Depths and
/// places are means over what is seen of a pixel, by how much it hides; depth counts along the
/// camera's line of sight from its eye, or of a panorama from the eye to the mean place. Where
/// nothing is seen, places are 0. kFront, kBack and kSamples, and depths and places of surfaces and
/// of media whose parts swallow light, are of what the picture is as slice after slice is put
/// behind the others, on the line of sight of the middle of a pixel: this takes as long as a deep
/// picture of single slices. All of these that are wanted are made at once.
///
/// Normals are those that face the camera, and means as places are: shorter than 1 where what is
/// seen of a pixel faces several ways. Of what is not shaded, where values hardly change, they are
/// half of the way to the camera, the mean of all that face it. They need no Shading: fog has them
/// as well. Where nothing is seen they are 0.
///
/// Mattes are of the volume and of the parts of Optics that swallow light, in their order, three of
/// them to a picture; they add up to alpha as parts of light do to the picture.
///
/// kSamples counts slices, those that voxels are divided into one by one, by which alpha grows,
/// until less than 2^-10 gets through: about what a deep picture of single slices has samples.
/// Nothing is drawn at random here, which other renderers count by this name.
/// @param camera  of the picture
/// @throw Error(kUsage) for what the scene does not have: ambient and direct light without
///        scattering, normals of media whose parts swallow light; for an opacity out of range; as
///        render
std::vector<ImageChannel> renderAovs(const Volume& volume, const RenderOptions& options,
                                     const Camera& camera, std::span<const Aov> aovs,
                                     const AovOptions& aovOptions = {},
                                     const Listener& listener = {});

}  // namespace deltasplat
