// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/render_options.h"

namespace deltasplat {

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// How codes stand for the values of a volume, in words.
struct CodeText {
    std::string book;
    std::string error;
};

CodeText codesOf(const Volume& volume);

/// Returns what every picture says of how it was made.
Metadata commonMetadata(const Session& session);

/// Returns how a picture of a camera is stored, whatever it shows.
ImageFileOptions imageOptions(const RenderCommand& command, const Camera& camera,
                              const Session& session);

/// Returns how a picture is stored, and what it says of how it was made.
/// @param result  all but its image
ImageFileOptions imageOptions(const RenderCommand& command, const CodeText& codes,
                              const RenderResult& result, const Session& session);

/// Adds to how far a picture may be off what a background shows of it: what may be wrong of alpha,
/// is wrong of that as well.
void boundOver(const std::optional<glm::vec4>& background, RenderStats& stats);

/// Says how far the picture may be off: a tolerance is a promise.
void showErrorBound(const RenderStats& stats);

/// Makes light what is stored of it, and says in `file` what that took.
void finishLight(const RenderCommand& command, Image& image, ImageFileOptions& file,
                 const Listener& listener);

}  // namespace deltasplat
