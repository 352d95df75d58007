// SPDX-License-Identifier: Apache-2.0
#include "image/memory_file.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

[[noreturn]] void fail() {
    throw Error(ErrorCode::kFailed, std::string("a file in memory: ") + std::strerror(errno));
}

}  // namespace

MemoryFile::MemoryFile() : file_(::memfd_create("deltasplat", MFD_CLOEXEC)) {
    if (!file_) fail();
}

std::string MemoryFile::bytes() const {
    struct stat status {};
    if (::fstat(file_.get(), &status) != 0) fail();
    std::string bytes(std::size_t(status.st_size), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count =
            ::pread(file_.get(), bytes.data() + done, bytes.size() - done, off_t(done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail();
        done += std::size_t(count);
    }
    return bytes;
}

}  // namespace deltasplat
