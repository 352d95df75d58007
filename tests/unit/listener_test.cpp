// SPDX-License-Identifier: Apache-2.0
#include "listener.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace deltasplat {
namespace {

// What is shown of work that goes on for ever, or is long at once. No test has a terminal for its
// standard error.
std::string shownOf(const CommonOptions& options, bool isLong) {
    testing::internal::CaptureStderr();
    {
        ProgressDisplay display(options, isLong ? 0 : std::numeric_limits<double>::infinity());
        const Listener listener = display.stage(0, 1);
        for (const double share : {0.0, 0.04, 0.12, 0.14, 0.5, 1.0}) listener.report(share);
    }
    return testing::internal::GetCapturedStderr();
}

const std::string kLines = "Progress: 0%\nProgress: 10%\nProgress: 50%\nProgress: 100%\n";

TEST(ProgressDisplay, showsLinesOfLongWorkOffATerminal) {
    EXPECT_EQ(shownOf({}, true), kLines);
    EXPECT_EQ(shownOf({}, false), "");
}

TEST(ProgressDisplay, showsAllThatIsAskedFor) {
    CommonOptions options;
    options.progress = true;
    EXPECT_EQ(shownOf(options, false), kLines);
    options = {};
    options.verbose = true;
    EXPECT_EQ(shownOf(options, false), kLines);
    options = {};
    options.alfProgress = true;
    EXPECT_EQ(shownOf(options, false),
              "ALF_PROGRESS 0%\nALF_PROGRESS 10%\nALF_PROGRESS 50%\nALF_PROGRESS 100%\n");
}

TEST(ProgressDisplay, isQuiet) {
    CommonOptions options;
    options.quiet = 1;
    options.verbose = true;
    EXPECT_EQ(shownOf(options, true), "");
}

}  // namespace
}  // namespace deltasplat
