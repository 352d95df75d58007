// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "output_file.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

// Returns the file that a symbolic link stands for, whether it exists or not.
fs::path followLinks(fs::path file) {
    constexpr int kMaxLinks = 40;  // as many as Linux follows
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(file, error)); ++i) {
        const fs::path target = fs::read_symlink(file, error);
        if (error) break;
        file = file.parent_path() / target;
    }
    return file;
}

// Creates an empty file of its own beside `target`, never touching one that exists.
fs::path createBeside(const fs::path& target, const fs::path& finalPath) {
    static std::atomic<unsigned> counter{0};
    for (;;) {
        const std::string name = ".deltasplat." + std::to_string(::getpid()) + "." +
                                 std::to_string(++counter) + ".tmp" + target.extension().string();
        const fs::path path = target.parent_path() / name;
        const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            return path;
        }
        if (errno != EEXIST) throwCannotWrite(finalPath, errno);
    }
}

}  // namespace

AtomicFile::AtomicFile(fs::path finalPath) : final_(std::move(finalPath)) {
    std::error_code ignored;
    const fs::file_status status = fs::status(final_, ignored);
    if (fs::is_directory(status)) throwCannotWrite(final_, EISDIR);
    if (!final_.has_filename()) throwCannotWrite(final_, ENOENT);

    // Renaming would replace a file that its owner made read-only.
    if (fs::exists(status) && ::access(final_.c_str(), W_OK) != 0) throwCannotWrite(final_, errno);

    if (fs::exists(status) && !fs::is_regular_file(status)) {
        path_ = final_;
        committed_ = true;
    } else {
        path_ = createBeside(followLinks(final_), final_);
    }
}

AtomicFile::~AtomicFile() {
    if (!committed_) ::unlink(path_.c_str());
}

void AtomicFile::commit() {
    if (committed_) return;
    const fs::path target = followLinks(final_);
    // A file that is replaced keeps its permissions; where that fails, the usual ones are fine.
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0) (void)!::chmod(path_.c_str(), old.st_mode & 0777);
    if (std::rename(path_.c_str(), target.c_str()) != 0) throwCannotWrite(final_, errno);
    committed_ = true;
}

void writeFileAtomically(const fs::path& file, std::string_view bytes) {
    OutputFile out(file);
    out.write(bytes.data(), bytes.size());
    out.commit();
}

}  // namespace deltasplat
