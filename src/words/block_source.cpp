// SPDX-License-Identifier: Apache-2.0
#include "words/block_source.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "volume/code_blocks.h"
#include "words/class_reader.h"
#include "words/mix_window.h"
#include "words/value_mixer.h"

namespace deltasplat {
namespace {

std::optional<BlockLooks> looksOf(const SourceTools& tools, const Subdivision& parts) {
    const PackOptions& options = tools.options;
    if (!options.painter) return {};
    return std::optional<BlockLooks>(std::in_place, *options.painter, *tools.uncut,
                                     options.sliceAxis, parts, tools.box);
}

// Makes classes of true or held slots.
class Classifier {
  public:
    Classifier(const SourceTools& tools, std::optional<BlockLooks>& looks)
        : holder_(tools.holder), looksHold_(tools.options.looksHold), looks_(looks) {}

    void beginColumn() { held_ = {}; }
    void forget(std::size_t part) { held_[part].fill(kEmptySlot); }
    bool holds() const { return holder_ != nullptr; }

    // @param part    of the column; each part holds its own slots
    // @param number  of the divided block's part
    void classify(const BlockSlots& slots, const glm::ivec3& position, std::size_t part, int number,
                  BlockClasses& classes) {
        if (!holder_) {
            std::copy(slots.begin(), slots.end(), classes.begin());
            if (looks_) looks_->paint(position, number, classes);
        } else if (looks_) {
            holdLooks(slots, position, part, number, classes);
        } else {
            const auto next = [&](Slot before, Slot slot) { return holder_->next(before, slot); };
            holdSlots(slots, held_[part], next,
                      [&](std::size_t i, Slot slot) { classes[i] = holder_->classOf(slot); });
        }
    }

  private:
    // Holds slot and look together; both must allow it.
    [[gnu::noinline]] void holdLooks(const BlockSlots& slots, const glm::ivec3& position,
                                     std::size_t part, int number, BlockClasses& classes) {
        HeldSlots& before = held_[part];
        BlockLooks::Slice& looksBefore = looks_->held(part);
        for (std::size_t i = 0; i < slots.size(); ++i) classes[i] = holder_->classOf(slots[i]);
        looks_->paint(position, number, classes);
        for (std::size_t i = 0; i < slots.size(); ++i) {
            Slot& held = before[i & 63];
            OwnLook& heldOwn = looksBefore[i & 63];
            const VoxelLook look{classes[i], looks_->block()[i]};
            const VoxelLook heldLook{holder_->classOf(held), heldOwn};
            const bool keeps = !(heldLook == look) && holder_->allows(held, slots[i]) &&
                               looksHold_(heldLook, look);
            if (!keeps) {
                held = slots[i];
                heldOwn = look.own;
            }
            classes[i] = holder_->classOf(held);
            looks_->block()[i] = heldOwn;
        }
    }

    const SlotHolder* holder_;
    const std::function<bool(const VoxelLook& held, const VoxelLook& look)>& looksHold_;
    std::optional<BlockLooks>& looks_;
    std::array<HeldSlots, 4> held_{};  // [part]
};

// Shared by sources: a classifier, looks, and the classes of the current block.
class ClassifiedBlocks : public BlockSource {
  public:
    BlockLooks* looks() override { return looks_ ? &*looks_ : nullptr; }
    void beginColumn() override {
        classifier_.beginColumn();
        if (looks_) looks_->beginColumn();
    }

  protected:
    ClassifiedBlocks(const SourceTools& tools, const Subdivision& parts, bool readsAround)
        : BlockSource(parts, readsAround),
          looks_(looksOf(tools, parts)),
          classifier_(tools, looks_) {}

    std::optional<BlockLooks> looks_;
    Classifier classifier_;
    BlockClasses classes_{};
};

// Undivided blocks.
class WholeBlocks : public ClassifiedBlocks {
  public:
    explicit WholeBlocks(const SourceTools& tools)
        : ClassifiedBlocks(tools, {}, false),
          reader_(tools.slotMap, tools.ramps, tools.options.sliceAxis) {}

    void read(const CodeBlock& block, WordWriter& writer) override {
        if (looks_) looks_->beginBlock(block);
        const glm::ivec3& position = block.position;
        if (classifier_.holds()) {
            reader_.read(block, std::span(slots_));
            classifier_.classify(slots_, position, 0, 0, classes_);
        } else {
            reader_.read(block, std::span(classes_));
            if (looks_) looks_->paint(position, 0, classes_);
        }
        writer.add(classes_, looks(), position, 0, 0, writer.range().layout.slicesOf(position.x));
    }

  private:
    ClassReader reader_;
    BlockSlots slots_{};
};

struct Window {
    Window(const CodeTree& codes, int sliceAxis, bool alongSlicesOnly)
        : reader(codes, sliceAxis, alongSlicesOnly) {}

    MixWindowReader reader;
    MixWindow window;
};

// Divided blocks with interpolated values.
class MixedBlocks : public ClassifiedBlocks {
  public:
    explicit MixedBlocks(const SourceTools& tools)
        : MixedBlocks(tools, tools.options.mixer->parts().within == 1) {
        mixed_.resize(std::size_t(divided().parts.voxels()));
    }

    void read(const CodeBlock& block, WordWriter& writer) override {
        if (looks_) looks_->beginBlock(block);
        values_.reader.read(block, values_.window);
        const bool isSeen = tools_.sight->canBeSeen(values_.window);
        if (isSeen) mix(block, writer);
        forBlocks(block, writer,
                  [&](const glm::ivec3& position, int number, std::size_t part, std::size_t row,
                      int slices) {
                      if (isSeen) {
                          classify(position, number, part);
                      } else {
                          classes_.fill(kEmptySlot);
                          classifier_.forget(part);
                      }
                      writer.add(classes_, looks(), position, part, row, slices);
                  });
    }

  protected:
    MixedBlocks(const SourceTools& tools, bool alongSlicesOnly)
        : ClassifiedBlocks(tools, tools.options.mixer->parts(), true),
          tools_(tools),
          values_(*tools.codes, tools.options.sliceAxis, alongSlicesOnly) {}

    // Prepares the parts of a block, of which some may be visible.
    virtual void mix(const CodeBlock&, const WordWriter&) {
        tools_.options.mixer->mix(values_.window, *tools_.mixMap, mixed_);
    }
    // Makes the classes and looks of a part.
    virtual void classify(const glm::ivec3& position, int number, std::size_t part) {
        classifier_.classify(mixed_[std::size_t(number)], position, part, number, classes_);
    }
    // Calls use(position, number, part of column, row, slices) for a block's parts in the box.
    template <typename Use>
    void forBlocks(const CodeBlock& block, const WordWriter& writer, const Use& use) const {
        const Subdivision& parts = divided().parts;
        const SlabLayout& layout = writer.range().layout;
        const glm::ivec3 first = divided().first(block);
        for (int s = 0; s < parts.slices; ++s) {
            divided().forParts([&](const glm::ivec2& part) {
                const glm::ivec3 position(first.x + s, first.y + part.x, first.z + part.y);
                const int slices = layout.slicesOf(position.x);
                if (position.x < layout.firstBlock || slices <= 0) return;
                const int number = (part.x * parts.slices + s) * parts.within + part.y;
                use(position, number, DividedBlock::numberOf(part), std::size_t(part.x), slices);
            });
        }
    }

    SourceTools tools_;
    Window values_;

  private:
    std::vector<BlockSlots> mixed_;  // [part along u][along slices][along v]
};

// Blocks whose classes a painter chooses from the neighbourhood: those of surfaces.
class PaintedBlocks : public MixedBlocks {
  public:
    explicit PaintedBlocks(const SourceTools& tools) : MixedBlocks(tools, false) {
        if (tools.uncut != tools.codes)
            uncut_.emplace(*tools.uncut, tools.options.sliceAxis, false);
        painted_.resize(std::size_t(divided().parts.voxels()));
    }

  private:
    struct PaintedBlock {
        BlockClasses classes;
        std::array<OwnLook, 512> looks;
    };

    void mix(const CodeBlock& block, const WordWriter& writer) override {
        if (uncut_) uncut_->reader.read(block.position, uncut_->window);
        for (PaintedBlock& painted : painted_) painted.classes.fill(0);
        const auto& slots = values_.window.slots;
        const bool hasSurface = painter().heightOfSurface() < OwnLook::kAll;
        const bool hasEnds =
            hasSurface && std::find(slots.begin(), slots.end(), kEmptySlot) != slots.end();
        const glm::ivec3 origin = divided().first(block);
        forBlocks(block, writer,
                  [&](const glm::ivec3& position, int number, std::size_t, std::size_t, int) {
                      looks_->paint(position, number, classes_);
                      const glm::ivec3 first = 8 * (position - origin);
                      if (uncut_) clearCutOff(first);
                      if (hasEnds) closeEnds(first);
                      painted_[std::size_t(number)] = {classes_, looks_->block()};
                  });
        if (divided().parts.divides()) keepSeen();
    }

    void classify(const glm::ivec3&, int number, std::size_t) override {
        classes_ = painted_[std::size_t(number)].classes;
        looks_->block() = painted_[std::size_t(number)].looks;
    }

    const VoxelPainter& painter() const { return *tools_.options.painter; }

    // Returns the undivided voxel, relative to the block, of a part's voxel.
    // @param first  the part's first voxel, relative to the block, in divided voxels
    glm::ivec3 placeOf(const glm::ivec3& first, int voxel) const {
        const Subdivision& parts = divided().parts;
        return (first + glm::ivec3(voxel / 64, voxel / 8 % 8, voxel % 8)) /
               glm::ivec3(parts.slices, parts.within, parts.within);
    }

    // Shows visible voxels undivided if none of their parts is inside of the surface or near to it.
    void keepSeen() {
        constexpr int kNearSurface = OwnLook::kAll / 16;
        const int surface = painter().heightOfSurface();
        const ValueMixer& mixer = *tools_.options.mixer;
        for (int n = 0; n < 512; ++n) {
            const glm::ivec3 place(n / 64, n / 8 % 8, n % 8);
            const Slot own = values_.window.at(place);
            if (own == kEmptySlot || !painter().isSeenItself(Code(own - 1))) continue;
            bool isSeen = false;
            mixer.forPartsOf(place, [&](std::size_t part, std::size_t voxel) {
                const PaintedBlock& painted = painted_[part];
                const int height = painted.looks[voxel].height - kNearSurface;
                isSeen = isSeen || (painted.classes[voxel] != 0 && height <= surface);
            });
            if (isSeen) continue;
            mixer.forPartsOf(place, [&](std::size_t part, std::size_t voxel) {
                painted_[part].classes[voxel] = 1;
                painted_[part].looks[voxel] = {};
            });
        }
    }

    // Clears voxels that only cut values painted: cut, or inactive without active neighbours.
    void clearCutOff(const glm::ivec3& first) {
        for (int n = 0; n < 512; ++n) {
            if (classes_[std::size_t(n)] == 0) continue;
            const glm::ivec3 place = placeOf(first, n);
            if (values_.window.at(place) != kEmptySlot) continue;
            if (uncut_->window.at(place) != kEmptySlot || !values_.window.hasAnyAround(place))
                classes_[std::size_t(n)] = 0;
        }
    }

    // Whether the volume ends or is cut beside a voxel. Inactive voxels with a value are no end.
    bool isAtEnd(const glm::ivec3& place) const {
        const GradientScale* scale = painter().gradientScale();
        const bool endsThere = !scale || !scale->background;
        for (int n = 0; n < 6; ++n) {
            glm::ivec3 beside = place;
            beside[n / 2] += n % 2 == 0 ? -1 : 1;
            if (values_.window.at(beside) != kEmptySlot) continue;
            if (endsThere || (uncut_ && uncut_->window.at(beside) != kEmptySlot)) return true;
        }
        return false;
    }

    // Makes inside voxels at an end fully visible: lines of sight enter there without a surface.
    void closeEnds(const glm::ivec3& first) {
        const int surface = painter().heightOfSurface();
        for (int n = 0; n < 512; ++n) {
            OwnLook& look = looks_->block()[std::size_t(n)];
            if (classes_[std::size_t(n)] == 0 || look.height > surface) continue;
            if (isAtEnd(placeOf(first, n))) look = {};
        }
    }

    std::optional<Window> uncut_;        // the volume before the cut, if surfaces are cut
    std::vector<PaintedBlock> painted_;  // in the order of mixed_
};

}  // namespace

bool choosesClasses(const PackOptions& options) {
    return options.painter && options.painter->choosesClasses();
}

std::unique_ptr<BlockSource> makeSource(const SourceTools& tools) {
    if (choosesClasses(tools.options)) return std::make_unique<PaintedBlocks>(tools);
    if (tools.options.mixer) return std::make_unique<MixedBlocks>(tools);
    return std::make_unique<WholeBlocks>(tools);
}

}  // namespace deltasplat
