// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <vector>

#include "conversion/conversion_stats.h"
#include "deltasplat/convert/write_volume.h"
#include "listener.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// What a conversion reads and writes.
struct ConversionFiles {
    std::filesystem::path input;
    std::filesystem::path output;
    std::filesystem::path stats;  ///< empty: none

    bool toVdb() const;
};

/// Converts one volume and says what came of it but for bytes and seconds. Thread-safe.
using Convert = std::function<ConversionStats(const ConversionFiles& files, const Listener&)>;

/// Checks an output before the work, of frames that of the first one, whose folder is made.
void checkFirstOutput(const ConversionFiles& files, const FrameChoice& frames,
                      const std::function<void(const std::filesystem::path& output)>& check);

/// Declares the options of sequences, and --stats.
/// @param what  that the file of --stats tells
void addConversionOptions(CLI::App& app, const std::string& what, ConversionFiles& files,
                          FrameChoice& frames);

/// Writes what was read, says what that took away, and notes it.
void writeConverted(const ConversionFiles& files, std::vector<Volume> volumes,
                    const WriteOptions& options, const Listener& listener, ConversionStats& stats);

/// Converts a volume, or those of all frames, several at once; none over a file that it is made of.
/// @return what came of all together
/// @throw as checkConversionFiles and runFrames
ConversionStats runConversion(const CLI::App& app, ConversionFiles files, const FrameChoice& frames,
                              const Session& session, const Convert& convert);

}  // namespace deltasplat
