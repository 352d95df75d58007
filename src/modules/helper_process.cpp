// SPDX-License-Identifier: Apache-2.0
// The helper is started by posix_spawn: what a process with threads may do between fork() and exec
// is next to nothing, and a fork of a large process takes longer than the helper's start.
#include "modules/helper_process.h"

#include <dlfcn.h>
#include <link.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {
namespace {

constexpr const char* kProgram = "deltasplat-helper";
// Where it is installed, as seen from a program and from a library.
constexpr const char* kFromProgram = DELTASPLAT_HELPER_FROM_BIN;
constexpr const char* kFromLibrary = DELTASPLAT_HELPER_FROM_LIB;

[[noreturn]] void fail(const std::string& why) {
    throw Error(ErrorCode::kFailed, "work in a process of its own failed: " + why);
}

[[noreturn]] void fail(int systemError) {
    fail(std::generic_category().message(systemError));
}

[[noreturn]] void refuse(const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kFailed, kProgram, got, expected);
}

// Without /proc a program is what the system was told to run.
std::filesystem::path programFile() {
    std::error_code error;
    std::filesystem::path program = std::filesystem::canonical("/proc/self/exe", error);
    if (!error) return program;
    const auto* const called = std::bit_cast<const char*>(::getauxval(AT_EXECFN));
    program = std::filesystem::canonical(called ? called : "", error);
    if (error) refuse("/proc/self/exe: " + error.message(), "the place of the program");
    return program;
}

// Returns the shared library that this function is in; nothing if it is linked to the program,
// which has no name among the files that are loaded.
std::optional<std::filesystem::path> libraryFile() {
    Dl_info ignored{};
    link_map* loaded = nullptr;
    const bool isKnown = ::dladdr1(reinterpret_cast<const void*>(&libraryFile), &ignored,
                                   reinterpret_cast<void**>(&loaded), RTLD_DL_LINKMAP) != 0;
    if (!isKnown || !loaded || !loaded->l_name || *loaded->l_name == '\0') return {};
    std::error_code error;
    const std::filesystem::path named = loaded->l_name;
    const std::filesystem::path library = std::filesystem::canonical(named, error);
    if (!error) return library;
    // A relative name means another file once the working folder has changed.
    if (named.is_relative()) refuse(printable(named.string()), "the library's whole path");
    return named;
}

std::string helperFile() {
    std::error_code ignored;
    if (const char* const given = ::secure_getenv("DELTASPLAT_HELPER")) {
        if (std::filesystem::is_regular_file(given, ignored)) return given;
        refuse("no file " + printable(given), "the program that DELTASPLAT_HELPER names");
    }
    const std::optional<std::filesystem::path> library = libraryFile();
    const std::filesystem::path own = library ? *library : programFile();
    const std::filesystem::path beside = own.parent_path() / kProgram;
    const std::filesystem::path installed =
        own.parent_path() / (library ? kFromLibrary : kFromProgram) / kProgram;
    for (const auto& file : {beside, installed})
        if (isTrusted(file, own)) return file.string();
    refuse("none", printable(beside.string()) + " or " +
                       printable(installed.lexically_normal().string()) +
                       ", installed with the library, or DELTASPLAT_HELPER with its place");
}

// What the helper gets: the socket as descriptor 0, no blocked signals, and limits that end it. It
// closes all other descriptors. What is ignored (nohup) stays ignored.
class SpawnSetup {
  public:
    explicit SpawnSetup(int socket) {
        ::posix_spawn_file_actions_init(&files_);
        ::posix_spawnattr_init(&attributes_);
        ::posix_spawn_file_actions_adddup2(&files_, socket, STDIN_FILENO);
        sigset_t signals;
        ::sigemptyset(&signals);
        ::posix_spawnattr_setsigmask(&attributes_, &signals);
        for (const int signal : {SIGXCPU, SIGXFSZ, SIGABRT, SIGIO}) ::sigaddset(&signals, signal);
        ::posix_spawnattr_setsigdefault(&attributes_, &signals);
        ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnSetup() {
        ::posix_spawn_file_actions_destroy(&files_);
        ::posix_spawnattr_destroy(&attributes_);
    }
    SpawnSetup(const SpawnSetup&) = delete;
    SpawnSetup& operator=(const SpawnSetup&) = delete;
    const posix_spawn_file_actions_t* files() const { return &files_; }
    const posix_spawnattr_t* attributes() const { return &attributes_; }

  private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

pid_t spawnHelper(std::string file, std::string work, int socket) {
    char* const arguments[] = {file.data(), work.data(), nullptr};
    const SpawnSetup setup(socket);
    pid_t process = 0;
    const int error = ::posix_spawn(&process, file.c_str(), setup.files(), setup.attributes(),
                                    arguments, ::environ);
    if (error != 0) fail(error);
    return process;
}

// Returns what a request may take: enough for any codec, and no more than there is, but for what a
// process needs to run at all.
std::uint64_t memoryFor(std::size_t bytes) {
    constexpr std::uint64_t kLeast = 64 << 20;
    constexpr std::uint64_t kMost = 1 << 30;
    constexpr std::uint64_t kTimes = 64;
    return std::min(std::max(kLeast, availableMemory()), kMost + kTimes * bytes);
}

}  // namespace

void HelperProcess::start() {
    const std::string file = helperFile();
    requireMemory(kProgram, loaded_);
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail(errno);
    Descriptor ours(ends[0]);
    const Descriptor theirs(ends[1]);
    process_ = spawnHelper(file, work_, theirs.get());
    socket_ = std::move(ours);
    isReady_ = false;
}

// A helper that is at work has nothing to save.
HelperProcess::~HelperProcess() {
    if (process_ == 0) return;
    if (isBusy_) ::kill(process_, SIGKILL);
    awaitEnd();
}

// Returns the status of the process as waitpid gives it; 0 if somebody else asked for it before.
int HelperProcess::awaitEnd() {
    // Somebody may have forked, and holds a copy of the descriptor.
    ::shutdown(socket_.get(), SHUT_RDWR);
    socket_.reset();
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    isBusy_ = false;
    return status;
}

void HelperProcess::beginRequest(std::string_view request, std::size_t bytes) {
    // One that was ended while it had nothing to do is no reason to fail.
    pollfd other{socket_.get(), POLLRDHUP, 0};
    if (process_ != 0 && ::poll(&other, 1, 0) != 0) awaitEnd();
    if (process_ == 0) start();
    bytes_ = bytes;
    isBusy_ = true;
    const HelperMessage message{HelperMessage::kRequest, request.size(), memoryFor(bytes)};
    // finishRequest finds out whether the helper is there to receive it.
    if (sendBytes(socket_.get(), &message, sizeof message))
        sendBytes(socket_.get(), request.data(), request.size());
}

// An installation may be replaced while a program of the one before runs.
void HelperProcess::noteReady(const std::string& version) {
    isReady_ = version == DELTASPLAT_VERSION;
    if (isReady_) return;
    ::kill(process_, SIGKILL);
    awaitEnd();
    refuse("version " + printable(version), DELTASPLAT_VERSION ", as the library");
}

bool HelperProcess::receiveAnswer(std::byte* to, std::string& note) {
    HelperMessage message;
    while (receiveBytes(socket_.get(), &message, sizeof message)) {
        if (message.kind == HelperMessage::kDone)
            return message.bytes == bytes_ && receiveBytes(socket_.get(), to, bytes_);
        if (message.bytes > HelperMessage::kMostNote) return false;
        std::string text(std::size_t(message.bytes), '\0');
        if (!receiveBytes(socket_.get(), text.data(), text.size())) return false;
        if (message.kind == HelperMessage::kReady) {
            noteReady(text);
        } else {
            note = text;
        }
    }
    return false;
}

bool HelperProcess::finishRequest(std::byte* to, std::string* note) {
    if (process_ == 0) fail("nothing was asked for");
    std::string last;
    isBusy_ = !receiveAnswer(to, last);
    if (note) *note = last;
    if (!isBusy_) return true;
    const int status = awaitEnd();
    // No library ends itself like that: it is a lack of memory, or somebody's wish.
    for (const int signal : {SIGKILL, SIGTERM, SIGINT, SIGHUP}) {
        if (WIFSIGNALED(status) && WTERMSIG(status) == signal)
            fail("it was ended by signal " + std::to_string(signal));
    }
    if (!isReady_) fail("it did not start" + (last.empty() ? "" : ": " + printable(last)));
    return false;
}

}  // namespace deltasplat
