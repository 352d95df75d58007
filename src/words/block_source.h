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

/// Inputs of sources. Members that do not apply are null.
struct SourceTools {
    const PackOptions& options;
    std::span<const Slot> slotMap;
    IndexBox box;                        ///< of voxels after division, (slice, u, v)
    const ClassRamps* ramps = nullptr;   ///< of the slot map
    const SlotHolder* holder = nullptr;  ///< if voxels are held
    const MixedSight* sight = nullptr;   ///< with a mixer
    const CodeTree* codes = nullptr;     ///< for mixing values
    const CodeTree* uncut = nullptr;     ///< for gradients
    const MixMap* mixMap = nullptr;      ///< of the slot map, with a mixer
};

/// Places of the parts of a divided block: along the slices, u and v.
struct DividedBlock {
    Subdivision parts;

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
    static std::size_t numberOf(const glm::ivec2& part) { return std::size_t(2 * part.x + part.y); }
};

/// Reads a column's blocks in order and passes each, or its parts, to a writer. Not thread-safe.
class BlockSource {
  public:
    virtual ~BlockSource() = default;

    /// Forgets the classes that voxels hold.
    virtual void beginColumn() = 0;
    virtual void read(const CodeBlock& block, WordWriter& writer) = 0;
    /// Own looks of voxels, or null if classes are sufficient.
    virtual BlockLooks* looks() = 0;
    const DividedBlock& divided() const { return divided_; }
    /// Whether the source also reads neighbours of the blocks that it gets.
    bool readsAround() const { return readsAround_; }

  protected:
    BlockSource(const Subdivision& parts, bool readsAround)
        : divided_{parts}, readsAround_(readsAround) {}

  private:
    DividedBlock divided_;
    bool readsAround_;
};

/// Whether a painter chooses the classes of voxels from their neighbourhood.
bool choosesClasses(const PackOptions& options);

/// @param tools  its pointers and references must outlive the source
std::unique_ptr<BlockSource> makeSource(const SourceTools& tools);

}  // namespace deltasplat
