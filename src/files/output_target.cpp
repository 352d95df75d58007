// SPDX-License-Identifier: Apache-2.0
#include "files/output_target.h"

#include <fcntl.h>
#include <limits.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "files/descriptor.h"
#include "files/temporary_file.h"

namespace deltasplat {
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
