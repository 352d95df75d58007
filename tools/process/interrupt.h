// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Decides what SIGINT, SIGTERM and SIGHUP do, unless they are ignored already:
/// - While nothing has its final name yet, the first one is remembered: work that listens stops by
///   throwIfInterrupted, and no file gets its final name any more. Work that has not ended within a
///   second, and a second signal, end the program at once; temporary files are removed.
/// - From the first file on that gets its final name, the program goes on to its end, for there is
///   little left to do. What then hangs for a second (a pipe that nobody reads) is ended.
///
/// Lets writing to a closed pipe or beyond a file size limit fail instead of ending the program.
void handleSignals();

/// Says that each file is an output of its own, as frames are: an interrupt is heard between them.
void interruptBetweenFiles();

/// Says that all outputs have been written: whatever comes, the program has done what it was to.
void allIsWritten();

/// Returns whether the work is to stop.
bool isInterrupted();

/// Returns 128 and the number of the first signal, as shells have it: 130 for SIGINT, 143 for
/// SIGTERM, 129 for SIGHUP.
int interruptExitCode();

/// @throw Error(kInterrupted) if the work is to stop
void throwIfInterrupted();

}  // namespace deltasplat
