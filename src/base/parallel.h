// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace deltasplat {

/// Calls body(i) for every i in [0, count), on all threads, in any order. Once all threads have
/// stopped, rethrows the first exception of a body.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

/// Calls body(begin, end) for short pieces that cover [0, count), as parallelFor does. Meant for
/// many small items.
void parallelForChunks(std::size_t count,
                       const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body. While this thread waits for other threads in it, the thread takes on no other work,
/// so that a lock may be held meanwhile.
void isolated(const std::function<void()>& body);

}  // namespace deltasplat
