// SPDX-License-Identifier: Apache-2.0
#include "options/file_and_name.h"

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

bool isThere(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
}

}  // namespace

std::optional<FileAndName> findFileAndName(const std::string& option,
                                           const std::filesystem::path& given) {
    if (isThere(given)) return FileAndName{given, ""};
    const std::string text = given.string();
    // Names have colons, and so may files.
    for (std::size_t colon = text.rfind(':'); colon != std::string::npos && colon > 0;
         colon = text.rfind(':', colon - 1)) {
        const std::filesystem::path file = text.substr(0, colon);
        if (!isThere(file)) continue;
        const std::string name = text.substr(colon + 1);
        if (!name.empty()) return FileAndName{file, name};
        throw Error(ErrorCode::kUsage, option, text, "a name behind the colon");
    }
    return {};
}

}  // namespace deltasplat
