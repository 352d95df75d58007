// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "render/render_options.h"
#include "sequence/frame_sink.h"

namespace deltasplat {

/// Declares --contact-sheet, --movie, --fps and --slate.
void addSinkOptions(CLI::App& app, RenderCommand& command);

/// Refuses a command without any output, and what cannot be made of frames. A movie without
/// pictures besides becomes the output.
/// @param pictures  how many a batch makes; 0: there are frames, or a single one
/// @throw Error(kUsage)
void applySinks(const CLI::App& app, RenderCommand& command, std::size_t pictures);

/// Where pictures of frames go besides, or instead of, files of their own.
class SequenceSinks {
  public:
    /// @param metadata  of a sheet, as ImageFileOptions
    /// @throw Error(kOutput) if one of them cannot be made
    SequenceSinks(const RenderCommand& command,
                  const std::vector<std::pair<std::string, std::string>>& metadata);

    /// Whether there are any.
    bool any() const { return !sinks_.empty(); }
    /// Whether frames have files of their own.
    bool areWritten() const { return areWritten_; }
    void put(std::size_t i, const Image& image);
    void skip(std::size_t i);
    /// Makes the files of what has been put, if anything has been.
    void finish();

  private:
    std::atomic<bool> isAnyPut_{false};
    std::vector<std::unique_ptr<FrameSink>> sinks_;
    bool areWritten_;
};

/// Returns the picture of a frame that there is none of: black, or the background, as it is shown.
Image blackPicture(const RenderCommand& command);

}  // namespace deltasplat
