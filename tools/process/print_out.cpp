// SPDX-License-Identifier: Apache-2.0
#include "process/print_out.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

bool readerIsGone = false;

}  // namespace

void printOut(const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (written && std::fflush(stdout) == 0) return;
    readerIsGone = errno == EPIPE;
    throw Error(ErrorCode::kOutput,
                std::string("standard output: cannot be written: ") + std::strerror(errno));
}

bool isReaderGone() {
    return readerIsGone;
}

}  // namespace deltasplat
