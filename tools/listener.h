// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "deltasplat/progress.h"
#include "options/command_line.h"

namespace deltasplat {

/// Shows on standard error, in one line, what went wrong; fields become flags, as in a warning.
void showError(const std::string& what);

/// Shows on standard error how far the work is: a bar with the time left on a terminal; elsewhere
/// lines `Progress: NN%` for every ten percent, if asked for or verbose from the start, else once
/// the work is long. Quiet, it shows no progress; quiet twice, no warnings either.
class ProgressDisplay {
  public:
    static constexpr double kLongSeconds = 5;

    /// @param longSeconds  from when on work is long
    explicit ProgressDisplay(const CommonOptions& options, double longSeconds = kLongSeconds);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// Returns a listener for the stage whose work is the share from `begin` to `end` of the whole;
    /// it stops the work when the user interrupts. The display must outlive it.
    Listener stage(double begin, double end);

    /// Shows a one-line remark, with flags where the library names fields.
    void warn(const std::string& line);

  private:
    void show(double share);
    double secondsPassed() const;
    void drawBar(int percent);
    void clearBar();

    bool terminal_;
    bool alf_;  // progress is told as a farm's dispatcher wants it
    bool showsProgress_;
    bool showsAllProgress_;  // from the start
    double longSeconds_;
    bool showsWarnings_;
    int shownPercent_ = -1;
    int loggedTens_ = -1;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace deltasplat
