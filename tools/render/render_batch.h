// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "batch/index_page.h"
#include "render/batch_items.h"
#include "render/render_options.h"

namespace deltasplat {

/// How pictures of a batch are made.
struct BatchWork {
    /// Finds the volume of an input that only says where one is: all that is read of an input
    /// before it is rendered, so that an Error(kInput) is about this one.
    std::function<void(RenderCommand& command, const Listener& listener)> open;
    /// Makes a command ready that is about one volume, and checks it: what is wrong here is wrong
    /// with all.
    std::function<void(RenderCommand& command, const Listener& listener)> prepare;
    /// Is told of the command that makes the first that can be opened, before any is made.
    std::function<void(const RenderCommand& first)> begin;
    /// Makes the picture of the item with this number.
    std::function<PictureFacts(const RenderCommand& command, std::size_t i,
                               const Listener& listener)>
        make;
    /// Makes what is of all.
    std::function<void()> end;
};

/// Declares the options that only batches have.
void addBatchOptions(CLI::App& app, RenderCommand& command);

/// Returns whether INPUT is a pattern, and refuses what batches or single pictures have not.
/// @throw Error(kUsage)
bool isBatch(const CLI::App& app, const RenderCommand& command);

/// Returns the command that makes one picture, of the command that makes all.
RenderCommand commandOf(const RenderCommand& command, const BatchItem& item);

/// Makes all pictures, several at once, as far as they are wanted and can be made, then the index.
/// @param commandLine  for the index
/// @throw as runFrames; Error(kUsage) before any is made if no picture can be meant so
void renderBatch(const RenderCommand& command, const std::vector<BatchItem>& items,
                 const std::string& commandLine, const BatchWork& work, const Listener& listener);

}  // namespace deltasplat
