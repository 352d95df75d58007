// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "deltasplat/layered_picture.h"
#include "deltasplat/progress.h"
#include "deltasplat/render_options.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// Some of so many parts of a picture, of about as much work each: those from `first` to `last`,
/// counted from 1.
struct SlabShare {
    int first = 1;
    int last = 1;
    int count = 1;
};

inline constexpr int kMostSlabShares = 10'000;

/// Returns "3/8" or "3-5/8".
std::string shareText(const SlabShare& share);

/// What a part says besides, by names.
using Notes = std::vector<std::pair<std::string, std::string>>;

struct PartNotes {
    Notes picture;  ///< the same in all parts of one
    Notes part;
};

/// Renders a share of a picture's slabs, one after the other, into a file of their layers, packed
/// without loss, which FoldedPicture reads. The file appears under its final name only when it is
/// whole. With more shares than there are slabs some parts hold none. Deterministic;
/// multi-threaded.
/// @throw Error(kUsage) for a share that there is not, Error(kOutput), whatever
///        LayeredPicture::render throws
void writeSlabPart(const LayeredPicture& picture, const SlabShare& share, const PartNotes& notes,
                   const std::filesystem::path& file, const Listener& listener = {});

/// A picture that is put together of the files of its parts, without its volume. Each pixel has the
/// bits that renderComposite gives it.
class FoldedPicture {
  public:
    /// Reads what parts say of themselves.
    /// @param parts  files of all shares of one picture, in any order
    /// @throw Error(kInput) for a file that is no part, is cut short or damaged, belongs to another
    ///        picture or is there twice, and for parts that are missing
    explicit FoldedPicture(std::span<const std::filesystem::path> parts);
    ~FoldedPicture();
    FoldedPicture(FoldedPicture&&) noexcept;
    FoldedPicture& operator=(FoldedPicture&&) noexcept;

    const Camera& camera() const;
    /// Those of the picture, and of the part with the first share.
    const PartNotes& notes() const;
    /// Method, tolerance and number of slabs, and the error bounds of what was shown so far.
    const RenderStats& stats() const;
    /// Reads layers and puts them together; to be called once, before show().
    /// @throw Error(kInput) for layers that are cut short or damaged, Error(kFailed) if they do not
    ///        fit into memory, whatever `listener.progress` throws
    void fold(const Listener& listener = {});
    /// Writes pixels of the picture.
    /// @param part   within the camera's size
    /// @param image  of the part's size
    /// @throw Error(kUsage) if either is not so
    void show(const PixelBox& part, Image& image);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
