// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "deltasplat/view/camera.h"
#include "screen/deep_builder.h"

namespace deltasplat {

/// Tells how deep what hides something of each pixel lies, by how alpha grows from stage to stage.
/// Multi-threaded, and the same on any number of threads.
class DepthBuilder : public DeepStages {
  public:
    /// How alpha grows on the way through a stage.
    enum class Growth {
        kFog,      ///< as that of a fog that is everywhere alike
        kSurface,  ///< evenly, as surfaces are met
    };

    /// @param opacity  of front()
    DepthBuilder(const Camera& camera, double opacity, Growth growth);

    void begin(std::shared_ptr<const SliceDepths> depths) override;
    void add(const Image& picture, double front, double back) override;

    /// Depths as SliceDepths counts them, `[height][width]`, kNoDepth where there is none: where
    /// alpha passes the opacity, and stays above.
    std::vector<float> front() const;
    /// Behind which alpha grows by less than kLeastGrowth.
    std::vector<float> back() const;
    /// The mean, by how much alpha grows.
    std::vector<float> mean() const;
    /// By how many stages alpha grows, until less than kLeastGrowth gets through,
    /// `[height][width]`.
    std::vector<float> samples() const;

    static constexpr double kLeastGrowth = 0x1p-10;

  private:
    static constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    // Positions are those of slices.
    struct Pixel {
        float alpha = 0;
        float alphaAtBack = 0;
        std::uint32_t region = 0;
        std::uint32_t samples = 0;
        double front = kNowhere;
        double back = kNowhere;
        double sum = 0;  // of positions, times how much alpha grows there
    };
    struct Stage {
        double front;
        double back;
    };

    void change(Pixel& pixel, float alpha, const Stage& stage) const;
    double passedAt(double before, double after, const Stage& stage) const;
    template <typename PositionOf>
    std::vector<float> depths(const PositionOf& positionOf) const;

    glm::ivec2 size_;
    double nearest_;
    double opacity_;
    Growth growth_;
    std::vector<std::shared_ptr<const SliceDepths>> regions_;
    std::vector<Pixel> pixels_;
};

}  // namespace deltasplat
