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
    glm::dvec3 pointWorld{0.0};  ///< any of the plane
    /// Up from it, to the side that is lit and seen; of any length but 0.
    glm::dvec3 normalWorld{0, 1, 0};
};

/// Renders the shadow that fog throws on a plane, as far as a camera sees the plane before it, from
/// above and not nearer than Camera::nearWorld. What nothing is lost of is that of all lights of
/// Scattering that stand above the plane, each by its strength, the square of its distance (no less
/// than its radius) and the cosine with the normal, and Scattering::ambient. Each light loses what
/// the fog above the plane swallows and scatters on the straight way to the plane. Deterministic,
/// the same for every method, thread count and SIMD level; takes about one picture for each light.
/// @param options  of Mode::kComposite with scattering; method and optics count
/// @param camera   of the picture
/// @return no picture but shares, 0..1: R, G and B of the light that is lost, A of its luminance
/// @throw Error(kUsage) without scattering, in another mode, or for a plane that is none; as render
Image renderGroundShadow(const Volume& volume, const RenderOptions& options, const Camera& camera,
                         const Ground& ground, const Listener& listener = {});

/// Returns the channels `shadow.R`, `shadow.G` and `shadow.B` of what renderGroundShadow returned.
std::vector<ImageChannel> shadowChannels(const Image& shadow);

/// Puts the shadow behind a picture, as black of its A: A += (1 - A) * share.
/// @throw Error(kUsage) if the sizes differ
void putShadowBehind(Image& image, const Image& shadow);

}  // namespace deltasplat
