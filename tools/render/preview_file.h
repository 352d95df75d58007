// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace deltasplat {

/// What a preview's metadata call the name of the picture that it goes before.
inline constexpr const char* kPreviewMark = "previewOf";

/// Returns the name of a picture's preview, which lies beside it: `smoke.preview.exr`.
std::filesystem::path previewFile(const std::filesystem::path& output);

/// Checks that a preview may have its name: that nothing is there, or what a program that was
/// killed has left.
/// @throw Error(kOutput) if there is anything else
void requireFreePreview(const std::filesystem::path& file);

/// The file of a preview, which goes with this object: if it has been written since that was made,
/// and has not been replaced.
class PreviewFile {
  public:
    explicit PreviewFile(std::filesystem::path file);
    ~PreviewFile();
    PreviewFile(const PreviewFile&) = delete;
    PreviewFile& operator=(const PreviewFile&) = delete;

    /// Notes that the file is whole.
    void noteWritten();

  private:
    // Which file of which disk it is.
    using Place = std::optional<std::pair<dev_t, ino_t>>;

    Place placeNow() const;

    std::filesystem::path file_;
    Place before_;
    Place written_;
};

}  // namespace deltasplat
