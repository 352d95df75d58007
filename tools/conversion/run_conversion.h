// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>

#include "conversion/conversion_stats.h"
#include "listener.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// What a conversion reads and writes.
struct ConversionFiles {
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path stats;  ///< empty: none
};

/// Converts one volume and says what came of it but for bytes and seconds. Thread-safe.
using Convert = std::function<ConversionStats(const ConversionFiles& files, const Listener&)>;

/// Declares the options of sequences, and --stats.
/// @param what  that the file of --stats tells
void addConversionOptions(CLI::App& app, const std::string& what, ConversionFiles& files,
                          FrameChoice& frames);

/// Converts a volume, or those of all frames, several at once; none over a file that it is made of.
/// @return what came of all together
/// @throw as checkConversionFiles and runFrames
ConversionStats runConversion(const CLI::App& app, const ConversionFiles& files,
                              const FrameChoice& frames, const Session& session,
                              const Convert& convert);

}  // namespace deltasplat
