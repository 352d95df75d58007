// SPDX-License-Identifier: Apache-2.0
#include "process/run_log.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/temporary_file.h"
#include "process/peak_bytes.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

const char* nameOf(LogLevel level) {
    constexpr std::array kNames{"info", "warning", "error"};
    return kNames[std::size_t(level)];
}

std::string timeText() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

double processorSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// A file that lines are added to.
struct LogFile {
    OutputTarget target;
    Descriptor descriptor;
    bool isNew = false;
};

class RunLog {
  public:
    RunLog(std::filesystem::path name, LogFile file, bool asJson)
        : name_(std::move(name)), file_(std::move(file)), asJson_(asJson) {}

    void add(LogLevel level, const std::string& text, const Json& more) {
        Json json{{"time", timeText()},
                  {"process", int(getpid())},
                  {"level", nameOf(level)},
                  {"text", text}};
        std::string line;
        if (asJson_) {
            json.update(more);
            line = json.dump(-1, ' ', false, Json::error_handler_t::replace);
        } else {
            line = timeText() + " " + std::to_string(getpid()) + " " + nameOf(level) + " " + text;
            for (const auto& [name, value] : more.items()) line += " " + name + "=" + value.dump();
            for (char& c : line)
                if (c == '\n') c = ' ';
        }
        line += '\n';
        const std::lock_guard lock(mutex_);
        // In one piece, for others may write as well.
        const ssize_t count = ::write(file_.descriptor.get(), line.data(), line.size());
        if (count > 0) written_ += count;
        if (count == ssize_t(line.size()) || failed_ != 0) return;
        failed_ = count < 0 ? errno : ENOSPC;
    }

    void drop() const {
        struct stat status {};
        if (file_.isNew && ::fstat(file_.descriptor.get(), &status) == 0 &&
            status.st_size == written_)
            ::unlinkat(file_.target.folder.get(), file_.target.name.c_str(), 0);
    }

    /// Why lines have been lost; empty: none were.
    std::string failure() const { return failed_ == 0 ? "" : std::strerror(failed_); }

    const std::filesystem::path& name() const { return name_; }
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

  private:
    std::filesystem::path name_;
    LogFile file_;
    bool asJson_;
    std::mutex mutex_;
    off_t written_ = 0;
    int failed_ = 0;  // what the system said first
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

std::unique_ptr<RunLog> log;

// Whether a file begins as a log does, or is empty.
bool isLog(int file) {
    char text[64];
    const ssize_t count = pread(file, text, sizeof text, 0);
    if (count <= 0) return true;
    const std::string_view begin(text, std::size_t(count));
    const std::string_view json = R"({"time":")";
    if (begin.substr(0, json.size()) == json) return true;
    constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ ";
    if (begin.size() < kForm.size()) return false;
    return std::equal(kForm.begin(), kForm.end(), begin.begin(), [](char form, char c) {
        return form == 'd' ? c >= '0' && c <= '9' : c == form;
    });
}

// Links are followed as those of other outputs are: not where another user may have put them.
LogFile openLog(const std::filesystem::path& name) {
    LogFile file{findTarget(name), Descriptor(), false};
    const OutputTarget& target = file.target;
    // A pipe that is opened to be read as well does not wait for its reader.
    const auto open = [&](int flags) {
        constexpr int kFlags = O_RDWR | O_APPEND | O_NOFOLLOW | O_NOCTTY | O_CLOEXEC;
        return Descriptor(::openat(target.folder.get(), target.name.c_str(), kFlags | flags, 0666));
    };
    if (!target.isDevice) file.descriptor = open(O_CREAT | O_EXCL);
    file.isNew = bool(file.descriptor);
    if (!file.isNew) file.descriptor = target.isOpenFile ? openDirectly(target) : open(O_CREAT);
    if (!file.descriptor) throwCannotWrite(name, errno);
    return file;
}

}  // namespace

void openRunLog(const std::filesystem::path& file, bool asJson) {
    LogFile opened;
    try {
        opened = openLog(file);
    } catch (const Error& error) {
        throw Error(error.code(), gotExpected("--log", error.what(), "a file that can be written"));
    }
    if (!isLog(opened.descriptor.get())) {
        throw Error(ErrorCode::kUsage, "--log", file.string() + ", which is no log",
                    "a log, or no file yet");
    }
    log = std::make_unique<RunLog>(file, std::move(opened), asJson);
}

std::filesystem::path runLogFile() {
    return log ? log->name() : std::filesystem::path();
}

void dropRunLog() {
    if (log) log->drop();
    log.reset();
}

void logLine(LogLevel level, const std::string& text) {
    if (log) log->add(level, text, Json::object());
}

void logEnd(int exitCode) {
    if (!log) return;
    log->add(exitCode == 0 ? LogLevel::kInfo : LogLevel::kError, "end",
             {{"exit_code", exitCode},
              {"seconds", log->seconds()},
              {"processor_seconds", processorSeconds()},
              {"peak_bytes", peakBytes()}});
    if (const std::string failure = log->failure(); !failure.empty()) {
        std::fprintf(stderr, "deltasplat: warning: --log: lines of %s are lost: %s\n",
                     printable(log->name().string()).c_str(), failure.c_str());
    }
    log.reset();
}

}  // namespace deltasplat
