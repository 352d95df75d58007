// SPDX-License-Identifier: Apache-2.0
#include "parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"

namespace deltasplat {

struct ThreadLimit::Impl {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
    if (threads < 0) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("threads", std::to_string(threads), "at least 0 (0 = all)"));
    }
    const std::size_t limit =
        threads == 0 ? std::size_t(tbb::info::default_concurrency()) : std::size_t(threads);
    impl_.reset(new Impl{{tbb::global_control::max_allowed_parallelism, limit}});
}

ThreadLimit::~ThreadLimit() = default;

int threadCount() {
    return int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
    // A grain of one keeps threads busy when the pieces differ much in size, as slabs do.
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                      });
}

void parallelForChunks(std::size_t count,
                       const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t kChunk = 64;
    parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        body(chunk * kChunk, std::min((chunk + 1) * kChunk, count));
    });
}

}  // namespace deltasplat
