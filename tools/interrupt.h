// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Makes the first SIGINT or SIGTERM only remembered (a second one ends the program at once), and
/// lets writing to a closed pipe or beyond a file size limit fail instead of ending the program.
void handleSignals();

/// Returns whether SIGINT or SIGTERM has arrived.
bool isInterrupted();

/// @throw Error(kInterrupted) if SIGINT or SIGTERM has arrived
void throwIfInterrupted();

}  // namespace deltasplat
