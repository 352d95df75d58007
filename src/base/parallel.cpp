// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"

#ifdef DELTASPLAT_TSAN
extern "C" void __tsan_acquire(void* place);
extern "C" void __tsan_release(void* place);
#endif

namespace deltasplat {

namespace {

// Stands for a thread, also when it has ended: the system gives its number to another then.
using ThreadToken = std::shared_ptr<const char>;

const ThreadToken& thisThread() {
    thread_local const ThreadToken token = std::make_shared<const char>();
    return token;
}

}  // namespace

struct ThreadLimit::Impl {
    explicit Impl(int threads) : arena(threads) {}

    int threads() const { return arena.max_concurrency(); }

    // TBB's own one never has more threads than the machine has cores.
    tbb::task_arena arena;
    ThreadToken maker = thisThread();
};

namespace {

// All limits there are.
class ThreadLimits {
  public:
    using Limit = std::shared_ptr<ThreadLimit::Impl>;

    void add(const Limit& limit) {
        const std::lock_guard lock(mutex_);
        limits_[limit->maker].push_back(limit);
        limitProcess();
    }

    void remove(const Limit& limit) {
        const std::lock_guard lock(mutex_);
        const auto maker = limits_.find(limit->maker);
        std::erase(maker->second, limit);
        if (maker->second.empty()) limits_.erase(maker);
        limitProcess();
    }

    // The one that counts for the calling thread, or null.
    Limit current() {
        const std::lock_guard lock(mutex_);
        const auto maker = limits_.find(thisThread());
        return maker == limits_.end() ? nullptr : maker->second.back();
    }

  private:
    // TBB has as many threads for a process as the machine has cores, or as a control says; of
    // several controls the least counts. So there is one, with what the threads that have limits
    // may use at most.
    void limitProcess() {
        int most = 0;
        for (const auto& [maker, limits] : limits_) most = std::max(most, limits.back()->threads());
        if (most == most_) return;
        most_ = most;
        control_.reset();
        if (most == 0) return;
        control_.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(most));
    }

    std::mutex mutex_;
    std::map<ThreadToken, std::vector<Limit>> limits_;  // by maker, the last made last
    int most_ = 0;
    std::optional<tbb::global_control> control_;
};

ThreadLimits& threadLimits() {
    static ThreadLimits limits;
    return limits;
}

// Calls a function at the end of a block, however that ends.
template <typename Function>
class AtEnd {
  public:
    explicit AtEnd(Function function) : function_(std::move(function)) {}
    ~AtEnd() { function_(); }
    AtEnd(const AtEnd&) = delete;
    AtEnd& operator=(const AtEnd&) = delete;

  private:
    Function function_;
};

// Tells ThreadSanitizer that what was written before is there for what comes after. It does not see
// how TBB's threads wait for each other, and therefore does not look at this file (CMakeLists.txt).
class HandOver {
  public:
#ifdef DELTASPLAT_TSAN
    void give() {
        __tsan_release(this);
    }
    void take() {
        __tsan_acquire(this);
    }
#else
    void give() {}
    void take() {}
#endif
};

}  // namespace

ThreadLimit::ThreadLimit(int threads) {
    if (threads < 0) {
        throw Error(ErrorCode::kUsage, "threads", std::to_string(threads), "at least 0 (0 = all)");
    }
    impl_ = std::make_shared<Impl>(threads == 0 ? hardwareThreads() : threads);
    threadLimits().add(impl_);
}

int ThreadLimit::hardwareThreads() {
    // TBB knows the affinity; what time a cgroup leaves is no number of cores to it.
    static const int processors = std::min(tbb::info::default_concurrency(), cgroupProcessors("/"));
    return processors;
}

ThreadLimit::~ThreadLimit() {
    threadLimits().remove(impl_);
}

int threadCount() {
    const auto limit = threadLimits().current();
    return limit ? limit->threads() : tbb::this_task_arena::max_concurrency();
}

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
    HandOver toOthers, back;
    // A grain of one keeps threads busy when the pieces differ much in size, as slabs do.
    const auto run = [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              toOthers.take();
                              const AtEnd give([&] { back.give(); });
                              const DefaultFloats floats;
                              for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                          });
    };
    // What a body throws comes from another thread, too.
    const AtEnd take([&] { back.take(); });
    toOthers.give();
    const auto limit = threadLimits().current();
    if (limit) {
        limit->arena.execute(run);
    } else {
        run();
    }
}

void isolated(const std::function<void()>& body) {
    tbb::this_task_arena::isolate(body);
}

void parallelForChunks(std::size_t count,
                       const std::function<void(std::size_t, std::size_t)>& body) {
    constexpr std::size_t kChunk = 64;
    parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        body(chunk * kChunk, std::min((chunk + 1) * kChunk, count));
    });
}

}  // namespace deltasplat
