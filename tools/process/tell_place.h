// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// Lets SIGUSR1 show on standard error, in one line, how far the work is and how long it has taken.
void tellPlaceOnSignal();

/// Notes how far the work is. Thread-safe.
/// @param share  0..1
void notePlace(double share);

}  // namespace deltasplat
