// SPDX-License-Identifier: Apache-2.0
#include "temporary_file.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "cannot_write.h"
#include "deltasplat/atomic_file.h"

namespace deltasplat {
namespace {

// Temporary files of this process, in a form that a signal handler can read.
struct Entry {
    enum State : int { kFree, kChanging, kUsed };
    std::atomic<int> state{kFree};
    int folder = -1;
    std::array<char, NAME_MAX + 1> name{};
};
std::array<Entry, 64> entries;

// Returns its place in the list; -1 if that is full.
int enter(int folder, const std::string& name) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        int expected = Entry::kFree;
        if (!entries[i].state.compare_exchange_strong(expected, Entry::kChanging)) continue;
        entries[i].folder = folder;
        std::strncpy(entries[i].name.data(), name.c_str(), NAME_MAX);
        entries[i].state = Entry::kUsed;
        return int(i);
    }
    return -1;
}

std::string temporaryName(const std::string& name, int number) {
    // A name may have 255 bytes, and what is added is to fit.
    constexpr std::size_t kMost = 220;
    return ".deltasplat." + name.substr(0, kMost) + "." + std::to_string(number) + ".tmp";
}

bool isAt(int file, int folder, const std::string& name) {
    struct stat own {
    }, other{};
    return ::fstat(file, &own) == 0 &&
           ::fstatat(folder, name.c_str(), &other, AT_SYMLINK_NOFOLLOW) == 0 &&
           own.st_dev == other.st_dev && own.st_ino == other.st_ino;
}

// Removes a temporary file of this user that nobody writes any more. Returns whether there is a
// file of that name, or was.
bool removeDead(int folder, const std::string& name) {
    const int flags = O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    const Descriptor file(::openat(folder, name.c_str(), flags));
    if (!file) return errno != ENOENT;
    struct stat status {};
    const bool own = ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode) &&
                     status.st_uid == ::geteuid();
    if (!own || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) return true;
    // Meanwhile it may have got its final name, and another process this one.
    if (isAt(file.get(), folder, name)) ::unlinkat(folder, name.c_str(), 0);
    return true;
}

}  // namespace

TemporaryFile::TemporaryFile(int folder, const std::string& name, mode_t mode,
                             const std::filesystem::path& finalPath)
    : folder_(folder) {
    // Numbers are used from 0 on, as many as there are processes at once.
    constexpr int kMost = 100000;
    constexpr int kGap = 16;
    for (int number = 0, missing = 0; number < kMost && missing < kGap; ++number)
        missing = removeDead(folder, temporaryName(name, number)) ? 0 : missing + 1;

    for (int number = 0; number < kMost; ++number) {
        if (create(temporaryName(name, number), mode)) return;
        if (errno != EEXIST) throwCannotWrite(finalPath, errno);
    }
    throwCannotWrite(finalPath, EEXIST);
}

TemporaryFile::~TemporaryFile() {
    if (name_.empty()) return;
    if (isAt(name_)) ::unlinkat(folder_, name_.c_str(), 0);
    release();
}

bool TemporaryFile::create(const std::string& name, mode_t mode) {
    const int flags = O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    Descriptor file(::openat(folder_, name.c_str(), flags, mode));
    if (!file) return false;
    // Who looks for dead processes may have been here before the lock was.
    const bool taken = ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (taken || !deltasplat::isAt(file.get(), folder_, name)) {
        errno = EEXIST;
        return false;
    }
    file_ = std::move(file);
    name_ = name;
    entry_ = enter(folder_, name_);
    return true;
}

bool TemporaryFile::isAt(const std::string& name) const {
    return deltasplat::isAt(file_.get(), folder_, name);
}

void TemporaryFile::release() {
    if (entry_ >= 0) entries[std::size_t(entry_)].state = Entry::kFree;
    entry_ = -1;
    name_.clear();
}

void removeTemporaryFiles() noexcept {
    for (Entry& entry : entries) {
        int expected = Entry::kUsed;
        if (entry.state.compare_exchange_strong(expected, Entry::kChanging))
            ::unlinkat(entry.folder, entry.name.data(), 0);
    }
}

}  // namespace deltasplat
