// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/decode_blocks.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "base/affine.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "formats/delta/column_decoder.h"
#include "formats/delta/delta_columns.h"
#include "formats/delta/restored_grid.h"
#include "volume/code_counts.h"
#include "volume/code_math.h"

namespace deltasplat {
namespace {

// A column to decode, or its part in one slab.
struct Task {
    DeltaColumn column;
    glm::ivec2 range;                 // first and last block of slices
    const DeltaPart* part = nullptr;  // the file's statement, or null
};

// Returns parts for all u and v of the box and `slabs` slabs; parts without deltas are at `rest`.
std::vector<DeltaPart> withRest(const std::vector<DeltaPart>& parts, const BlockLayout& layout,
                                int slabs, Code rest) {
    std::vector<DeltaPart> all;
    auto next = parts.begin();
    for (int u = layout.firstBlock.y; u <= layout.lastBlock.y; ++u) {
        for (int v = layout.firstBlock.z; v <= layout.lastBlock.z; ++v) {
            for (int slab = 0; slab < slabs; ++slab) {
                const bool isNext = next != parts.end() && next->slab == slab &&
                                    next->column.place == glm::ivec2(u, v);
                all.push_back(isNext ? *next++ : DeltaPart{{{u, v}}, slab, rest, rest});
            }
        }
    }
    return all;
}

std::string beginText(const BlockLayout& layout, const DeltaPart& part) {
    return placeText(8 * glm::ivec3(layout.blocksOf(part.slab).x, part.column.place));
}

// Returns the contradiction between blocks' codes and the file's statement, if any.
std::optional<std::string> problemOf(const CodeRange& range, const DeltaPart& part) {
    if (range == std::pair(part.lowest, part.highest)) return std::nullopt;
    return range ? "codes " + std::to_string(range->first) + ".." + std::to_string(range->second)
                 : "no codes";
}

// Decodes columns on all threads.
class TaskDecoder {
  public:
    TaskDecoder(const StreamColumns& deltas, const ColumnDecoder::Grid& grid, std::size_t tasks,
                bool counts)
        : grid_(grid) {
        // Decoders are large: one per thread, not one per piece of work.
        pieces_ = (tasks + kPiece - 1) / kPiece;
        const std::size_t threads = std::min(std::size_t(std::max(1, threadCount())), pieces_);
        if (counts) counts_.emplace(std::max<std::size_t>(1, threads));
        decoders_.reserve(threads);
        for (std::size_t i = 0; i < threads; ++i)
            decoders_.emplace_back(deltas.walker(), grid, counts_ ? &*counts_ : nullptr, i);
    }

    // Returns the blocks in the order of tasks, or nothing for unsound deltas.
    std::optional<std::vector<SlotBlock>> decode(std::span<const Task> tasks,
                                                 const Listener& listener);
    // Range of the codes of left-out blocks, per task.
    std::vector<CodeRange> takeLeftOut() { return std::move(leftOut_); }
    // Number of active voxels per task.
    const std::vector<std::uint64_t>& active() const { return active_; }
    const std::vector<ColumnDecoder>& decoders() const { return decoders_; }
    CodeCounts* counts() { return counts_ ? &*counts_ : nullptr; }
    void moveStorage(SlotStorage& storage) {
        for (ColumnDecoder& decoder : decoders_) {
            std::move(decoder.storage().begin(), decoder.storage().end(),
                      std::back_inserter(storage));
        }
    }

  private:
    static constexpr std::size_t kPiece = 8;  // columns

    ColumnDecoder::Grid grid_;
    std::size_t pieces_;
    std::optional<CodeCounts> counts_;
    std::vector<ColumnDecoder> decoders_;
    std::vector<CodeRange> leftOut_;
    std::vector<std::uint64_t> active_;
};

std::optional<std::vector<SlotBlock>> TaskDecoder::decode(std::span<const Task> tasks,
                                                          const Listener& listener) {
    std::vector<std::vector<SlotBlock>> blocks(pieces_);
    // First contradiction per piece, so that the reported one does not depend on threads.
    std::vector<std::pair<const DeltaPart*, std::string>> problems(pieces_);
    std::atomic<bool> isSound = true;
    std::atomic<std::size_t> next = 0;
    SharedProgress progress(listener);
    leftOut_.assign(tasks.size(), {});
    active_.assign(tasks.size(), 0);
    const auto decodeOne = [&](ColumnDecoder& decoder, std::size_t i, std::size_t piece) {
        const Task& task = tasks[i];
        const std::size_t before = blocks[piece].size();
        const std::uint64_t activeBefore = decoder.activeCount();
        if (!decoder.decode(task.column, task.range, blocks[piece])) return false;
        leftOut_[i] = decoder.leftOut();
        active_[i] = decoder.activeCount() - activeBefore;
        if (!task.part || problems[piece].first) return true;
        const CodeRange made = rangeOf(std::span(blocks[piece]).subspan(before));
        if (auto problem = problemOf(rangeOfBoth(made, leftOut_[i]), *task.part))
            problems[piece] = {task.part, std::move(*problem)};
        return true;
    };
    parallelFor(decoders_.size(), [&](std::size_t thread) {
        for (std::size_t piece = next++; piece < pieces_ && isSound; piece = next++) {
            const std::size_t end = std::min(tasks.size(), (piece + 1) * kPiece);
            for (std::size_t i = piece * kPiece; i < end; ++i)
                if (!decodeOne(decoders_[thread], i, piece)) isSound = false;
            progress.report(double(piece) / double(pieces_));
        }
    });
    if (!isSound) return std::nullopt;
    for (const auto& [part, problem] : problems) {
        if (!part) continue;
        throw Error(ErrorCode::kInput, grid_.where,
                    problem + " from " + beginText(grid_.layout, *part) + " on",
                    std::to_string(part->lowest) + ".." + std::to_string(part->highest) +
                        ", as the stream says");
    }
    std::size_t count = 0;
    for (const auto& some : blocks) count += some.size();
    requireMemory(grid_.where, double(count) * sizeof(SlotBlock));
    std::vector<SlotBlock> all;
    all.reserve(count);
    for (const auto& some : blocks) all.insert(all.end(), some.begin(), some.end());
    return all;
}

IndexBox inVolume(const IndexBox& box, int sliceAxis) {
    if (box.empty()) return {};
    return {fromSliceOrder(box.min, sliceAxis), fromSliceOrder(box.max, sliceAxis)};
}

// Joins the results of all threads. Returns whether they match the header.
bool collect(TaskDecoder& decoder, const DeltaHeader& header, DecodedBlocks& decoded) {
    decoded.histogram = takeHistogram(*decoder.counts());
    std::vector<std::uint64_t> slabDeltas(header.slabDeltas.size());
    IndexBox active;
    const std::uint64_t count =
        std::accumulate(decoded.histogram.begin(), decoded.histogram.end(), std::uint64_t{0});
    for (const ColumnDecoder& one : decoder.decoders()) {
        if (one.slabDeltas().size() != slabDeltas.size()) return false;
        for (std::size_t i = 0; i < slabDeltas.size(); ++i) slabDeltas[i] += one.slabDeltas()[i];
        active = boxOfBoth(active, one.active());
    }
    decoded.active = inVolume(active, header.sliceAxis);
    return slabDeltas == header.slabDeltas && count == header.active;
}

// Whether a header and the places of deltas fit together.
bool mayBeSound(const StreamColumns& deltas, const DeltaHeader& header, const BlockLayout& layout,
                const SlotRules& rules) {
    const auto isInside = [&](const DeltaColumn& column) { return layout.hasColumn(column.place); };
    return header.slabDeltas.size() == std::size_t(layout.slabs()) &&
           (!header.restActive || voxelsOf(header.box) == header.active) &&
           (!header.restActive || layout.canListRest(deltas.blocks())) &&
           rules.lowest <= rules.highest &&
           std::all_of(deltas.columns().begin(), deltas.columns().end(), isInside);
}

std::vector<Task> tasksOf(const std::vector<DeltaPart>& parts, const BlockLayout& layout) {
    std::vector<Task> tasks;
    tasks.reserve(parts.size());
    for (const DeltaPart& part : parts)
        tasks.push_back({part.column, layout.blocksOf(part.slab), &part});
    return tasks;
}

// Returns all columns, or their parts per slab if the file states codes; with active resting ones.
std::vector<DeltaPart> allParts(const StreamColumns& deltas, const DeltaHeader& header,
                                const BlockLayout& layout, const SlotRules& rules,
                                const std::string& where) {
    const KnownCodes* const known = deltas.knownCodes();
    const int slabs = known ? layout.slabs() : 1;
    const double count = header.restActive
                             ? layout.columns() * slabs
                             : double(known ? known->parts.size() : deltas.columns().size());
    requireMemory(where, count * (sizeof(DeltaPart) + sizeof(Task)));
    std::vector<DeltaPart> parts;
    if (known) {
        parts = known->parts;
    } else {
        parts.reserve(deltas.columns().size());
        for (const DeltaColumn& column : deltas.columns()) parts.push_back({column});
    }
    return header.restActive ? withRest(parts, layout, slabs, Code(rules.rest - 1)) : parts;
}

// Decodes parts of known codes on demand.
class PartMaker : public BlockMaker {
  public:
    PartMaker(std::shared_ptr<const DeltaHeader> header,
              std::unique_ptr<const StreamColumns> deltas, const std::string& where)
        : header_(std::move(header)),
          deltas_(std::move(deltas)),
          where_(where),
          layout_(*header_),
          rules_(slotRulesOf(*header_)),
          deltaParts_(allParts(*deltas_, *header_, layout_, rules_, where)) {
        requireMemory(where, double(deltaParts_.size()) * sizeof(Part));
        active_.resize(deltaParts_.size());
        parts_.reserve(deltaParts_.size());
        for (const DeltaPart& part : deltaParts_) {
            const glm::ivec3 first(layout_.blocksOf(part.slab).x, part.column.place);
            parts_.push_back({first, part.lowest, part.highest});
        }
        // Other columns were checked with the index.
        if (header_->restActive && deltas_->knownCodes()->all.histogram[rules_.rest - 1] == 0)
            throw Error(ErrorCode::kInput, where, "no voxels that rest", "some");
    }

    const std::vector<Part>& parts() const override { return parts_; }
    Made make(std::span<const std::size_t> parts, const SeenCodes* seen) const override {
        std::vector<DeltaPart> some;
        some.reserve(parts.size());
        for (const std::size_t part : parts) some.push_back(deltaParts_[part]);
        TaskDecoder decoder(*deltas_, {*header_, layout_, rules_, where_, seen}, some.size(),
                            false);
        auto blocks = decoder.decode(tasksOf(some, layout_), {});
        if (!blocks) fail(some);
        for (std::size_t i = 0; i < parts.size(); ++i) active_[parts[i]] = decoder.active()[i];
        checkActive();
        SlotStorage storage;
        decoder.moveStorage(storage);
        return {std::move(*blocks), decoder.takeLeftOut(), std::move(storage)};
    }

  private:
    // Compares the number of active voxels in all parts made so far with the header.
    void checkActive() const {
        std::uint64_t sum = 0;
        bool areAll = true;
        for (const std::optional<std::uint64_t>& active : active_) {
            sum += active.value_or(0);
            areAll = areAll && active;
        }
        if (areAll || sum > header_->active) requireActiveCount(sum, *header_, where_);
    }
    // Reports the first damaged part.
    [[noreturn]] void fail(const std::vector<DeltaPart>& parts) const {
        const auto isDamaged = [&](const DeltaPart& part) {
            TaskDecoder decoder(*deltas_, {*header_, layout_, rules_, where_}, 1, false);
            const Task task{part.column, layout_.blocksOf(part.slab)};
            return !decoder.decode({&task, 1}, {});
        };
        const auto first = std::find_if(parts.begin(), parts.end(), isDamaged);
        // Only together may the parts have too many voxels.
        const DeltaPart& part = first == parts.end() ? parts.front() : *first;
        throw Error(ErrorCode::kInput, where_,
                    "damaged deltas from " + beginText(layout_, part) + " on",
                    "deltas that add up to codes");
    }

    std::shared_ptr<const DeltaHeader> header_;
    std::unique_ptr<const StreamColumns> deltas_;
    std::string where_;
    BlockLayout layout_;
    SlotRules rules_;
    std::vector<DeltaPart> deltaParts_;
    std::vector<Part> parts_;                                   // per delta part
    mutable std::vector<std::optional<std::uint64_t>> active_;  // voxels of the parts made so far
};

}  // namespace

bool mayDecodeBlocks(const DeltaHeader& header) {
    return !header.exact && header.codeCount < kCodeCount && !header.box.empty() &&
           (!header.restActive || header.inactiveValues.empty());
}

void requireKnownCodes(const CodesInUse& said, const CodesInUse& found, const std::string& where) {
    const auto refuse = [&](const std::string& got, const std::string& expected) {
        throw Error(ErrorCode::kInput, where, got, expected);
    };
    if (found.histogram != said.histogram)
        refuse("voxels of other codes, or other numbers of them", "those that the stream says");
    if (found.active != said.active)
        refuse("another box of active voxels", "the one that the stream says");
}

std::optional<DecodedBlocks> decodeBlocks(const StreamColumns& deltas, const DeltaHeader& header,
                                          const std::string& where, const Listener& listener) {
    const BlockLayout layout(header);
    const SlotRules rules = slotRulesOf(header);
    if (!mayBeSound(deltas, header, layout, rules)) return std::nullopt;
    const KnownCodes* const known = deltas.knownCodes();
    const std::vector<DeltaPart> parts = allParts(deltas, header, layout, rules, where);
    std::vector<Task> tasks = tasksOf(parts, layout);
    if (!known) {
        for (Task& task : tasks) task = {task.column, {layout.firstBlock.x, layout.lastBlock.x}};
    }
    // Nearly all blocks with deltas need slots; the need for more shows on the way.
    requireMemory(where, double(deltas.blocks()) * 512 * sizeof(ShortSlot));
    TaskDecoder decoder(deltas, {header, layout, rules, where}, tasks.size(), true);
    std::optional<std::vector<SlotBlock>> blocks = decoder.decode(tasks, listener);
    DecodedBlocks decoded;
    if (!blocks || !collect(decoder, header, decoded)) return std::nullopt;
    if (known) {
        const IndexBox& active = header.restActive ? header.box : decoded.active;
        requireKnownCodes(known->all, {decoded.histogram, active}, where);
    }
    SlotStorage storage;
    decoder.moveStorage(storage);
    decoded.blocks =
        std::make_shared<SlotBlocks>(header.sliceAxis, std::move(*blocks), std::move(storage));
    return decoded;
}

std::shared_ptr<SlotBlocks> decodeLater(std::shared_ptr<const DeltaHeader> header,
                                        std::unique_ptr<const StreamColumns> deltas,
                                        const std::string& where) {
    if (!deltas->knownCodes() ||
        !mayBeSound(*deltas, *header, BlockLayout(*header), slotRulesOf(*header)))
        return nullptr;
    const int sliceAxis = header->sliceAxis;
    return std::make_shared<SlotBlocks>(
        sliceAxis, std::make_unique<PartMaker>(std::move(header), std::move(deltas), where));
}

}  // namespace deltasplat
