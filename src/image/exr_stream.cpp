// SPDX-License-Identifier: Apache-2.0
#include "image/exr_stream.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace deltasplat {

void ExrMemoryStream::write(const char text[], int size) {
    const std::uint64_t end = at_ + std::uint64_t(size);
    if (at_ == bytes_.size()) {
        bytes_.append(text, std::size_t(size));
    } else {
        if (end > bytes_.size()) bytes_.resize(end);
        std::copy(text, text + size, bytes_.begin() + std::ptrdiff_t(at_));
    }
    at_ = end;
}

void ExrFileStream::write(const char text[], int size) {
    int left = problem_ == 0 ? size : 0;
    for (std::uint64_t to = at_; left > 0;) {
        const ssize_t count = ::pwrite(descriptor_, text, std::size_t(left), off_t(to));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            problem_ = count < 0 ? errno : ENOSPC;
            break;
        }
        text += count;
        to += std::uint64_t(count);
        left -= int(count);
    }
    at_ += std::uint64_t(size);
}

}  // namespace deltasplat
