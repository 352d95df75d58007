// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "files/file_bytes.h"

namespace deltasplat {

/// What goes to the helper program and comes back: a message, and so many bytes behind it.
struct HelperMessage {
    enum Kind : std::uint64_t {
        kReady,    ///< the helper's version, once
        kRequest,  ///< what is to be done
        kNote,     ///< what the helper is doing; the last one counts
        kDone      ///< the answer
    };
    static constexpr std::uint64_t kMostNote = 4096;

    std::uint64_t kind = kReady;
    std::uint64_t bytes = 0;
    std::uint64_t mostMemory = 0;  ///< that a request may take
};

/// @return whether the other end of the socket took all bytes
inline bool sendBytes(int socket, const void* from, std::size_t bytes) {
    for (const char* at = static_cast<const char*>(from); bytes > 0;) {
        const ssize_t count = ::send(socket, at, bytes, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        bytes -= std::size_t(count);
    }
    return true;
}

/// @return whether all bytes came before the other end was closed
inline bool receiveBytes(int socket, void* to, std::size_t bytes) {
    for (char* at = static_cast<char*>(to); bytes > 0;) {
        const ssize_t count = ::recv(socket, at, bytes, 0);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        bytes -= std::size_t(count);
    }
    return true;
}

/// Whether a program or module may be run: it belongs to root, to the user, or to the owner of
/// `own`, and so does the link that leads to it. Others may write into a folder of programs such as
/// /tmp.
inline bool isTrusted(const std::filesystem::path& file, const std::filesystem::path& own) {
    struct stat link {};
    struct stat status {};
    struct stat ofOwn {};
    if (::lstat(file.c_str(), &link) != 0 || ::stat(file.c_str(), &status) != 0) return false;
    const bool hasOwn = ::stat(own.c_str(), &ofOwn) == 0;
    const auto mayBelong = [&](uid_t user) {
        return user == 0 || user == ::geteuid() || (hasOwn && user == ofOwn.st_uid);
    };
    return S_ISREG(status.st_mode) && mayBelong(link.st_uid) && mayBelong(status.st_uid);
}

/// The program deltasplat-helper (tools/helper/), in which foreign libraries work at foreign bytes,
/// so that one which aborts, hangs or takes all memory ends the helper alone. It starts at the
/// first request and is kept for further ones; after a request that it did not do, the next one
/// starts it anew. It prints nothing. A request has one minute of processor time, and the memory
/// that is left to this process but at most 64 times `bytes` and a GiB. The helper
/// ends with this process, even in the middle of its work. Calls come from one thread at a time.
class HelperProcess {
  public:
    /// @param work   what the helper loads: "dicom" or "colors"
    /// @param bytes  of memory that this takes
    HelperProcess(std::string work, double bytes) : work_(std::move(work)), loaded_(bytes) {}
    ~HelperProcess();
    HelperProcess(const HelperProcess&) = delete;
    HelperProcess& operator=(const HelperProcess&) = delete;

    /// Sends a request whose answer has so many bytes.
    /// @throw Error(kFailed) if the helper is not there, or cannot be started
    void beginRequest(std::string_view request, std::size_t bytes);
    /// Waits for the answer.
    /// @param to    receives its bytes
    /// @param note  if not null: receives the helper's last note; empty if there was none
    /// @return whether the work was done
    /// @throw Error(kFailed) if the helper did not start, or somebody ended it
    bool finishRequest(std::byte* to, std::string* note = nullptr);

  private:
    void start();
    bool receiveAnswer(std::byte* to, std::string& note);
    void noteReady(const std::string& version);
    int awaitEnd();

    std::string work_;
    double loaded_;
    Descriptor socket_;
    pid_t process_ = 0;     // 0: none
    bool isReady_ = false;  // as the helper has said
    bool isBusy_ = false;
    std::size_t bytes_ = 0;
};

}  // namespace deltasplat
