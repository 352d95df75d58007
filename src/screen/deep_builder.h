// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec4.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/image/image.h"
#include "screen/clear_image.h"
#include "view/slice_depths.h"

namespace deltasplat {

/// Who is shown a picture stage by stage, as more and more is put behind what is there.
class DeepStages {
  public:
    virtual ~DeepStages() = default;
    /// Says where the slices of stages that follow lie.
    virtual void begin(std::shared_ptr<const SliceDepths> depths) = 0;
    /// Takes the picture as it is now that what lies between two positions of slices has been put
    /// behind the rest.
    /// @param front,back  positions; lines of sight meet `front` first
    /// @throw Error(kFailed) if what is kept of it does not fit into memory
    virtual void add(const Image& picture, double front, double back) = 0;
};

/// Shows stages of a picture behind another one.
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

/// Makes samples of what a picture looks like as more and more is put behind what is there: each
/// sample is what turns one of these pictures into the next.
class DeepBuilder : public DeepStages {
  public:
    /// @param slicesPerSample  for messages
    DeepBuilder(glm::ivec2 size, int slicesPerSample);

    void begin(std::shared_ptr<const SliceDepths> depths) override { depths_ = std::move(depths); }
    /// Multi-threaded.
    void add(const Image& picture, double front, double back) override;
    /// Returns the samples of all. Call it once. Multi-threaded.
    /// @throw Error(kFailed) as add
    DeepImage finish();

  private:
    struct Stage {
        std::shared_ptr<const SliceDepths> depths;
        double front;
        double back;
    };
    // Pixels of a row as they are from a stage on.
    struct Run {
        std::size_t stage;
        int first;
        std::vector<glm::vec4> colors;
    };
    struct Columns {
        int first;
        int last;
    };
    // A pixel as it is from a stage on.
    struct State {
        std::size_t stage;
        glm::vec4 color;
    };
    struct Row {
        std::vector<Run> runs;         // by stage
        std::vector<Columns> changed;  // in the stage that is being added
    };

    std::size_t findChanges(const Image& picture, int y);
    void keepChanges(const Image& picture, int y);
    DeepRow makeRow(int y);
    void addSamples(glm::ivec2 pixel, std::vector<State>& states, DeepRow& row) const;
    DeepSample sampleOf(const DepthLine& line, const Stage& stage, const glm::dvec4& color) const;
    void require(double bytes) const;

    Image shown_;  // the picture of the last stage
    int slicesPerSample_;
    std::shared_ptr<const SliceDepths> depths_;
    std::vector<Stage> stages_;
    std::vector<Row> rows_;
    std::size_t kept_ = 0;  // pixels of all runs
};

}  // namespace deltasplat
