// SPDX-License-Identifier: Apache-2.0
#include "sequence/run_frames.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "process/terminate.h"
#include "sequence/frame_warnings.h"

namespace deltasplat {
namespace {

class FrameRun {
  public:
    FrameRun(const std::vector<FrameFiles>& frames, bool keepGoing,
             const std::function<void(std::size_t, const Listener&)>& work,
             const Listener& listener)
        : frames_(frames),
          keepGoing_(keepGoing),
          work_(work),
          listener_(listener),
          warnings_(frames, listener) {}

    void run(int workers) {
        workers = int(std::clamp<std::size_t>(std::size_t(workers), 1, frames_.size()));
        const int threadsEach = std::max(1, threadCount() / workers);
        {
            std::vector<std::jthread> threads;
            try {
                for (int i = 1; i < workers; ++i)
                    threads.emplace_back([this, threadsEach] { takeFrames(threadsEach); });
            } catch (const std::system_error&) {
                // Where there are no more threads, those there are take all.
            }
            takeFrames(threadsEach);
        }
        warnings_.count();
        finish();
    }

  private:
    void takeFrames(int threads) {
        const ThreadLimit limit(threads);
        while (!stops_) {
            const std::size_t i = next_++;
            if (i >= frames_.size()) return;
            take(i);
        }
    }

    void take(std::size_t i) {
        try {
            work_(i, listenerOf(i));
            report(i, 1);
        } catch (const Error& error) {
            if (error.code() == ErrorCode::kInterrupted) stops_ = true;
            fail(i, error);
        } catch (const std::exception& problem) {
            fail(i, Error(ErrorCode::kFailed, describe(problem)));
        }
        warnings_.finish(i);
    }

    Listener listenerOf(std::size_t i) {
        Listener listener;
        listener.progress = [this, i](double share) { report(i, share); };
        listener.warning = [this, i](const std::string& text) { warnings_.warn(i, text); };
        return listener;
    }

    void report(std::size_t i, double share) {
        const std::lock_guard lock(mutex_);
        double& known = shares_[i];
        done_ += share - known;
        known = share;
        // Asks about interrupts as well.
        listener_.report(done_ / double(frames_.size()));
    }

    void fail(std::size_t i, const Error& error) {
        const std::lock_guard lock(mutex_);
        failures_.emplace(i, error);
        done_ += 1 - std::exchange(shares_[i], 1);
        if (!keepGoing_) stops_ = true;
        if (error.code() != ErrorCode::kInterrupted) showError(frameLine(frames_[i], error.what()));
    }

    void finish() const {
        if (failures_.empty()) return;
        std::string names;
        constexpr std::size_t kMostNamed = 20;
        std::size_t named = 0;
        for (const auto& [i, error] : failures_) {
            if (error.code() == ErrorCode::kInterrupted) throw error;
            const FrameFiles& files = frames_[i];
            if (named++ < kMostNamed) {
                names += (names.empty() ? "" : ", ") +
                         (files.name.empty() ? std::to_string(files.frame) : files.name);
            }
        }
        if (named > kMostNamed) names += ", ...";
        // Every frame that was begun has ended.
        const std::size_t begun = std::min<std::size_t>(next_, frames_.size());
        const std::size_t left = frames_.size() - begun;
        if (left > 0)
            names += "; " + std::to_string(left) + (left == 1 ? " was" : " were") + " not tried";
        throw Error(failures_.begin()->second.code(), std::to_string(failures_.size()) + " of " +
                                                          std::to_string(frames_.size()) +
                                                          warnings_.word(2) + " failed: " + names);
    }

    const std::vector<FrameFiles>& frames_;
    const bool keepGoing_;
    const std::function<void(std::size_t, const Listener&)>& work_;
    const Listener& listener_;
    std::atomic<std::size_t> next_{0};
    std::atomic<bool> stops_{false};
    std::mutex mutex_;
    std::map<std::size_t, double> shares_;  // of frames begun
    double done_ = 0;
    FrameWarnings warnings_;
    std::map<std::size_t, Error> failures_;
};

}  // namespace

void runFrames(const std::vector<FrameFiles>& frames, bool keepGoing, int workers,
               const std::function<void(std::size_t i, const Listener&)>& work,
               const Listener& listener) {
    if (frames.empty()) return;
    FrameRun(frames, keepGoing, work, listener).run(workers);
}

}  // namespace deltasplat
