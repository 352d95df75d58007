// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/image.h"
#include "deltasplat/view/camera.h"
#include "screen/clear_image.h"
#include "view/base_plane.h"

namespace deltasplat {

/// Receives a picture stage by stage, as more and more is put behind it.
class DeepStages {
  public:
    virtual ~DeepStages() = default;
    /// Announces the slices of the stages that follow.
    virtual void begin(std::shared_ptr<const SliceDepths> depths) = 0;
    /// Takes the picture after everything between two slice positions was put behind the rest.
    /// @param front,back  positions; lines of sight meet `front` first
    /// @throw Error(kFailed) if memory does not suffice
    virtual void add(const Image& picture, double front, double back) = 0;
};

/// Shows the stages of a picture behind another picture.
class StagesBehind : public DeepStages {
  public:
    StagesBehind(const Image& front, DeepStages& stages)
        : front_(front), shown_(front.size), stages_(stages) {}

    void begin(std::shared_ptr<const SliceDepths> depths) override {
        stages_.begin(std::move(depths));
    }
    void add(const Image& picture, double front, double back) override {
        shown_ = front_;
        putBehind(shown_, {0, 0}, picture);
        stages_.add(shown_, front, back);
    }

  private:
    const Image& front_;
    Image shown_;
    DeepStages& stages_;
};

/// Turns the stages of a picture into samples: each sample turns one stage into the next.
class DeepBuilder : public DeepStages {
  public:
    /// @param slicesPerSample  for messages
    DeepBuilder(glm::ivec2 size, int slicesPerSample);

    void begin(std::shared_ptr<const SliceDepths> depths) override { depths_ = std::move(depths); }
    /// Multi-threaded.
    void add(const Image& picture, double front, double back) override;
    /// Returns all samples. Call it once. Multi-threaded.
    /// @throw Error(kFailed) as add
    DeepImage finish();

  private:
    struct Stage {
        std::shared_ptr<const SliceDepths> depths;
        double front;
        double back;
    };
    // Pixels of a row from a stage on.
    struct Run {
        std::size_t stage;
        int first;
        std::vector<glm::vec4> colors;
    };
    struct Columns {
        int first;
        int last;
    };
    // A pixel from a stage on.
    struct State {
        std::size_t stage;
        glm::vec4 color;
    };
    struct Row {
        std::vector<Run> runs;         // by stage
        std::vector<Columns> changed;  // in the current stage
    };

    std::size_t findChanges(const Image& picture, int y);
    void keepChanges(const Image& picture, int y);
    DeepRow makeRow(int y);
    void addSamples(glm::ivec2 pixel, std::vector<State>& states, DeepRow& row) const;
    DeepSample sampleOf(const DepthLine& line, const Stage& stage, const glm::dvec4& color) const;
    void require(double bytes) const;

    Image shown_;  // the previous stage
    int slicesPerSample_;
    std::shared_ptr<const SliceDepths> depths_;
    std::vector<Stage> stages_;
    std::vector<Row> rows_;
    std::size_t kept_ = 0;  // pixels of all runs
};

/// Finds the depths of what hides something of each pixel, by the growth of alpha from stage to
/// stage. Multi-threaded, with the same result on any number of threads.
class DepthBuilder : public DeepStages {
  public:
    /// How alpha grows within a stage.
    enum class Growth {
        kFog,      ///< as in a homogeneous fog
        kSurface,  ///< linearly, as surfaces are met
    };

    /// @param opacity  for front()
    DepthBuilder(const Camera& camera, double opacity, Growth growth);

    void begin(std::shared_ptr<const SliceDepths> depths) override;
    void add(const Image& picture, double front, double back) override;

    /// Depth (SliceDepths) where alpha passes the opacity for good, `[height][width]`, or kNoDepth.
    std::vector<float> front() const;
    /// Depth behind which alpha grows by less than kLeastGrowth.
    std::vector<float> back() const;
    /// Mean depth, weighted by the growth of alpha.
    std::vector<float> mean() const;
    /// Number of stages in which alpha grows, until less than kLeastGrowth gets through.
    std::vector<float> samples() const;

    static constexpr double kLeastGrowth = 0x1p-10;

  private:
    static constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    // Positions count slices.
    struct Pixel {
        float alpha = 0;
        float alphaAtBack = 0;
        std::uint32_t region = 0;
        std::uint32_t samples = 0;
        double front = kNowhere;
        double back = kNowhere;
        double sum = 0;  // of positions, times the growth of alpha there
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
