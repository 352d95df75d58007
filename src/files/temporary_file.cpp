// SPDX-License-Identifier: Apache-2.0
#include "files/temporary_file.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "deltasplat/atomic_file.h"
#include "files/descriptor.h"

namespace deltasplat {

struct TemporaryEntry {
    enum State : int { kFree, kChanging, kTemporary };
    std::atomic<int> state{kFree};
    int folder = -1;
    std::array<char, NAME_MAX + 1> name{};
};

namespace {

using Entry = TemporaryEntry;

// A list that only grows, so that signal handlers can walk it at any time.
struct Entries {
    std::array<Entry, 64> some;
    std::atomic<Entries*> next = nullptr;
};
Entries first;

bool take(Entry& entry, int state) {
    return entry.state.compare_exchange_strong(state, Entry::kChanging);
}

Entry& takeFree() {
    for (Entries* part = &first;;) {
        for (Entry& entry : part->some)
            if (take(entry, Entry::kFree)) return entry;
        Entries* next = part->next;
        if (!next) {
            auto more = std::make_unique<Entries>();
            if (part->next.compare_exchange_strong(next, more.get())) next = more.release();
        }
        part = next;
    }
}

}  // namespace

FileIdentity identityOf(const struct stat& status) {
    return {status.st_dev, status.st_ino};
}

FileIdentity identityOf(int file) {
    struct stat status {};
    return ::fstat(file, &status) == 0 ? identityOf(status) : FileIdentity{};
}

bool isAt(const FileIdentity& file, int folder, const char* name) {
    struct stat status {};
    return file != FileIdentity{} && ::fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
           identityOf(status) == file;
}

TemporaryEntry* listTemporary(const NameInFolder& file) {
    Entry& entry = takeFree();
    entry.folder = file.folder;
    std::strncpy(entry.name.data(), file.name.c_str(), NAME_MAX);
    entry.state = Entry::kTemporary;
    return &entry;
}

void unlist(TemporaryEntry* entry) noexcept {
    if (entry) entry->state = Entry::kFree;
}

void removeTemporaryFiles() noexcept {
    for (Entries* part = &first; part; part = part->next) {
        for (Entry& entry : part->some)
            if (take(entry, Entry::kTemporary)) ::unlinkat(entry.folder, entry.name.data(), 0);
    }
}

namespace {

std::string temporaryName(const std::string& name, int number) {
    // A name may have 255 bytes, and what is added is to fit.
    constexpr std::size_t kMost = 220;
    return ".deltasplat." + name.substr(0, kMost) + "." + std::to_string(number) + ".tmp";
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
    if (isAt(identityOf(file.get()), folder, name.c_str())) ::unlinkat(folder, name.c_str(), 0);
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
    if (taken || !deltasplat::isAt(identityOf(file.get()), folder_, name.c_str())) {
        errno = EEXIST;
        return false;
    }
    file_ = std::move(file);
    name_ = name;
    entry_ = listTemporary({folder_, name_});
    return true;
}

bool TemporaryFile::isAt(const std::string& name) const {
    return deltasplat::isAt(identityOf(file_.get()), folder_, name.c_str());
}

void TemporaryFile::release() {
    unlist(std::exchange(entry_, nullptr));
    name_.clear();
}

}  // namespace deltasplat
