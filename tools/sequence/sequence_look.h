// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/view/world_box.h"
#include "volume/placement.h"

namespace deltasplat {

/// How often values occur in all frames of a sequence: those of one volume as they are, of several
/// each by itself up to kMost different ones, then rounded to fewer and fewer bits. Whatever the
/// order in which they are added.
class ValueCounts {
  public:
    static constexpr std::size_t kMost = 4096;

    void add(double value, std::uint64_t count);
    /// Rounds values until there are kMost at most.
    void limit();
    const std::map<double, std::uint64_t>& counts() const { return counts_; }
    /// How many bits of the 52 behind the point of values are left.
    int bits() const { return bits_; }
    /// How far values may be from those counted, as a share of them.
    double relativeError() const;

  private:
    friend class SequenceLook;
    static double rounded(double value, int bits);

    std::map<double, std::uint64_t> counts_;
    int bits_ = 52;
};

/// The grid that is shown, whatever its name; others are besides.
inline constexpr const char* kMainGrid = "";

/// What all frames of a sequence are shown by, so that nothing changes but what changes in the
/// data: the values and the place of each grid over all frames. First every frame is surveyed (or a
/// file tells what a survey found); from then on a volume that stands for all takes the place of
/// each frame's where ranges, ramps and cameras are chosen. Thread-safe.
class SequenceLook {
  public:
    /// @param keptBytes  what volumes may take that are kept from the survey to be shown
    explicit SequenceLook(double keptBytes) : keptBytes_(keptBytes) {}

    /// Reads a volume as readVolume does; at a survey it is kept, if there is room, and handed out
    /// the next time. What there is to warn of is said then, or where it is read again.
    Volume read(const std::filesystem::path& input, const ReadOptions& options,
                const Listener& listener);
    /// Returns the volume that stands for a grid of all frames; at a survey, a frame's own, which
    /// is noted.
    /// @param frame  its place in the sequence: of the first one is taken what all should share
    const Volume& standIn(std::size_t frame, const std::string& grid, const Volume& volume);
    /// Notes what of a frame is in the picture.
    void addSeen(std::size_t frame, const Volume& volume);

    /// Ends the survey.
    void finish();
    bool isFinished() const { return isFinished_; }
    /// Returns an empty volume around all that is seen of all frames.
    const Volume& seen() const { return seen_; }
    /// Returns the least smallestSize() that kMainGrid has in any frame.
    double smallestVoxelWorld() const { return smallestVoxel_; }

    /// Values that black and white stand for in all frames; empty: they are no greys.
    const std::optional<glm::dvec2>& window() const { return window_; }
    void setWindow(glm::dvec2 window) { window_ = window; }

    /// Returns what the largest volume takes that a survey has read; 0 without one.
    double largestBytes() const { return largestBytes_; }

    nlohmann::ordered_json toJson() const;
    /// Takes what a survey has found instead of making one, and finishes.
    /// @throw std::exception if it is not that of toJson()
    void takeJson(const nlohmann::ordered_json& json);

  private:
    struct Kept {
        Volume volume;
        std::vector<std::string> warnings;  // of reading it
    };
    struct Grid {
        std::size_t volumes = 0;           // with values
        std::optional<std::size_t> order;  // of the frame that is first
        Volume first;                      // without voxels
        ValueCounts values;
        std::map<double, std::uint64_t> mostFrequent;
        std::optional<WorldBox> box;
        std::uint64_t active = 0;
        double least = 0, most = 0;
    };

    static void note(std::size_t frame, const Volume& volume, Grid& grid);
    static Volume whole(const Grid& grid);
    static nlohmann::ordered_json json(const Grid& grid);
    static Grid gridOf(const nlohmann::ordered_json& json);

    mutable std::mutex mutex_;
    std::map<std::string, Grid> grids_;
    Grid seenGrid_;
    std::map<std::string, Volume> wholes_;
    Volume seen_;
    double smallestVoxel_ = 0;
    std::optional<glm::dvec2> window_;
    double keptBytes_;
    double largestBytes_ = 0;
    std::map<std::string, Kept> kept_;  // by input and grid
    bool isFinished_ = false;
};

/// The look of a sequence as one of its frames asks for it.
struct FrameLook {
    SequenceLook& sequence;
    std::size_t frame;

    const Volume& standIn(const std::string& grid, const Volume& volume) const {
        return sequence.standIn(frame, grid, volume);
    }
};

}  // namespace deltasplat
