// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "lighting/part_looks.h"
#include "optics/voxel_painter.h"

namespace deltasplat {

/// What a medium of several parts shows: extinctions add up, and what shines is dimmed by all of
/// them. Of each voxel look i, or look 0 and a colour factor, are kept in the bits of its own look.
class MediumLight : public LookLight {
  public:
    /// @param inner   what the volume alone looks like
    /// @param parts   must outlive the light
    /// @param factor  what colour factors are shares of; null: there are none
    MediumLight(std::unique_ptr<const LookLight> inner, const std::vector<PartLooks>& parts,
                const glm::dvec3* factor, const ClassTable& classes);

  protected:
    void lightVoxels(const WordPlace& place, const std::uint16_t* classes, const OwnLook* looks,
                     WordUnits& colors) const override;

  private:
    // What a look of a part adds in a step; colours in units.
    struct StepLook {
        float depth;      // extinction on it
        glm::vec3 color;  // of what swallows light, not multiplied by opacity
        glm::vec3 glow;
    };
    // What a class has in a step.
    struct StepClass {
        float depth;
        float dimmed;  // share of what shines all along it that comes out of it
    };

    // Moves nothing before the base class is made.
    MediumLight(const VoxelUnits& units, std::unique_ptr<const LookLight>&& inner,
                const std::vector<PartLooks>& parts, const glm::dvec3* factor,
                const ClassTable& classes);
    void findLooks(const std::vector<PartLooks>& parts, const ClassTable& classes);
    void addGlow(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const;
    void addParts(const std::uint16_t* classes, const OwnLook* looks, WordUnits& colors) const;

    std::unique_ptr<const LookLight> inner_;
    glm::vec4 fromInner_;  // what units of the inner light are in those of this
    bool hasFactors_;
    bool absorbs_ = false;  // whether any part does
    glm::vec3 factor_{1};
    std::vector<std::vector<StepLook>> looks_;  // [parts][looks]
    std::vector<StepClass> classes_;
};

}  // namespace deltasplat
