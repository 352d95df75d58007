// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace deltasplat {

/// Keeps something until the program ends, when the system takes all memory at once: to free a
/// large tree leaf by leaf takes a tenth of a picture's time. For what is used last.
void leaveToSystem(std::shared_ptr<const void> kept);

}  // namespace deltasplat
