// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "deltasplat/image/write_image.h"
#include "deltasplat/render.h"

namespace deltasplat {

/// A channel or several beside the colours of a picture. Each Aov is a picture of its own of the
/// same scene and camera, and takes as long.
enum class Aov {
    kDepth,     ///< `Z`: mean depth of what is seen, in world units
    kFront,     ///< `depth_front.Z`: depth where alpha passes AovOptions::depthOpacity
    kBack,      ///< `ZBack`: depth behind which alpha grows by less than 2^-10
    kPosition,  ///< `P.X`, `P.Y`, `P.Z`: mean world position of what is seen
    kNormal,    ///< `N.X`, `N.Y`, `N.Z`: mean of Shading's normals, in the world
    kEmission,  ///< `emission.R`, `.G`, `.B`: light of voxels that shine by themselves
    kAmbient,   ///< `ambient.R`, ...: scattered light of Scattering::ambient
    kDirect,    ///< `direct.R`, ...: light of all lights, and `direct_1.R`, ... of each if several
    kTransmittance,  ///< `transmittance`: the share of light from behind that gets through
    kMattes,         ///< `matte_1`, ...: the share of alpha of each layer that swallows light
    kSamples,        ///< `samples`: how many slices hide something of a pixel
};

/// Returns "depth", "front", "back", "position", "normal", "emission", "ambient", "direct",
/// "transmittance", "mattes" or "samples".
std::string aovName(Aov aov);
std::span<const Aov> allAovs();

struct AovOptions {
    double depthOpacity = 0.5;  ///< of kFront: kLeastDepthOpacity..1
    /// The picture of `render` for the same scene, if there is one: kTransmittance is read from it,
    /// and takes no time. Null: it is rendered.
    const Image* picture = nullptr;
};

inline constexpr double kLeastDepthOpacity = 0.001;

/// Number of lights that get channels of their own, beside their sum.
inline constexpr int kMostLightChannels = 8;

/// Renders channels beside a picture of Mode::kComposite. They are premultiplied: `emission` +
/// `ambient` + `direct` is the picture, to 2^-8 per voxel and part (ClassTable).
///
/// Depths and places are means over the visible voxels of a pixel, weighted by how much each hides.
/// Depth counts along the camera's line of sight from its eye; in a panorama from the eye to the
/// mean place. Places are 0 where nothing is seen. kFront, kBack and kSamples, and depths and
/// places of surfaces and of media with absorbing parts, follow the picture slice by slice on the
/// line of sight of a pixel's middle: together they take as long as a deep picture of single
/// slices.
///
/// Normals face the camera and are means as places are: shorter than 1 where visible voxels face
/// several ways, and 0 where nothing is seen. Unshaded voxels, with nearly constant values, have
/// half of the direction to the camera, the mean of all normals facing it. Fog has normals too.
///
/// Mattes are the volume's and its absorbing parts', in order, three per picture; they sum up to
/// alpha.
///
/// kSamples counts the slices that alpha grows by, divided slices one by one, until less than 2^-10
/// gets through: about the samples of a deep picture of single slices. It counts no random samples,
/// as other renderers do under this name.
/// @param camera  of the picture
/// @throw Error(kUsage) for channels that the scene does not have (ambient and direct light without
///        scattering, normals of media with absorbing parts) or an opacity out of range; as render
std::vector<ImageChannel> renderAovs(const Volume& volume, const RenderOptions& options,
                                     const Camera& camera, std::span<const Aov> aovs,
                                     const AovOptions& aovOptions = {},
                                     const Listener& listener = {});

}  // namespace deltasplat
