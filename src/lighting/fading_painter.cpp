// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/affine.h"
#include "lighting/reflected_light.h"
#include "optics/scaled_values.h"
#include "optics/voxel_painter.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

// Adds to looks how much of their opacity voxels have.
class FadingPainter : public VoxelPainter {
  public:
    // @param inner  who paints them otherwise; null: they look as their classes do
    FadingPainter(const Volume& volume, std::vector<glm::dvec2> factors,
                  std::unique_ptr<const VoxelPainter> inner)
        : inner_(std::move(inner)),
          scale_(inner_ && inner_->gradientScale()
                     ? *inner_->gradientScale()
                     : scaledValues(volume, 0.5 * volume.valueMin + 0.5 * volume.valueMax)),
          worldFromGradient_(worldFromIndexGradient(volume)),
          factors_(std::move(factors)) {
        unit_ = scale_.unit / smallestSize(volume);
    }

    bool needsColors() const override { return !inner_ || inner_->needsColors(); }
    bool dependsOnCamera() const override { return inner_ && inner_->dependsOnCamera(); }
    bool mayHold() const override { return false; }
    const GradientScale* gradientScale() const override { return &scale_; }

    void paint(const BlockPlace& place, const BlockField* field,
               std::span<std::uint16_t, 512> classes,
               std::span<OwnLook, 512> looks) const override {
        if (inner_) inner_->paint(place, field, classes, looks);
        for (std::size_t n = 0; n < looks.size(); ++n) {
            if (classes[n] == 0) continue;
            const glm::dvec3 gradient(worldGradient(worldFromGradient_, *field, n));
            const double factor = factorAt(unit_ * std::sqrt(glm::dot(gradient, gradient)));
            const int left = int(factor * OwnLook::kAll + 0.5);
            looks[n].faded = std::uint8_t(OwnLook::kAll - left);
            if (left == 0) classes[n] = 0;
        }
    }

    std::unique_ptr<const LookLight> lightOf(const ClassTable& classes,
                                             const LitScene* scene) const override {
        if (inner_) return inner_->lightOf(classes, scene);
        return std::make_unique<ClassLight>(classes);
    }

  private:
    double factorAt(double gradient) const {
        const auto behind =
            std::upper_bound(factors_.begin(), factors_.end(), gradient,
                             [](double place, const glm::dvec2& point) { return place < point.x; });
        if (behind == factors_.begin()) return factors_.front().y;
        if (behind == factors_.end()) return factors_.back().y;
        const glm::dvec2 before = behind[-1];
        const double share = (gradient - before.x) / (behind->x - before.x);
        return before.y + share * (behind->y - before.y);
    }

    std::unique_ptr<const VoxelPainter> inner_;
    GradientScale scale_;
    glm::mat3 worldFromGradient_;
    std::vector<glm::dvec2> factors_;
    double unit_;  // data units a world unit that a gradient of length 1 is
};

}  // namespace

std::unique_ptr<const VoxelPainter> makeFadingPainter(const Volume& volume,
                                                      const std::vector<glm::dvec2>& factors,
                                                      std::unique_ptr<const VoxelPainter> inner) {
    return std::make_unique<FadingPainter>(volume, factors, std::move(inner));
}

}  // namespace deltasplat
