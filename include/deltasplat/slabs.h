// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/picture.h"
#include "deltasplat/prepared_scene.h"
#include "deltasplat/progress.h"
#include "deltasplat/view/camera.h"

namespace deltasplat {

/// The light of one slab of a picture, on the base plane of its region: plain numbers, which may be
/// sent from one process to another.
struct SlabLayer {
    int slab = 0;       ///< number of the slab, 0..SlabPicture::slabs() - 1
    glm::ivec2 min{0};  ///< pixels [min, max) of the base plane
    glm::ivec2 max{0};
    int channels = 4;  ///< 4: premultiplied RGBA; 1: opacity, where all that is seen has one colour
    std::vector<float> values;      ///< [row][column][channels]
    std::vector<glm::ivec2> spans;  ///< [row]: columns [x, y) outside of which a row is zero
};

/// A picture that is rendered slab by slab: by whoever has time, here or in another process that
/// has prepared the same scene. Its pixels are those of PreparedScene::render, bit for bit.
class SlabPicture {
  public:
    /// @throw as PreparedScene::render; Error(kUsage) for a mostJoined above 2
    SlabPicture(const PreparedScene& scene, const Camera& camera, const Listener& listener = {});
    ~SlabPicture();
    SlabPicture(SlabPicture&&) noexcept;
    SlabPicture& operator=(SlabPicture&&) noexcept;

    /// How many slabs there are that something may be seen of; from an eye those of one region
    /// after the other. Within a region they are numbered from the front on.
    int slabs() const;
    /// Renders a slab. Thread-safe; multi-threaded itself.
    /// @throw Error(kUsage) if there is no such slab; whatever `listener.progress` throws
    SlabLayer render(int slab, const Listener& listener = {}) const;
    /// Puts layers together.
    /// @param layers  of all slabs, in any order
    /// @throw Error(kUsage) if a layer is missing, is there twice or has another shape than this
    ///        picture's; Error(kFailed) if they do not fit into memory
    Picture fold(std::span<const SlabLayer> layers) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

  private:
    std::unique_ptr<const Impl> impl_;
};

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
/// without loss, which SlabFiles reads. The file appears under its final name only when it is
/// whole. With more shares than there are slabs some parts hold none. Deterministic;
/// multi-threaded.
/// @throw Error(kUsage) for a share that there is not, Error(kOutput), whatever SlabPicture::render
///        throws
void writeSlabs(const SlabPicture& picture, const SlabShare& share, const PartNotes& notes,
                const std::filesystem::path& file, const Listener& listener = {});

/// Files of all slabs of a picture. They give the picture without its volume.
class SlabFiles {
  public:
    /// Reads what parts say of themselves.
    /// @param parts  files of all shares of one picture, in any order
    /// @throw Error(kInput) for a file that is no part, is cut short or damaged, belongs to another
    ///        picture or is there twice, and for parts that are missing
    explicit SlabFiles(std::span<const std::filesystem::path> parts);
    ~SlabFiles();
    SlabFiles(SlabFiles&&) noexcept;
    SlabFiles& operator=(SlabFiles&&) noexcept;

    const Camera& camera() const;
    /// Those of the picture, and of the part with the first share.
    const PartNotes& notes() const;
    /// Reads layers and puts them together; to be called once.
    /// @throw Error(kInput) for layers that are cut short or damaged, Error(kFailed) if they do not
    ///        fit into memory, whatever `listener.progress` throws
    Picture fold(const Listener& listener = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
