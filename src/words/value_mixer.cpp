// SPDX-License-Identifier: Apache-2.0
#include "words/value_mixer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "base/memory.h"
#include "words/mix_window.h"

namespace deltasplat {

namespace {

bool isEven(const CodeBook& book) {
    return book.kind == CodeBook::Kind::kInteger || book.kind == CodeBook::Kind::kLinear;
}

// Buckets on each side of 0.
constexpr std::uint64_t kBuckets = 1 << 15;

}  // namespace

ValueMixer::ValueMixer(const Volume& volume, const Subdivision& parts, bool keepsLone)
    : parts_(parts), keepsLone_(keepsLone), ownLevel_(kCodeCount) {
    VolumeData levels = volume.withoutVoxels().data();
    levels.histogram.assign(kCodeCount, 0);
    const auto occurs = [](std::uint64_t count) { return count != 0; };
    const auto& histogram = volume.histogram();
    const auto lowest = std::find_if(histogram.begin(), histogram.end(), occurs);
    if (lowest == histogram.end()) {
        levels_ = Volume(std::move(levels));
        return;
    }
    const auto highest = std::find_if(histogram.rbegin(), histogram.rend(), occurs).base() - 1;
    if (isEven(volume.codeBook())) {
        makeEvenLevels(int(lowest - histogram.begin()), int(highest - histogram.begin()), levels);
    } else {
        makeTableLevels(volume, levels);
    }
    levels_ = Volume(std::move(levels));
    for (int code = 0; code < kCodeCount; ++code) {
        if (histogram[code] == 0) continue;
        const int steps = (code - even_.lowest) * even_.perCode;
        ownLevel_[code] = Code(even_.perCode != 0 ? steps : levelOfValue(table_.ofCode[code]));
    }
}

void ValueMixer::makeEvenLevels(int lowest, int highest, VolumeData& levels) {
    const int span = highest - lowest;
    // Values mixed by halves and quarters fall on levels, if there are enough.
    const int wanted = parts_.smallestShare();
    // A power of two, so that a code's own value is exact.
    const int room = span == 0 ? 1 : (kCodeCount - 1) / span;
    const int perCode = int(std::bit_floor(unsigned(std::min(wanted, room))));
    even_ = {Code(lowest), perCode, span * perCode};
    std::fill_n(levels.histogram.begin(), even_.last + 1, 1);
    CodeBook& book = levels.codeBook;
    const double lowestValue = book.valueOf(Code(lowest));
    const double step = book.kind == CodeBook::Kind::kLinear ? book.step : 1;
    book.kind = CodeBook::Kind::kLinear;
    book.offset = lowestValue;
    book.step = step / even_.perCode;
}

void ValueMixer::makeTableLevels(const Volume& volume, VolumeData& levels) {
    table_.ofCode.resize(kCodeCount);
    std::vector<double> values;
    for (int code = 0; code < kCodeCount; ++code) {
        if (volume.histogram()[code] == 0) continue;
        table_.ofCode[code] = volume.codeBook().valueOf(Code(code));
        values.push_back(table_.ofCode[code]);
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());

    const std::vector<int> between = levelsBetween(values);
    std::vector<double> all;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        const double half = values[i + 1] / 2 - values[i] / 2;
        table_.rungs.push_back({values[i], half, int(all.size()), between[i]});
        all.push_back(values[i]);
        for (int n = 1; n < between[i]; ++n) {
            const double share = double(n) / between[i];
            all.push_back((1 - share) * values[i] + share * values[i + 1]);
        }
    }
    table_.rungs.push_back({values.back(), 0, int(all.size()), 0});
    all.push_back(values.back());
    makeBuckets();
    std::fill_n(levels.histogram.begin(), all.size(), 1);
    levels.codeBook = CodeBook::ofTable(std::move(all));
}

// Returns the steps between neighbouring values: enough for mixing by quarters or, for distant
// values, steps of 2^-14 of the larger value; fewer if there is no room.
std::vector<int> ValueMixer::levelsBetween(const std::vector<double>& values) const {
    constexpr double kStepsPerValue = 16384;
    std::vector<int> steps;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        const double size = std::max(std::abs(values[i]), std::abs(values[i + 1])) / 2;
        const double apart = size > 0 ? (values[i + 1] / 2 - values[i] / 2) / size : 1;
        const double wanted = std::ceil(std::min(apart, 1.0) * kStepsPerValue);
        steps.push_back(std::max(int(wanted), parts_.smallestShare()));
        sum += steps.back();
    }
    // One step each is always there.
    const double room = double(kCodeCount) - 1 - double(steps.size());
    if (sum <= room) return steps;
    for (int& count : steps) count = 1 + int(count * (room / sum));
    return steps;
}

void ValueMixer::makeBuckets() {
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t most = 0;
    for (const TableLevels::Rung& rung : table_.rungs) {
        if (rung.value == 0) continue;
        const auto bits = std::bit_cast<std::uint64_t>(std::abs(rung.value));
        least = std::min(least, bits);
        most = std::max(most, bits);
    }
    table_.least = std::min(least, most);
    while ((most - table_.least) >> table_.dropped >= kBuckets) ++table_.dropped;
    std::size_t next = 0;
    for (std::size_t bucket = 0; bucket <= 2 * kBuckets + 1; ++bucket) {
        while (next < table_.rungs.size() && table_.bucketOf(table_.rungs[next].value) < bucket)
            ++next;
        table_.starts.push_back(int(next));
    }
}

// In the order of values. The middle bucket has 0 and smaller magnitudes than all others.
std::size_t ValueMixer::TableLevels::bucketOf(double value) const {
    const auto bits = std::bit_cast<std::uint64_t>(std::abs(value));
    const std::uint64_t place = bits < least ? 0 : 1 + ((bits - least) >> dropped);
    return value < 0 ? kBuckets - place : kBuckets + place;
}

int ValueMixer::levelOfValue(double value) const {
    const std::vector<TableLevels::Rung>& rungs = table_.rungs;
    if (!(value > rungs.front().value)) return rungs.front().level;
    if (!(value < rungs.back().value)) return rungs.back().level;
    const std::size_t bucket = table_.bucketOf(value);
    const auto behind = std::upper_bound(
        rungs.begin() + table_.starts[bucket], rungs.begin() + table_.starts[bucket + 1], value,
        [](double number, const TableLevels::Rung& rung) { return number < rung.value; });
    const TableLevels::Rung& rung = behind[-1];
    // Half of the smallest numbers may be 0.
    const double share = rung.half > 0 ? (value / 2 - rung.value / 2) / rung.half : 0;
    return rung.level + int(share * rung.steps + 0.5);
}

MixMap::MixMap(std::span<const Slot> slotMap, std::span<const float> opacitiesOfMapped)
    : slots(slotMap),
      opacities(slotMap.size()),
      ofMapped(opacitiesOfMapped.begin(), opacitiesOfMapped.end()) {
    areAlike = ofMapped.empty();
    if (areAlike) {
        ofMapped.assign(std::size_t(*std::max_element(slots.begin(), slots.end())) + 1, 1.0f);
    }
    ofMapped[kEmptySlot] = 0;
    for (std::size_t slot = 0; slot < slots.size(); ++slot)
        opacities[slot] = ofMapped[std::size_t(slots[slot])];
    rising =
        std::size_t(std::is_sorted_until(opacities.begin(), opacities.end()) - opacities.begin());
}

namespace {

// Returns the values of a window's slots, or NaN.
std::array<double, MixWindow::kSide * MixWindow::kPlane> valuesOf(
    const MixWindow& window, const std::vector<double>& valueOfCode) {
    std::array<double, MixWindow::kSide * MixWindow::kPlane> values;
    for (std::size_t n = 0; n < values.size(); ++n) {
        const Slot slot = window.slots[n];
        values[n] = slot == kEmptySlot ? std::numeric_limits<double>::quiet_NaN()
                                       : valueOfCode[std::size_t(slot - 1)];
    }
    return values;
}

constexpr VoxelMasks everyVoxel() {
    VoxelMasks masks{};
    masks.fill(~std::uint64_t{0});
    return masks;
}

}  // namespace

void ValueMixer::mix(const MixWindow& window, const MixMap& map,
                     std::span<BlockSlots> mixed) const {
    if (window.slots[0] != kEmptySlot && window.isUniform()) {
        const Slot slot = map.slots[std::size_t(levelOf(Code(window.slots[0] - 1))) + 1];
        for (BlockSlots& block : mixed) block.fill(slot);
        return;
    }
    if (even_.perCode != 0) {
        const bool rise = map.rising > std::size_t(even_.last) + 1;
        const VoxelMasks lost = mixEvenLevels(window, parts_, even_, map.slots.data(),
                                              map.opacities.data(), rise, mixed.data());
        return keepSeen(window, map, lost, mixed);
    }
    mixRows(valuesOf(window, table_.ofCode), parts_, [&](int part, int place, const double* row) {
        Slot* out = &mixed[std::size_t(part)][std::size_t(place)];
        for (int v = 0; v < 8; ++v) {
            const bool isThere = row[v] == row[v];
            out[v] = isThere ? map.slots[std::size_t(levelOfValue(row[v])) + 1] : kEmptySlot;
        }
    });
    keepSeen(window, map, everyVoxel(), mixed);
}

namespace {

// Returns per voxel of a block the least opacity of itself and the active voxels it is mixed with.
template <typename OpacityOf>
std::array<float, 512> leastAround(const MixWindow& window, bool alongSlicesOnly,
                                   const OpacityOf& opacityOf) {
    constexpr int kSide = MixWindow::kSide;
    std::array<float, MixWindow::kSide * MixWindow::kPlane> least;
    for (std::size_t n = 0; n < least.size(); ++n)
        least[n] = window.slots[n] == kEmptySlot ? 1.0f : opacityOf(window.slots[n]);
    // Takes minima of three along each axis in turn, stored at the place of the first.
    const auto takeLeast = [&](int step) {
        for (std::size_t n = 0; n + 2 * std::size_t(step) < least.size(); ++n) {
            const float next = std::min(least[n + step], least[n + 2 * step]);
            least[n] = std::min(least[n], next);
        }
    };
    takeLeast(MixWindow::kPlane);
    if (!alongSlicesOnly) {
        takeLeast(kSide);
        takeLeast(1);
    }
    const auto first = std::size_t(alongSlicesOnly ? kSide + 1 : 0);
    std::array<float, 512> inner;
    for (int n = 0; n < 512; ++n) {
        const int place = n / 64 * MixWindow::kPlane + n / 8 % 8 * kSide + n % 8;
        inner[std::size_t(n)] = least[first + std::size_t(place)];
    }
    return inner;
}

}  // namespace

// Shows voxels whose opacity above their surroundings vanishes in their parts.
// @param places  candidates
void ValueMixer::keepSeen(const MixWindow& window, const MixMap& map, const VoxelMasks& places,
                          std::span<BlockSlots> mixed) const {
    constexpr float kLeast = 1.0f / 32;
    const auto levelSlotOf = [&](Slot own) { return std::size_t(levelOf(Code(own - 1))) + 1; };
    std::optional<std::array<float, 512>> around;  // computed only if needed
    for (std::size_t s = 0; s < places.size(); ++s) {
        for (std::uint64_t left = places[s]; left != 0; left &= left - 1) {
            const int n = std::countr_zero(left);
            const glm::ivec3 place(s, n / 8, n % 8);
            const Slot own = window.at(place);
            if (own == kEmptySlot) continue;
            const Slot seen = map.slots[levelSlotOf(own)];
            if (seen == kEmptySlot) continue;
            const float opacity = map.opacities[levelSlotOf(own)];
            float most = 0;
            forPartsOf(place, [&](std::size_t part, std::size_t slot) {
                most = std::max(most, map.ofMapped[std::size_t(mixed[part][slot])]);
            });
            if (most >= 0.5f * opacity) continue;
            if (!around)
                around = leastAround(window, parts_.within == 1,
                                     [&](Slot slot) { return map.opacities[levelSlotOf(slot)]; });
            const float least = (*around)[64 * s + std::size_t(n)];
            const bool isShown = most > 0 && most - least >= kLeast * (opacity - least);
            if (isShown) continue;
            if (!keepsLone_ && !map.areAlike) {
                showShares(window, map, place, mixed);
                continue;
            }
            forPartsOf(place,
                       [&](std::size_t part, std::size_t slot) { mixed[part][slot] = seen; });
        }
    }
}

// Returns the number that is mixed: a level if levels are even, else a value; NaN if inactive.
double ValueMixer::numberOf(Slot slot) const {
    if (slot == kEmptySlot) return std::numeric_limits<double>::quiet_NaN();
    if (even_.perCode == 0) return table_.ofCode[std::size_t(slot - 1)];
    return double(slot - 1 - even_.lowest) * even_.perCode;
}

int ValueMixer::levelOfNumber(double number) const {
    return even_.perCode == 0 ? levelOfValue(number) : int(number + 0.5);
}

// Interpolates at a place at most half a voxel from a voxel's centre.
double ValueMixer::numberAt(const MixWindow& window, const glm::ivec3& place,
                            const glm::dvec3& off) const {
    const glm::ivec3 step(off.x < 0 ? -1 : 1, off.y < 0 ? -1 : 1, off.z < 0 ? -1 : 1);
    const auto mixed = [](double a, double b, double share) {
        return std::isnan(b) ? a : a + std::abs(share) * (b - a);
    };
    const auto along = [&](int u, int v) {
        const glm::ivec3 first = place + glm::ivec3(0, u * step.y, v * step.z);
        return mixed(numberOf(window.at(first)),
                     numberOf(window.at(first + glm::ivec3(step.x, 0, 0))), off.x);
    };
    return mixed(mixed(along(0, 0), along(1, 0), off.y), mixed(along(0, 1), along(1, 1), off.y),
                 off.z);
}

// Returns the mapped slot closest to an opacity, of levels from one to another: coarse, then fine.
Slot ValueMixer::slotAsOpaque(const MixMap& map, int from, int to, double opacity) const {
    constexpr int kSteps = 64;
    Slot closest = kEmptySlot;
    double least = opacity;  // error of the empty slot
    const auto look = [&](int first, int last) {
        int best = first;
        double leastHere = std::numeric_limits<double>::infinity();
        for (int n = 0; n <= kSteps; ++n) {
            const int level = first + (last - first) * n / kSteps;
            const auto slot = std::size_t(level) + 1;
            const double off = std::abs(double(map.opacities[slot]) - opacity);
            if (off < leastHere) {
                leastHere = off;
                best = level;
            }
            if (map.slots[slot] == kEmptySlot || off >= least) continue;
            least = off;
            closest = map.slots[slot];
        }
        return best;
    };
    const int around = look(from, to);
    const auto [low, high] = std::minmax(from, to);
    const int step = (high - low) / kSteps;
    if (step > 0) look(std::max(around - step, low), std::min(around + step, high));
    return closest;
}

// Gives each part the mean opacity within it, because the visible values lie between the centres.
void ValueMixer::showShares(const MixWindow& window, const MixMap& map, const glm::ivec3& place,
                            std::span<BlockSlots> mixed) const {
    const glm::ivec3 per(parts_.slices, parts_.within, parts_.within);
    const int own = levelOf(Code(window.at(place) - 1));
    int n = 0;
    forPartsOf(place, [&](std::size_t part, std::size_t slot) {
        const glm::ivec3 at(n / (per.y * per.z), n / per.z % per.y, n % per.z);
        ++n;
        // Nothing is mixed along an undivided axis.
        const auto levelAt = [&](const glm::dvec3& share) {
            const glm::dvec3 off = (glm::dvec3(at) + share) / glm::dvec3(per) - 0.5;
            const glm::dvec3 divided(glm::greaterThan(per, glm::ivec3(1)));
            return levelOfNumber(numberAt(window, place, off * divided));
        };
        double sum = 0;
        for (int k = 0; k < 27; ++k) {
            const glm::dvec3 third(k / 9, k / 3 % 3, k % 3);
            sum += double(map.opacities[std::size_t(levelAt((third + 0.5) / 3.0)) + 1]);
        }
        mixed[part][slot] = slotAsOpaque(map, levelAt(glm::dvec3(0.5)), own, sum / 27);
    });
}

namespace {

bool liesBefore(const glm::ivec3& a, const glm::ivec3& b) {
    return std::tie(a.y, a.z, a.x) < std::tie(b.y, b.z, b.x);
}

// Adds both neighbours along an axis to ordered places.
std::vector<glm::ivec3> widened(const std::vector<glm::ivec3>& places, const glm::ivec3& step) {
    const auto united = [](const auto& a, const auto& b) {
        std::vector<glm::ivec3> both;
        both.reserve(a.size() + b.size());
        std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both),
                       liesBefore);
        return both;
    };
    std::vector<glm::ivec3> before = places;
    for (glm::ivec3& place : before) place -= step;
    std::vector<glm::ivec3> behind = places;
    for (glm::ivec3& place : behind) place += step;
    return united(united(before, places), behind);
}

// Empty if the lowest code is above the highest.
struct Range {
    Code lowest = std::numeric_limits<Code>::max();
    Code highest = 0;

    void add(const Range& other) {
        lowest = std::min(lowest, other.lowest);
        highest = std::max(highest, other.highest);
    }
};

// Widens the range of each block, in order, by its neighbours along an axis.
void addNeighbours(const std::vector<CodeBlock>& blocks, const glm::ivec3& step,
                   std::vector<Range>& ranges) {
    const std::vector<Range> own = ranges;
    std::size_t next = 0;  // first block not before `place`
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const glm::ivec3 place = blocks[i].position + step;
        while (next < blocks.size() && liesBefore(blocks[next].position, place)) ++next;
        if (next == blocks.size()) return;
        if (blocks[next].position != place) continue;
        ranges[i].add(own[next]);
        ranges[next].add(own[i]);
    }
}

}  // namespace

MixedSight::MixedSight(const ValueMixer& mixer, std::span<const Slot> slotMap, bool byAllSides)
    : mixer_(mixer), byAllSides_(byAllSides), before_(kSlotCount, 0) {
    for (std::size_t level = 0; level < kCodeCount; ++level)
        before_[level + 1] = before_[level] + (slotMap[level + 1] != kEmptySlot);
}

bool MixedSight::canBeSeen(const MixWindow& window) const {
    // Clearing the sign turns empty slots into the largest code, so they never become the lowest.
    constexpr int kMost = std::numeric_limits<int>::max();
    int lowest = kMost;
    int highest = kEmptySlot;
    for (const Slot slot : window.slots) {
        const int code = (slot - 1) & kMost;
        lowest = code < lowest ? code : lowest;
        highest = slot > highest ? slot : highest;
    }
    return highest != kEmptySlot && isSeenBetween(Code(lowest), Code(highest - 1));
}

// Returns a map [kSlotCount] of the codes to list: visible codes, pairs of clear codes that may be
// visible mixed, and all codes if clear ones lie on both sides of the visible ones.
std::vector<Slot> MixedSight::seenCodes(std::span<const std::uint64_t> histogram) const {
    std::vector<Code> codes;
    for (std::size_t code = 0; code < histogram.size(); ++code)
        if (histogram[code] != 0) codes.push_back(Code(code));
    std::vector<bool> isSeen(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const std::size_t next = std::min(i + 1, codes.size() - 1);
        if (!isSeenBetween(codes[i], codes[next])) continue;
        // Visible codes lead to the clear ones beside them.
        const bool first = isSeenBetween(codes[i], codes[i]);
        const bool second = isSeenBetween(codes[next], codes[next]);
        if (first || !second) isSeen[i] = true;
        if (second || !first) isSeen[next] = true;
    }
    std::optional<int> side;
    bool bothSides = false;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        if (isSeen[i]) continue;
        if (side && *side != seenBefore(codes[i])) bothSides = true;
        side = seenBefore(codes[i]);
    }
    std::vector<Slot> map(kSlotCount, kEmptySlot);
    for (std::size_t i = 0; i < codes.size(); ++i)
        if (isSeen[i] || bothSides) map[std::size_t(codes[i]) + 1] = codes[i] + 1;
    return map;
}

// Lists candidates and their neighbours, and keeps blocks near enough to something visible.
std::vector<CodeBlock> MixedSight::listBlocks(const CodeTree& codes, int sliceAxis,
                                              std::span<const std::uint64_t> histogram) const {
    const std::vector<Slot> map = seenCodes(histogram);
    // First, because the finder makes all blocks and not only some.
    const BlockFinder finder(codes, sliceAxis);
    const std::vector<CodeBlock> seen = deltasplat::listBlocks(codes, sliceAxis, map);
    constexpr double kMostNeighbours = 3;
    constexpr double kBytesPerBlock =
        sizeof(CodeBlock) + 4 * sizeof(glm::ivec3) + 2 * sizeof(Range);
    requireMemory("list of voxel blocks", kMostNeighbours * kBytesPerBlock * double(seen.size()));
    std::vector<glm::ivec3> places;
    places.reserve(seen.size());
    for (const CodeBlock& block : seen) places.push_back(block.position);
    places = widened(places, {1, 0, 0});
    const bool alongAll = byAllSides_ || mixer_.parts().within > 1;
    if (alongAll) places = widened(widened(places, {0, 0, 1}), {0, 1, 0});

    std::vector<CodeBlock> blocks;
    std::vector<Range> ranges;
    blocks.reserve(places.size());
    ranges.reserve(places.size());
    auto next = seen.begin();
    for (const glm::ivec3& place : places) {
        if (next != seen.end() && next->position == place) {
            blocks.push_back(*next++);
        } else if (std::optional<CodeBlock> found = finder.find(place)) {
            if (found->leaf) {
                const CodeLeaf leaf = describeLeaf(*found->leaf);
                found->lowest = leaf.lowest;
                found->highest = leaf.highest;
            }
            blocks.push_back(*found);
        } else if (byAllSides_) {
            blocks.push_back({place});
            ranges.push_back(Range());
            continue;
        } else {
            continue;
        }
        const CodeBlock& block = blocks.back();
        const auto tile = Code(block.tileSlot - 1);
        ranges.push_back(block.leaf || block.slots ? Range{block.lowest, block.highest}
                                                   : Range{tile, tile});
    }
    addNeighbours(blocks, {1, 0, 0}, ranges);
    if (alongAll) {
        // In mixing order, so that values across a corner arrive in the same way.
        addNeighbours(blocks, {0, 1, 0}, ranges);
        addNeighbours(blocks, {0, 0, 1}, ranges);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (ranges[i].lowest <= ranges[i].highest &&
            isSeenBetween(ranges[i].lowest, ranges[i].highest))
            blocks[kept++] = blocks[i];
    }
    blocks.resize(kept);
    return blocks;
}

}  // namespace deltasplat
