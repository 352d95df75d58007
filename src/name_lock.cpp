// SPDX-License-Identifier: Apache-2.0
#include "name_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "cannot_write.h"

namespace deltasplat {
namespace {

// Who can open the file can have others wait: in a folder that others write they have to wait for
// each other, in all others nobody else may.
mode_t modeIn(int folder) {
    struct stat status {};
    const bool shared =
        ::fstat(folder, &status) == 0 && (status.st_mode & (S_IWGRP | S_IWOTH)) != 0;
    return shared ? 0666 : 0600;
}

// Opens the file, which may be another's, or makes it.
Descriptor open(int folder, const std::string& file, const std::filesystem::path& finalPath) {
    constexpr int kFlags = O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    for (;;) {
        // Network file systems lock only what may be written.
        for (const int access : {O_RDWR, O_RDONLY}) {
            Descriptor found(::openat(folder, file.c_str(), access | kFlags));
            if (found) return found;
            if (errno != EACCES) break;
        }
        if (errno != ENOENT) throwCannotWrite(finalPath, errno);
        const int make = O_RDWR | O_CREAT | O_EXCL | kFlags;
        Descriptor made(::openat(folder, file.c_str(), make, modeIn(folder)));
        if (made) return made;
        if (errno != EEXIST) throwCannotWrite(finalPath, errno);
    }
}

// Returns whether the file is locked, or cannot be.
bool lock(int file) {
    int result = 0;
    do {
        result = ::flock(file, LOCK_EX);
    } while (result != 0 && errno == EINTR);
    return result == 0;
}

}  // namespace

NameLock::NameLock(const NameInFolder& name, const std::filesystem::path& finalPath)
    : folder_(name.folder) {
    constexpr std::size_t kMost = 220;  // of the 255 bytes that a name may have
    file_ = ".deltasplat." + name.name.substr(0, kMost) + ".pair.tmp";
    for (;;) {
        lock_ = open(folder_, file_, finalPath);
        // Who had it may have removed the file meanwhile, and another one may have made a new one.
        if (!lock(lock_.get()) || isAt(identityOf(lock_.get()), folder_, file_.c_str())) break;
    }
    place_ = listTemporary({folder_, file_});
}

NameLock::~NameLock() {
    ::unlinkat(folder_, file_.c_str(), 0);
    unlist(place_);
    // Closing would not do while a child process has the descriptor too.
    ::flock(lock_.get(), LOCK_UN);
}

}  // namespace deltasplat
