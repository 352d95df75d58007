// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "deltasplat/image/deep_image.h"
#include "deltasplat/render.h"

namespace deltasplat {

/// Wall-clock seconds of what the program does around the rendering.
struct RenderTimes {
    double read = 0;
    double write = 0;
    double preview = 0;  ///< 0: none was made
    double total = 0;
};

/// What a deep picture holds.
struct DeepStats {
    int slicesPerSample = 0;  ///< 0: the picture is flat
    std::size_t samples = 0;
    std::size_t mostSamples = 0;  ///< of any pixel
};

DeepStats deepStatsOf(const DeepImage& image, int slicesPerSample);

/// Returns the JSON object of `render --stats`.
std::string statsJson(const RenderResult& result, const Volume& volume, const RenderTimes& times,
                      const DeepStats& deep);

/// Returns "0.02 of the colour and 2 data units", or "0" where nothing is tolerated.
std::string toleranceText(const Tolerance& tolerance);

/// Returns how far the picture may be from the exact one: "color 0.0625, alpha 0.03125", or
/// "unknown".
std::string errorBoundText(const RenderStats& stats);

/// Returns how far codes are from values: "0", or "0.01, 0.0002 of a value".
std::string codeErrorText(const CodeError& error);

/// Returns a few lines for people.
std::string statsSummary(const RenderResult& result, const RenderTimes& times,
                         const DeepStats& deep);

}  // namespace deltasplat
