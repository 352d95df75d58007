// SPDX-License-Identifier: Apache-2.0
#include "listener.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "flag_names.h"
#include "process/interrupt.h"
#include "process/run_log.h"
#include "process/tell_place.h"

namespace deltasplat {

void showError(const std::string& what) {
    const std::string line = printable(withFlagNames(what));
    std::fprintf(stderr, "deltasplat: %s\n", line.c_str());
    logLine(LogLevel::kError, line);
}

ProgressDisplay::ProgressDisplay(const CommonOptions& options, double longSeconds)
    : terminal_(isatty(STDERR_FILENO) && !options.alfProgress),
      alf_(options.alfProgress),
      showsProgress_(options.quiet == 0),
      showsAllProgress_(terminal_ || options.verbose || options.progress || options.alfProgress),
      longSeconds_(longSeconds),
      showsWarnings_(options.quiet < 2) {}

ProgressDisplay::~ProgressDisplay() {
    clearBar();
}

Listener ProgressDisplay::stage(double begin, double end) {
    Listener listener;
    listener.progress = [this, begin, end](double share) {
        throwIfInterrupted();
        show(begin + (end - begin) * share);
    };
    listener.warning = [this](const std::string& line) { warn(line); };
    return listener;
}

void ProgressDisplay::warn(const std::string& line) {
    const std::string text = printable(withFlagNames(line));
    logLine(LogLevel::kWarning, text);
    if (!showsWarnings_) return;
    clearBar();
    std::fprintf(stderr, "deltasplat: warning: %s\n", text.c_str());
}

void ProgressDisplay::show(double share) {
    notePlace(share);
    const int tens = int(10 * std::clamp(share, 0.0, 1.0) + 1e-9);
    if (tens > loggedTens_) {
        loggedTens_ = tens;
        logLine(LogLevel::kInfo, "Progress: " + std::to_string(10 * tens) + "%");
    }
    if (!showsProgress_ || !(showsAllProgress_ || secondsPassed() >= longSeconds_)) return;
    const int percent = int(100 * std::clamp(share, 0.0, 1.0) + 1e-9);
    const int shown = terminal_ ? percent : percent / 10 * 10;
    if (shown <= shownPercent_) return;
    shownPercent_ = shown;
    if (terminal_) {
        drawBar(percent);
    } else {
        // Standard error is not buffered, so a reader of the pipe sees the line at once.
        std::fprintf(stderr, alf_ ? "ALF_PROGRESS %d%%\n" : "Progress: %d%%\n", shown);
    }
}

double ProgressDisplay::secondsPassed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void ProgressDisplay::drawBar(int percent) {
    constexpr int kWidth = 40;
    const std::string bar(std::size_t(percent * kWidth / 100), '#');
    const int left =
        percent > 0 ? int(std::lround(secondsPassed() * (100 - percent) / percent)) : 0;
    std::fprintf(stderr, "\r[%-*s] %3d%%  %d:%02d left \033[K", kWidth, bar.c_str(), percent,
                 left / 60, left % 60);
}

void ProgressDisplay::clearBar() {
    if (terminal_ && shownPercent_ >= 0) std::fputs("\r\033[K", stderr);
    if (terminal_) shownPercent_ = -1;
}

}  // namespace deltasplat
