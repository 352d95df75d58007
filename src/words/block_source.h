// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "volume/class_ramps.h"
#include "words/class_reader.h"
#include "words/value_mixer.h"
#include "words/word_writer.h"

namespace deltasplat {

class MixedSight;
class SlotHolder;

/// What sources read with. Null: there is none.
struct SourceTools {
    const PackOptions& options;
    std::span<const Slot> slotMap;
    IndexBox box;                        ///< of what voxels are divided into, (slice, u, v)
    const ClassRamps* ramps = nullptr;   ///< of the map
    const SlotHolder* holder = nullptr;  ///< of voxels that go on as what they were
    const MixedSight* sight = nullptr;   ///< with a mixer
    const CodeTree* codes = nullptr;     ///< that values are mixed from
    const CodeTree* uncut = nullptr;     ///< that gradients are taken of
    const MixMap* mixMap = nullptr;      ///< with a mixer, of the map
};

/// Where the blocks lie that a block becomes where voxels are divided: parts of a column along u
/// and v, and slices of it.
struct DividedBlock {
    Subdivision parts;

    /// Returns the position of a block's first part.
    glm::ivec3 first(const CodeBlock& block) const {
        return (block.position - parts.origin / 8) *
               glm::ivec3(parts.slices, parts.within, parts.within);
    }
    /// Calls use(part) for the parts of a column along u and v.
    template <typename Use>
    void forParts(const Use& use) const {
        for (int u = 0; u < parts.within; ++u)
            for (int v = 0; v < parts.within; ++v) use(glm::ivec2(u, v));
    }
    /// The number of a part of a column.
    static std::size_t numberOf(const glm::ivec2& part) { return std::size_t(2 * part.x + part.y); }
};

/// Reads blocks of a column, one after the other, as classes, and gives them to a writer: each, or
/// the blocks that it becomes. Not for several threads at once.
class BlockSource {
  public:
    virtual ~BlockSource() = default;

    /// Forgets what voxels go on as.
    virtual void beginColumn() = 0;
    virtual void read(const CodeBlock& block, WordWriter& writer) = 0;
    /// Looks that voxels have of their own; null: classes say all.
    virtual BlockLooks* looks() = 0;
    const DividedBlock& divided() const { return divided_; }
    /// Whether it reads blocks around those that it is given.
    bool readsAround() const { return readsAround_; }

  protected:
    BlockSource(const Subdivision& parts, bool readsAround)
        : divided_{parts}, readsAround_(readsAround) {}

  private:
    DividedBlock divided_;
    bool readsAround_;
};

/// Whether a painter chooses the classes of voxels, by what lies around them.
bool choosesClasses(const PackOptions& options);

/// @param tools  what it refers to must outlive the source
std::unique_ptr<BlockSource> makeSource(const SourceTools& tools);

}  // namespace deltasplat
