// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "deltasplat/image/image.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/render.h"

namespace deltasplat {

/// A plane that a volume above it throws its shadow on.
struct Ground {
    glm::dvec3 pointWorld{0.0};
    /// Upwards, towards the lit and visible side; any length but 0.
    glm::dvec3 normalWorld{0, 1, 0};
};

/// Renders the shadow of fog on a plane, where a camera sees the plane from above and not nearer
/// than Camera::nearWorld. The unshadowed light is Scattering::ambient and Scattering's lights
/// above the plane, over their squared distance (no less than their radius), times the cosine with
/// the normal. Lights lose what the fog above the plane swallows and scatters on the straight way.
/// Deterministic, the same for every method, thread count and SIMD level; one picture per light.
/// @param options  of Mode::kComposite with scattering; method and optics count
/// @return no picture but shares, 0..1: R, G and B of the lost light, A of its luminance
/// @throw Error(kUsage) without scattering, in another mode, for an impossible plane; as render
Image renderGroundShadow(const Volume& volume, const RenderOptions& options, const Camera& camera,
                         const Ground& ground, const Listener& listener = {});

/// Returns the channels `shadow.R`, `shadow.G` and `shadow.B` of renderGroundShadow's image.
std::vector<ImageChannel> shadowChannels(const Image& shadow);

/// Puts the shadow behind a picture, as black of its A: A += (1 - A) * share.
/// @throw Error(kUsage) if the sizes differ
void putShadowBehind(Image& image, const Image& shadow);

}  // namespace deltasplat
