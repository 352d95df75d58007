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

/// The light of one slab of a picture, on its region's base plane: numbers for any process.
struct SlabLayer {
    int slab = 0;       ///< number of the slab, 0..SlabPicture::slabs() - 1
    glm::ivec2 min{0};  ///< pixels [min, max) of the base plane
    glm::ivec2 max{0};
    int channels = 4;  ///< 4: premultiplied RGBA; 1: opacity, if everything seen has one colour
    std::vector<float> values;      ///< [row][column][channels]
    std::vector<glm::ivec2> spans;  ///< [row]: columns [x, y) outside of which a row is zero
};

/// A picture that is rendered slab by slab, here or in other processes that have prepared the same
/// scene. Its pixels are those of PreparedScene::render, bit for bit.
class SlabPicture {
  public:
    /// @throw as PreparedScene::render; Error(kUsage) for a mostJoined above 2
    SlabPicture(const PreparedScene& scene, const Camera& camera, const Listener& listener = {});
    ~SlabPicture();
    SlabPicture(SlabPicture&&) noexcept;
    SlabPicture& operator=(SlabPicture&&) noexcept;

    /// Returns the number of slabs that may be visible. Within a region slabs are numbered from the
    /// front; from an eye, regions follow each other.
    int slabs() const;
    /// Renders a slab. Thread-safe and multi-threaded.
    /// @throw Error(kUsage) if there is no such slab; whatever `listener.progress` throws
    SlabLayer render(int slab, const Listener& listener = {}) const;
    /// Puts the layers of all slabs together.
    /// @param layers  in any order
    /// @throw Error(kUsage) if a layer is missing, is there twice or has another shape than this
    ///        picture's; Error(kFailed) if they do not fit into memory
    Picture fold(std::span<const SlabLayer> layers) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

  private:
    std::unique_ptr<const Impl> impl_;
};

/// Parts `first` to `last`, counted from 1, of a picture in `count` parts of about equal work.
struct SlabShare {
    int first = 1;
    int last = 1;
    int count = 1;
};

inline constexpr int kMostSlabShares = 10'000;

/// Returns "3/8" or "3-5/8".
std::string shareText(const SlabShare& share);

/// Notes in the file of a part: names and texts.
using Notes = std::vector<std::pair<std::string, std::string>>;

struct PartNotes {
    Notes picture;  ///< the same in all parts of one picture
    Notes part;
};

/// Renders a share of a picture's slabs, one after the other, into a file that SlabFiles reads:
/// their layers, packed without loss. The file appears under its final name only when it is whole.
/// With more shares than slabs some files hold no layer. Deterministic; multi-threaded.
/// @throw Error(kUsage) for an impossible share, Error(kOutput), or as SlabPicture::render
void writeSlabs(const SlabPicture& picture, const SlabShare& share, const PartNotes& notes,
                const std::filesystem::path& file, const Listener& listener = {});

/// Files of all slabs of a picture, which give the picture without its volume.
class SlabFiles {
  public:
    /// @param parts  files of all shares of one picture, in any order
    /// @throw Error(kInput) for a file that is no part, is cut short or damaged, belongs to another
    ///        picture or is there twice, and for missing parts
    explicit SlabFiles(std::span<const std::filesystem::path> parts);
    ~SlabFiles();
    SlabFiles(SlabFiles&&) noexcept;
    SlabFiles& operator=(SlabFiles&&) noexcept;

    const Camera& camera() const;
    /// Returns the notes of the picture, and of the part with the first share.
    const PartNotes& notes() const;
    /// Reads the layers and puts them together; call it once.
    /// @throw Error(kInput) for layers that are cut short or damaged, Error(kFailed) if they do not
    ///        fit into memory, whatever `listener.progress` throws
    Picture fold(const Listener& listener = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace deltasplat
