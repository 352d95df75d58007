// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_page_file.h"

#include <system_error>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"
#include "files/file_bytes.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

// "out/" is the folder out.
fs::path withoutSlash(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace

fs::path pageIn(const fs::path& folder) {
    return folder / "index.html";
}

void checkPageFolder(const fs::path& folder, glm::ivec2 pictureSize) {
    if (pictureSize.x > kMaxPngSide || pictureSize.y > kMaxPngSide) {
        throw Error(ErrorCode::kUsage, "--size",
                    std::to_string(pictureSize.x) + "x" + std::to_string(pictureSize.y),
                    "sides of at most " + std::to_string(kMaxPngSide) + " pixels with --report");
    }
    std::error_code ignored;
    if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored))
        throw Error(ErrorCode::kOutput, folder.string(), "a file", "a folder");
    // A folder can be made where a file can.
    const AtomicFile probe(fs::exists(folder, ignored) ? pageIn(folder) : withoutSlash(folder));
}

void writePage(const fs::path& folder, std::string_view page) {
    std::error_code problem;
    const bool made = fs::create_directory(withoutSlash(folder), problem);
    if (problem) throwCannotWrite(folder, problem.value());
    try {
        writeFileAtomically(pageIn(folder), page);
    } catch (...) {
        if (made) fs::remove(folder, problem);
        throw;
    }
}

}  // namespace deltasplat
