// SPDX-License-Identifier: Apache-2.0
#include "parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"

namespace deltasplat {

namespace {

// TBB has as many threads for a process as the machine has cores, or as a control says; of several
// controls the least counts. So there is one, with the most that any limit asks for.
class ProcessThreads {
  public:
    void add(int threads) {
        const std::lock_guard lock(mutex_);
        limits_.insert(threads);
        update();
    }
    void remove(int threads) {
        const std::lock_guard lock(mutex_);
        limits_.erase(limits_.find(threads));
        update();
    }

  private:
    void update() {
        const int most = limits_.empty() ? 0 : *limits_.rbegin();
        if (most == most_) return;
        most_ = most;
        control_.reset();
        if (most == 0) return;
        control_.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(most));
    }

    std::mutex mutex_;
    std::multiset<int> limits_;
    int most_ = 0;
    std::optional<tbb::global_control> control_;
};

ProcessThreads& processThreads() {
    static ProcessThreads threads;
    return threads;
}

}  // namespace

struct ThreadLimit::Impl {
    explicit Impl(int threads) : threads(threads), arena(threads) {}

    int threads;
    // TBB's own one never has more threads than the machine has cores.
    tbb::task_arena arena;
    std::atomic<bool> ended = false;
};

namespace {

// Of this thread, the innermost last.
using Limits = std::vector<std::shared_ptr<ThreadLimit::Impl>>;

Limits& limitsOfThread() {
    thread_local Limits limits;
    // Limits may end in any order, and on other threads.
    std::erase_if(limits, [](const auto& limit) { return limit->ended.load(); });
    return limits;
}

std::shared_ptr<ThreadLimit::Impl> currentLimit() {
    const Limits& limits = limitsOfThread();
    return limits.empty() ? nullptr : limits.back();
}

}  // namespace

ThreadLimit::ThreadLimit(int threads) {
    if (threads < 0) {
        throw Error(ErrorCode::kUsage,
                    gotExpected("threads", std::to_string(threads), "at least 0 (0 = all)"));
    }
    impl_ = std::make_shared<Impl>(threads == 0 ? hardwareThreads() : threads);
    limitsOfThread().push_back(impl_);
    processThreads().add(impl_->threads);
}

int ThreadLimit::hardwareThreads() {
    return tbb::info::default_concurrency();
}

ThreadLimit::~ThreadLimit() {
    impl_->ended = true;
    processThreads().remove(impl_->threads);
}

int threadCount() {
    const auto limit = currentLimit();
    return limit ? limit->arena.max_concurrency() : tbb::this_task_arena::max_concurrency();
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
    const auto limit = currentLimit();
    if (limit) {
        limit->arena.execute(run);
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
