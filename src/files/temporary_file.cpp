// SPDX-License-Identifier: Apache-2.0
#include "files/temporary_file.h"

#include <fcntl.h>
#include <limits.h>
#include <linux/magic.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

#include "deltasplat/atomic_file.h"
#include "files/file_bytes.h"

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

namespace {

namespace fs = std::filesystem;

constexpr int kFolder = O_PATH | O_DIRECTORY | O_CLOEXEC;
constexpr int kDirectly = O_WRONLY | O_NOCTTY | O_CLOEXEC;

// Where others can put links, only those of this user, of the superuser and of the folder's owner
// say where an output is to go: what else is there anybody may have left.
bool isTrusted(const struct stat& link, int folder) {
    struct stat around {};
    if (::fstat(folder, &around) != 0) return false;
    const bool shared = (around.st_mode & (S_IWGRP | S_IWOTH)) != 0;
    return !shared || link.st_uid == ::geteuid() || link.st_uid == 0 ||
           link.st_uid == around.st_uid;
}

fs::path contentOf(const Descriptor& link, const fs::path& file) {
    std::array<char, PATH_MAX> text{};
    const ssize_t length = ::readlinkat(link.get(), "", text.data(), text.size());
    if (length <= 0 || std::size_t(length) == text.size()) throwCannotWrite(file, EINVAL);
    return std::string(text.data(), std::size_t(length));
}

// Links there (/dev/stdout leads to one) are of open files, and their content is no more than what
// those were called when they were opened.
bool isOfProcesses(int folder) {
    struct statfs system {};
    return ::fstatfs(folder, &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

// What is in a folder under the target's name, if something is: the target, or a link.
Descriptor enterFolder(const fs::path& path, const fs::path& file, OutputTarget& target) {
    const fs::path parent = path.has_parent_path() ? path.parent_path() : ".";
    const int base = target.folder ? target.folder.get() : AT_FDCWD;
    Descriptor folder(::openat(base, parent.c_str(), kFolder));
    if (!folder && errno == ENOENT && path == file) throwNoFolder(file, parent);
    if (!folder) throwCannotWrite(file, errno);
    target.folder = std::move(folder);
    target.name = path.filename().string();
    // A path that ends with "/".
    if (target.name.empty()) throwCannotWrite(file, path.empty() ? ENOENT : EISDIR);
    Descriptor entry(
        ::openat(target.folder.get(), target.name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    if (!entry && errno != ENOENT) throwCannotWrite(file, errno);
    return entry;
}

}  // namespace

OutputTarget findTarget(const fs::path& file) {
    constexpr int kMostLinks = 40;  // as many as Linux follows
    OutputTarget target;
    fs::path path = file;
    for (int links = 0; links <= kMostLinks; ++links) {
        const Descriptor entry = enterFolder(path, file, target);
        if (!entry) return target;
        struct stat status {};
        if (::fstat(entry.get(), &status) != 0) throwCannotWrite(file, errno);
        const bool isLink = S_ISLNK(status.st_mode);
        if (isLink && !isOfProcesses(target.folder.get())) {
            if (!isTrusted(status, target.folder.get())) throwCannotWrite(file, EACCES);
            path = contentOf(entry, file);
            continue;
        }
        const int folder = target.folder.get();
        const char* const name = target.name.c_str();
        if (isLink && ::fstatat(folder, name, &status, 0) != 0) throwCannotWrite(file, errno);
        if (S_ISDIR(status.st_mode)) throwCannotWrite(file, EISDIR);
        // Renaming would replace a file that its owner made read-only. If it is gone, it is new.
        if (::faccessat(folder, name, W_OK, 0) != 0 && errno != ENOENT)
            throwCannotWrite(file, errno);
        target.existing = status;
        target.isOpenFile = isLink;
        target.isDevice = isLink || !S_ISREG(status.st_mode);
        return target;
    }
    throwCannotWrite(file, ELOOP);
}

Descriptor openDirectly(const OutputTarget& target) {
    const int folder = target.folder.get();
    if (!target.isOpenFile)
        return Descriptor(::openat(folder, target.name.c_str(), kDirectly | O_NOFOLLOW));
    // The process's own descriptor, whose place in the file is that of all who share it.
    struct stat there {
    }, own{};
    const int number = std::atoi(target.name.c_str());
    const bool isOwn = ::fstatat(folder, target.name.c_str(), &there, 0) == 0 &&
                       ::fstat(number, &own) == 0 && identityOf(there) == identityOf(own);
    if (isOwn) return Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, 0));
    return Descriptor(::openat(folder, target.name.c_str(), kDirectly | O_APPEND));
}

}  // namespace deltasplat
