// SPDX-License-Identifier: Apache-2.0
#include "output_target.h"

#include <fcntl.h>
#include <limits.h>

#include <array>
#include <cerrno>

#include "cannot_write.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

constexpr int kFolder = O_PATH | O_DIRECTORY | O_CLOEXEC;

// What the system says of the file that a name leads to, links followed; empty if there is none.
std::optional<struct stat> statusOf(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0) return status;
    // A folder that one may not look into, or links in a circle, are no new file.
    if (errno != ENOENT) throwCannotWrite(file, errno);
    return {};
}

// In a folder such as /tmp anybody may have left a link where an output is expected.
bool isTrusted(const struct stat& link, int folder) {
    struct stat around {};
    if (::fstat(folder, &around) != 0) return false;
    const bool shared = (around.st_mode & S_ISVTX) != 0 && (around.st_mode & S_IWOTH) != 0;
    return !shared || link.st_uid == ::geteuid() || link.st_uid == around.st_uid;
}

fs::path contentOf(const Descriptor& link, const fs::path& file) {
    std::array<char, PATH_MAX> text{};
    const ssize_t length = ::readlinkat(link.get(), "", text.data(), text.size());
    if (length <= 0 || std::size_t(length) == text.size()) throwCannotWrite(file, EINVAL);
    return std::string(text.data(), std::size_t(length));
}

bool isSame(const std::optional<struct stat>& a, const std::optional<struct stat>& b) {
    if (!a || !b) return !a && !b;
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

// Finds the entry of a folder that a name which is no device leads to.
OutputTarget followLinks(const fs::path& file) {
    constexpr int kMostLinks = 40;  // as many as Linux follows
    OutputTarget target;
    fs::path path = file;
    for (int links = 0; links <= kMostLinks; ++links) {
        const fs::path parent = path.has_parent_path() ? path.parent_path() : ".";
        const int base = target.folder ? target.folder.get() : AT_FDCWD;
        Descriptor folder(::openat(base, parent.c_str(), kFolder));
        if (!folder) throwCannotWrite(file, errno);
        target.folder = std::move(folder);
        target.name = path.filename().string();
        if (target.name.empty()) throwCannotWrite(file, ENOENT);

        const int flags = O_PATH | O_NOFOLLOW | O_CLOEXEC;
        const Descriptor entry(::openat(target.folder.get(), target.name.c_str(), flags));
        if (!entry && errno == ENOENT) return target;
        struct stat status {};
        if (!entry || ::fstat(entry.get(), &status) != 0) throwCannotWrite(file, errno);
        if (!S_ISLNK(status.st_mode)) {
            target.existing = status;
            return target;
        }
        if (!isTrusted(status, target.folder.get())) throwCannotWrite(file, EACCES);
        path = contentOf(entry, file);
    }
    throwCannotWrite(file, ELOOP);
}

}  // namespace

OutputTarget findTarget(const fs::path& file) {
    const std::optional<struct stat> status = statusOf(file);
    if (status && S_ISDIR(status->st_mode)) throwCannotWrite(file, EISDIR);
    // Renaming would replace a file that its owner made read-only.
    if (status && ::access(file.c_str(), W_OK) != 0) throwCannotWrite(file, errno);

    OutputTarget target;
    if (status && !S_ISREG(status->st_mode)) {
        target.existing = status;
        target.isDevice = true;
        return target;
    }
    target = followLinks(file);
    // The system may follow links that are no paths (/dev/stdout of a file that is gone).
    if (!isSame(status, target.existing)) throwCannotWrite(file, ELOOP);
    return target;
}

}  // namespace deltasplat
