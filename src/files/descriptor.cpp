// SPDX-License-Identifier: Apache-2.0
#include "files/descriptor.h"

#include <system_error>

#include "deltasplat/error.h"

namespace deltasplat {

void throwCannotWrite(const std::filesystem::path& file, int systemError) {
    throw Error(ErrorCode::kOutput, file.string() + ": cannot be written: " +
                                        std::generic_category().message(systemError));
}

void throwNoFolder(const std::filesystem::path& file, const std::filesystem::path& folder) {
    throw Error(ErrorCode::kOutput,
                file.string() + ": cannot be written: there is no folder " + folder.string());
}

}  // namespace deltasplat
