// SPDX-License-Identifier: Apache-2.0
#include "output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "deltasplat/error.h"

namespace deltasplat {

void throwCannotWrite(const std::filesystem::path& file, int systemError) {
    throw Error(ErrorCode::kOutput, file.string() + ": cannot be written: " +
                                        std::generic_category().message(systemError));
}

OutputFile::OutputFile(const std::filesystem::path& finalPath)
    : file_(finalPath), descriptor_(::open(file_.path().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)) {
    if (descriptor_ < 0) throwCannotWrite(finalPath, errno);
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(const void* bytes, std::size_t size) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, next, size);
        if (written < 0 && errno == EINTR) continue;
        // Nothing written without an error happens on devices that are full.
        if (written <= 0) throwCannotWrite(file_.finalPath(), written < 0 ? errno : ENOSPC);
        next += written;
        size -= std::size_t(written);
    }
}

void OutputFile::close() {
    if (descriptor_ < 0) return;
    // Network file systems report a full disk only when the file is closed.
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) throwCannotWrite(file_.finalPath(), errno);
}

void OutputFile::commit() {
    close();
    file_.commit();
}

}  // namespace deltasplat
