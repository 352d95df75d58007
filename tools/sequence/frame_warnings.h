// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "deltasplat/progress.h"
#include "sequence/frame_options.h"

namespace deltasplat {

/// Returns what to say of a frame, which is named first.
std::string frameLine(const FrameFiles& files, const std::string& what);

/// Warnings of frames: what is said of several in the same words, numbers aside, is shown once, of
/// the first of them whichever was quicker, and counted at the end. Thread-safe.
class FrameWarnings {
  public:
    /// @param frames, listener  must live as long
    FrameWarnings(const std::vector<FrameFiles>& frames, const Listener& listener)
        : frames_(frames), listener_(listener) {}

    void warn(std::size_t i, const std::string& text);
    /// Says that there is nothing more to come of a frame; frames begin in order.
    void finish(std::size_t i);

    /// Says of how many others a warning is.
    void count() const;

    /// Returns "frames", or what else there are several of, after a space.
    std::string word(std::size_t count) const;

  private:
    // What is said of frames in the same words but for numbers.
    struct Warning {
        std::size_t first;  // frame that it is said of
        std::string text;   // without the names of its files
        bool isOfFrames;    // or of all, whatever the frame
        bool hasOtherNumbers;
        std::set<std::size_t> others;
    };

    void show(std::size_t i, const std::string& text);

    const std::vector<FrameFiles>& frames_;
    const Listener& listener_;
    std::mutex mutex_;
    std::size_t next_ = 0;            // the first frame that is not finished
    std::set<std::size_t> finished_;  // behind it
    std::map<std::size_t, std::vector<std::string>> waiting_;  // of frames behind it
    std::map<std::string, Warning> warnings_;                  // by what is said, without numbers
};

}  // namespace deltasplat
