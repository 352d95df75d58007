// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace deltasplat {

/// Says that the calling thread is about to allocate so many bytes in small pieces that stay. Its
/// heap then grows in large steps: glibc's allocator else asks the system for every 4 KiB, in all
/// threads but the first one, and while it does, all threads wait for memory.
void expectPieces(std::size_t bytes);

}  // namespace deltasplat
