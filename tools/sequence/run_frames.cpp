// SPDX-License-Identifier: Apache-2.0
#include "sequence/run_frames.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "process/terminate.h"

namespace deltasplat {
namespace {

// What went wrong may begin with the name, or that of the file, and perhaps a line in it.
std::string lineOf(const FrameFiles& files, const std::string& what) {
    if (files.name.empty()) return "frame " + std::to_string(files.frame) + ": " + what;
    const std::string input = files.input.string();
    if (!input.empty() && what.starts_with(input + ":"))
        return files.name + what.substr(input.size());
    return what.starts_with(files.name + ":") ? what : files.name + ": " + what;
}

bool isOfWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// Without 3, -0.5 and 1e-05, but with what belongs to a name.
std::string withoutNumbers(const std::string& text) {
    std::string rest;
    for (std::size_t i = 0; i < text.size();) {
        const bool begins = std::isdigit(static_cast<unsigned char>(text[i])) != 0 &&
                            (i == 0 || !isOfWord(text[i - 1]));
        if (!begins) {
            rest += text[i++];
            continue;
        }
        if (!rest.empty() && rest.back() == '-') rest.pop_back();
        while (i < text.size() && (isOfWord(text[i]) || text[i] == '.' ||
                                   ((text[i] == '-' || text[i] == '+') && text[i - 1] == 'e')))
            ++i;
    }
    return rest;
}

class FrameRun {
  public:
    FrameRun(const std::vector<FrameFiles>& frames, bool keepGoing,
             const std::function<void(std::size_t, const Listener&)>& work,
             const Listener& listener)
        : frames_(frames), keepGoing_(keepGoing), work_(work), listener_(listener) {}

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
        countWarnings();
        finish();
    }

  private:
    // What is said of frames in the same words but for numbers.
    struct Warning {
        std::size_t first;  // frame that it is said of
        std::string text;   // without the names of its files
        bool isOfFrames;    // or of all, whatever the frame
        bool hasOtherNumbers;
        std::set<std::size_t> others;
    };

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
    }

    Listener listenerOf(std::size_t i) {
        Listener listener;
        listener.progress = [this, i](double share) { report(i, share); };
        listener.warning = [this, i](const std::string& text) { warn(i, text); };
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

    // Shows the first one of its kind.
    void warn(std::size_t i, const std::string& text) {
        const FrameFiles& files = frames_[i];
        std::string about = text;
        for (const auto& file : {files.input.string(), files.output.string()}) {
            const std::size_t at = file.empty() ? std::string::npos : about.find(file);
            if (at != std::string::npos) about.replace(at, file.size(), "");
        }
        const std::lock_guard lock(mutex_);
        const auto [known, isNew] =
            warnings_.emplace(withoutNumbers(about), Warning{i, about, false, false, {}});
        Warning& warning = known->second;
        warning.isOfFrames = warning.isOfFrames || about != text;
        if (isNew) return listener_.warn(lineOf(files, text));
        // All that differs in one frame is shown.
        if (i == warning.first && about != warning.text) listener_.warn(lineOf(files, text));
        if (i == warning.first) return;
        warning.hasOtherNumbers = warning.hasOtherNumbers || about != warning.text;
        warning.others.insert(i);
    }

    // Says of how many others a warning is.
    void countWarnings() const {
        for (const auto& [kind, warning] : warnings_) {
            const std::size_t count = warning.others.size();
            // What is the same of all frames of a sequence need not be counted.
            const bool isOfAll = !warning.isOfFrames && !warning.hasOtherNumbers;
            if (count == 0 || (isOfAll && frames_[0].name.empty())) continue;
            listener_.warn(std::to_string(count) + " other" + frameWord(count) +
                           (warning.hasOtherNumbers ? ", in other numbers: " : ": ") +
                           warning.text.substr(std::min(warning.text.find_first_not_of(": "),
                                                        warning.text.size())));
        }
    }

    std::string frameWord(std::size_t count) const {
        return std::string(frames_[0].name.empty() ? " frame" : " picture") +
               (count > 1 ? "s" : "");
    }

    void fail(std::size_t i, const Error& error) {
        const std::lock_guard lock(mutex_);
        failures_.emplace(i, error);
        done_ += 1 - std::exchange(shares_[i], 1);
        if (!keepGoing_) stops_ = true;
        if (error.code() != ErrorCode::kInterrupted) showError(lineOf(frames_[i], error.what()));
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
                                                          frameWord(2) + " failed: " + names);
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
    std::map<std::string, Warning> warnings_;  // by what is said, without numbers
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
