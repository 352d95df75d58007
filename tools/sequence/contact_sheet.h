// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>

#include "deltasplat/image/write_image.h"
#include "sequence/frame_sink.h"

namespace deltasplat {

/// All frames in one picture, row by row. Cells without a frame are clear, or have the background.
class ContactSheet : public FrameSink {
  public:
    /// @param cells     columns and rows
    /// @param cellSize  in pixels
    ContactSheet(std::filesystem::path file, glm::ivec2 cells, glm::ivec2 cellSize,
                 ImageFileOptions options, const Image& empty);

    void put(std::size_t i, const Image& image) override;
    void skip(std::size_t) override {}
    void finish() override;

  private:
    std::filesystem::path file_;
    glm::ivec2 cells_;
    ImageFileOptions options_;
    Image sheet_;
};

}  // namespace deltasplat
