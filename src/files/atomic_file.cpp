// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <optional>
#include <string>
#include <utility>

#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/temporary_file.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

std::atomic<void (*)()> commitGate = nullptr;
std::atomic<bool> syncFiles = false;

}  // namespace

struct AtomicFile::Impl {
    explicit Impl(fs::path path) : finalPath(std::move(path)), target(findTarget(finalPath)) {
        if (target.isDevice) return;
        // What replaces a file may be as private as that was; the system knows about other files.
        const mode_t mode = target.existing ? 0600 : 0666;
        temporary.emplace(target.folder.get(), target.name, mode, finalPath);
    }

    void openDevice() {
        do {
            device = openDirectly(target);
        } while (!device && errno == EINTR);
        struct stat status {};
        if (!device || ::fstat(device.get(), &status) != 0) throwCannotWrite(finalPath, errno);
        // Nothing that it was exchanged for is overwritten.
        if (S_ISREG(status.st_mode) && !target.isOpenFile) throwCannotWrite(finalPath, EEXIST);
    }

    // Makes the new file as accessible as the old one was, and no more.
    void takePermissions() const {
        struct stat old {
        }, own{};
        const int file = temporary->descriptor();
        if (::fstatat(target.folder.get(), target.name.c_str(), &old, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(old.st_mode)) {
            // Gone since: its permissions are known.
            if (target.existing) (void)!::fchmod(file, target.existing->st_mode & 0777);
            return;
        }
        mode_t mode = old.st_mode & 0777;
        if (::fchown(file, old.st_uid, old.st_gid) != 0)
            (void)!::fchown(file, uid_t(-1), old.st_gid);
        // Another group gets no more than everybody.
        if (::fstat(file, &own) == 0 && own.st_gid != old.st_gid)
            mode = (mode & 0707) | (mode & 07) << 3;
        (void)!::fchmod(file, mode);
    }

    // All that can take long or fail before names change.
    void prepare() {
        if (std::exchange(prepared, true) || target.isDevice) return;
        takePermissions();
        syncFile();
    }

    void syncFile() const {
        if (syncFiles && ::fsync(temporary->descriptor()) != 0) throwCannotWrite(finalPath, errno);
    }

    // Folders that cannot be read cannot be asked.
    void syncFolder() const {
        if (!syncFiles) return;
        const int flags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
        const Descriptor folder(::openat(target.folder.get(), ".", flags));
        if (folder && ::fsync(folder.get()) != 0) throwCannotWrite(finalPath, errno);
    }

    void requireAt(const std::string& name) const {
        if (!temporary->isAt(name)) {
            throw Error(ErrorCode::kOutput, finalPath.string(),
                        "another file in place of the one written",
                        "a folder in which others leave files alone");
        }
    }

    // Whether the file had its final name, and has been replaced since by one of the same owner: by
    // another process that writes the same, and has as much right to it.
    bool isReplacedByOwn() const {
        struct stat own {
        }, there{};
        return ::fstat(temporary->descriptor(), &own) == 0 && own.st_nlink == 0 &&
               ::fstatat(target.folder.get(), target.name.c_str(), &there, AT_SYMLINK_NOFOLLOW) ==
                   0 &&
               S_ISREG(there.st_mode) && there.st_uid == own.st_uid;
    }

    fs::path finalPath;
    OutputTarget target;
    std::optional<TemporaryFile> temporary;
    Descriptor device;
    bool closed = false;
    bool prepared = false;
    bool committed = false;
};

AtomicFile::AtomicFile(fs::path finalPath) : impl_(std::make_unique<Impl>(std::move(finalPath))) {}

AtomicFile::~AtomicFile() = default;

int AtomicFile::descriptor() {
    if (!impl_->target.isDevice) return impl_->temporary->descriptor();
    if (!impl_->device) impl_->openDevice();
    return impl_->device.get();
}

bool AtomicFile::isDevice() const {
    return impl_->target.isDevice;
}

const fs::path& AtomicFile::finalPath() const {
    return impl_->finalPath;
}

void AtomicFile::write(const void* bytes, std::size_t size) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(descriptor(), next, size);
        if (written < 0 && errno == EINTR) continue;
        // Nothing written without an error happens on devices that are full.
        if (written <= 0) throwCannotWrite(finalPath(), written < 0 ? errno : ENOSPC);
        next += written;
        size -= std::size_t(written);
    }
}

void AtomicFile::close() {
    if (std::exchange(impl_->closed, true)) return;
    // Network file systems report a full disk when a descriptor is closed, each time.
    if (impl_->target.isDevice) {
        if (impl_->device.reset() != 0) throwCannotWrite(finalPath(), errno);
        return;
    }
    Descriptor copy(::fcntl(descriptor(), F_DUPFD_CLOEXEC, 0));
    if (!copy || copy.reset() != 0) throwCannotWrite(finalPath(), errno);
}

void AtomicFile::commit() {
    Impl& file = *impl_;
    close();
    if (file.target.isDevice || file.committed) return;
    file.prepare();
    if (const auto gate = commitGate.load()) gate();
    file.requireAt(file.temporary->name());
    const int folder = file.target.folder.get();
    if (::renameat(folder, file.temporary->name().c_str(), folder, file.target.name.c_str()) != 0)
        throwCannotWrite(file.finalPath, errno);
    file.temporary->release();
    file.committed = true;
    // In a folder that others may write, somebody may have been quicker.
    if (!file.temporary->isAt(file.target.name) && !file.isReplacedByOwn())
        file.requireAt(file.target.name);
    file.syncFolder();
}

void AtomicFile::commitWithData(AtomicFile& data) {
    close();
    data.close();
    impl_->prepare();
    data.impl_->prepare();
    data.commit();
    commit();
}

bool AtomicFile::isCommitted() const {
    return impl_->committed;
}

void writeFileAtomically(const fs::path& file, std::string_view bytes) {
    AtomicFile out(file);
    out.write(bytes.data(), bytes.size());
    out.commit();
}

void setCommitGate(void (*gate)()) {
    commitGate = gate;
}

void setSyncFiles(bool sync) {
    syncFiles = sync;
}

}  // namespace deltasplat
