// SPDX-License-Identifier: Apache-2.0
#include "parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"

namespace deltasplat {

namespace {

// The arena of the innermost ThreadLimit: TBB's own one never has more threads than the machine has
// cores.
std::atomic<tbb::task_arena*> currentArena{nullptr};

}  // namespace

struct ThreadLimit::Impl {
    explicit Impl(int threads)
        : control(tbb::global_control::max_allowed_parallelism, std::size_t(threads)),
          arena(threads),
          outer(currentArena.exchange(&arena)) {}
    ~Impl() { currentArena = outer; }

    tbb::global_control control;
    tbb::task_arena arena;
    tbb::task_arena* outer;
};

ThreadLimit::ThreadLimit(int threads) {
    if (threads < 0) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("threads", std::to_string(threads), "at least 0 (0 = all)"));
    }
    impl_ = std::make_unique<Impl>(threads == 0 ? hardwareThreads() : threads);
}

int ThreadLimit::hardwareThreads() {
    return tbb::info::default_concurrency();
}

ThreadLimit::~ThreadLimit() = default;

int threadCount() {
    tbb::task_arena* arena = currentArena;
    return arena ? arena->max_concurrency() : tbb::this_task_arena::max_concurrency();
}

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
    // A grain of one keeps threads busy when the pieces differ much in size, as slabs do.
    const auto run = [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              const DefaultFloats floats;
                              for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                          });
    };
    tbb::task_arena* arena = currentArena;
    if (arena) {
        arena->execute(run);
    } else {
        run();
    }
}

void parallelForChunks(std::size_t count,
                       const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t kChunk = 64;
    parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        body(chunk * kChunk, std::min((chunk + 1) * kChunk, count));
    });
}

}  // namespace deltasplat
