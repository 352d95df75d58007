// SPDX-License-Identifier: Apache-2.0
#include "render/preview_file.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

// Whether a file holds the mark, which all formats store as it is.
bool isPreview(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!is_regular_file(symlink_status(file, ignored))) return false;
    const std::string mark = std::string("deltasplat:") + kPreviewMark;
    std::ifstream in(file, std::ios::binary);
    std::vector<char> bytes;
    std::vector<char> block(std::size_t{1} << 20);
    while (in.read(block.data(), std::streamsize(block.size())) || in.gcount() > 0) {
        // It may lie across two blocks.
        bytes.erase(bytes.begin(),
                    bytes.end() - std::ptrdiff_t(std::min(bytes.size(), mark.size())));
        bytes.insert(bytes.end(), block.begin(), block.begin() + in.gcount());
        if (std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end()) != bytes.end())
            return true;
    }
    return false;
}

}  // namespace

std::filesystem::path previewFile(const std::filesystem::path& output) {
    std::filesystem::path file = output;
    return file.replace_extension(".preview" + output.extension().string());
}

void requireFreePreview(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!exists(symlink_status(file, ignored)) || isPreview(file)) return;
    throw Error(ErrorCode::kOutput, "--progressive", file.string() + ", a file that is no preview",
                "no file of this name, or what a preview has left");
}

PreviewFile::PreviewFile(std::filesystem::path file)
    : file_(std::move(file)), before_(placeNow()) {}

PreviewFile::~PreviewFile() {
    const Place now = placeNow();
    // What has failed may have been whole before.
    const bool isOwn = written_ ? now == written_ : now != before_ && isPreview(file_);
    if (now && isOwn) (void)::unlink(file_.c_str());
}

void PreviewFile::noteWritten() {
    written_ = placeNow();
}

PreviewFile::Place PreviewFile::placeNow() const {
    struct stat status {};
    if (::lstat(file_.c_str(), &status) != 0) return {};
    return std::pair(status.st_dev, status.st_ino);
}

}  // namespace deltasplat
