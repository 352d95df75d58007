// SPDX-License-Identifier: Apache-2.0
// The program deltasplat-helper: receives requests, gives them to a module, and sends what that
// answers. HelperProcess (src/modules/helper_process.h) is the other end.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include "helper_work.h"
#include "modules/helper_process.h"

namespace deltasplat {
namespace {

constexpr int kSocket = STDIN_FILENO;

// The other end of the socket closes when its process ends, however that happens. Whoever waits for
// a message sees that; a helper that is busy is told by SIGIO, which ends it. SIGIO also comes with
// messages and with room for them, so it is asked for only while nobody sends any.
void endWithParent(bool ends) {
    ::fcntl(kSocket, F_SETFL, ends ? O_ASYNC : 0);
    pollfd other{kSocket, POLLRDHUP, 0};
    if (ends && ::poll(&other, 1, 0) != 0) ::_exit(0);
}

bool isWorking = false;

bool sendMessage(HelperMessage::Kind kind, std::string_view text) {
    endWithParent(false);
    const HelperMessage message{kind, text.size(), 0};
    const bool isSent = sendBytes(kSocket, &message, sizeof message) &&
                        sendBytes(kSocket, text.data(), text.size());
    endWithParent(isWorking);
    return isSent;
}

bool doWork(HelperWork& work, std::string_view request, std::string& answer, HelperNote note) {
    isWorking = true;
    endWithParent(true);
    const bool isDone = work(request, answer, note);
    isWorking = false;
    endWithParent(false);
    return isDone;
}

std::string currentNote;

void sendNote(std::string_view text) {
    sendMessage(HelperMessage::kNote, text.substr(0, HelperMessage::kMostNote));
}

void keepNote(std::string_view text) {
    currentNote = text;
    sendNote(text);
}

// Only where an exception is being handled.
void sendComplaint() {
    try {
        throw;
    } catch (const std::exception& problem) {
        sendNote(currentNote + problem.what());
    } catch (...) {
        // Nobody knows what it says.
    }
}

// Libraries may end the process while they handle an exception.
[[noreturn]] void endHelper() {
    if (std::current_exception()) sendComplaint();
    ::_exit(0);
}

// Some descriptors of the parent may be open here: those that others than this library have opened.
void closeOthers() {
#ifdef SYS_close_range
    ::syscall(SYS_close_range, unsigned(STDERR_FILENO + 1), ~0U, 0U);
#endif
}

// Puts a file in the place of a descriptor.
void replaceBy(int file, int descriptor) {
    ::dup2(file, descriptor);
    if (file > STDERR_FILENO) ::close(file);
}

// What is printed as an error is kept, for a module to look at.
void printNowhere() {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    const int errors = ::memfd_create("errors", 0);
    if (nowhere < 0 || errors < 0) {
        sendNote("no place for what libraries print");
        ::_exit(1);
    }
    replaceBy(nowhere, STDOUT_FILENO);
    ::fcntl(errors, F_SETFL, O_APPEND);
    replaceBy(errors, STDERR_FILENO);
}

// What this process was given is the most that a request can be.
void keepWithinLimits() {
    for (const auto what : {RLIMIT_AS, RLIMIT_CPU}) {
        rlimit limits{};
        if (::getrlimit(what, &limits) != 0) continue;
        limits.rlim_max = limits.rlim_cur;
        ::setrlimit(what, &limits);
    }
}

void setLimit(int what, rlim_t most) {
    rlimit limits{};
    if (::getrlimit(what, &limits) != 0) return;
    limits.rlim_cur = std::min(most, limits.rlim_max);
    ::setrlimit(what, &limits);
}

// Lets this process take so many bytes of addresses besides those that it has.
void limitMemory(std::uint64_t most) {
    std::ifstream in("/proc/self/statm");
    std::uint64_t pages = 0;
    if (in >> pages) setLimit(RLIMIT_AS, pages * std::uint64_t(::sysconf(_SC_PAGESIZE)) + most);
}

// One minute from now on.
void limitTime() {
    constexpr rlim_t kSeconds = 60;
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    setLimit(RLIMIT_CPU, kSeconds + 1 + rlim_t(used.ru_utime.tv_sec + used.ru_stime.tv_sec));
}

// Modules lie beside the program.
HelperWork* loadWork(const char* program, const std::string& name) {
    const std::filesystem::path own = std::filesystem::canonical(program);
    const std::filesystem::path file = own.parent_path() / ("helper_" + name + ".so");
    if (!isTrusted(file, own)) {
        sendNote("no module " + file.string());
        ::_exit(1);
    }
    void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const work = module ? ::dlsym(module, "deltasplat_helper_work") : nullptr;
    if (work) return reinterpret_cast<HelperWork*>(work);
    const char* const why = ::dlerror();
    sendNote(why ? why : "no module");
    ::_exit(1);
}

bool serveRequest(HelperWork& work) {
    HelperMessage message;
    if (!receiveBytes(kSocket, &message, sizeof message)) return false;
    limitTime();
    limitMemory(message.mostMemory + message.bytes);
    std::string request(std::size_t(message.bytes), '\0');
    if (!receiveBytes(kSocket, request.data(), request.size())) return false;
    (void)!::ftruncate(STDERR_FILENO, 0);
    currentNote.clear();
    std::string answer;
    return doWork(work, request, answer, keepNote) && sendMessage(HelperMessage::kDone, answer);
}

[[noreturn]] void serve(const char* program, const char* name) {
    std::set_terminate(endHelper);
    ::fcntl(kSocket, F_SETOWN, ::getpid());
    closeOthers();
    printNowhere();
    keepWithinLimits();
    setLimit(RLIMIT_CORE, 0);
    constexpr rlim_t kMostPrinted = 1 << 20;
    setLimit(RLIMIT_FSIZE, kMostPrinted);
    HelperWork* const work = loadWork(program, name);
    sendMessage(HelperMessage::kReady, DELTASPLAT_VERSION);
    while (serveRequest(*work)) {
    }
    ::_exit(0);
}

}  // namespace
}  // namespace deltasplat

int main(int count, char** arguments) try {
    constexpr int kArguments = 2;
    if (count == kArguments) deltasplat::serve(arguments[0], arguments[1]);
    std::fputs("deltasplat-helper: deltasplat starts it, nobody else needs to\n", stderr);
    return 2;
} catch (...) {
    deltasplat::endHelper();
}
