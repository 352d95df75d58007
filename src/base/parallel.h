// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace deltasplat {

/// Calls body(i) for every i in [0, count), on all threads, in no particular order; the one place
/// that knows the threading library. Rethrows the first exception of a body after the others have
/// stopped.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

/// Calls body(begin, end) for short pieces that cover [0, count), as parallelFor does: for many
/// small items.
void parallelForChunks(std::size_t count,
                       const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body; while this thread waits for others in it, it takes on no work from elsewhere. For
/// what holds a lock.
void isolated(const std::function<void()>& body);

}  // namespace deltasplat
