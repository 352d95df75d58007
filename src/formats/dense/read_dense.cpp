// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/memory_limit.h"
#include "formats/dense/codes_on_demand.h"
#include "formats/dense/dense_source.h"
#include "formats/dense/dense_tree_builder.h"
#include "formats/dense/rescale.h"
#include "formats/raw/raw_values.h"
#include "formats/readers.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/grid_volume.h"
#include "volume/code_counts.h"
#include "volume/code_tree.h"
#include "volume/grid_values.h"
#include "volume/leaf_slices.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"
#include "volume/vdb_transform.h"

namespace deltasplat {

namespace {

/// Reads a dense volume once and counts its mixed 8x8x8 blocks, which determine its memory.
std::uint64_t countMixedBlocks(const DenseSource& source, const Listener& listener);

struct Layer {
    const DenseSource& source;
    const std::byte* bytes;
    int slices;

    std::size_t valueBytes() const { return std::size_t(rawTypeBytes(source.type)); }
    const std::byte* at(int x, int y, int z) const {
        return bytes + std::size_t(z) * source.sliceBytes() + std::size_t(y) * source.rowBytes() +
               std::size_t(x) * valueBytes();
    }

    bool isMixed(int x, int y) const {
        const int width = std::min(8, int(source.dims.x) - x);
        const int height = std::min(8, int(source.dims.y) - y);
        if (width < 8 || height < 8 || slices < 8) return true;
        const std::byte* first = at(x, y, 0);
        const std::size_t row = 8 * valueBytes();
        // The first row is uniform if it equals itself shifted by one value.
        if (std::memcmp(first, first + valueBytes(), row - valueBytes()) != 0) return true;
        for (int z = 0; z < 8; ++z) {
            for (int v = 0; v < 8; ++v) {
                if (std::memcmp(first, at(x, y + v, z), row) != 0) return true;
            }
        }
        return false;
    }
};

std::uint64_t countMixedBlocks(const DenseSource& source, const Listener& listener) {
    std::atomic<std::uint64_t> mixed{0};
    source.forEachLayer(
        [&](int, int slices, const std::byte* bytes) {
            const Layer layer{source, bytes, slices};
            parallelFor(std::size_t((source.dims.y + 7) / 8), [&](std::size_t row) {
                std::uint64_t count = 0;
                for (int x = 0; x < int(source.dims.x); x += 8)
                    count += layer.isMixed(x, 8 * int(row)) ? 1 : 0;
                mixed += count;
            });
        },
        listener);
    return mixed;
}

// Returns a share of the progress: half for each of two readings, all of it for a single one.
Listener partOf(const Listener& listener, double begin, double end) {
    Listener part;
    part.progress = [&listener, begin, end](double share) {
        listener.report(begin + (end - begin) * share);
    };
    part.warning = listener.warning;
    return part;
}

std::string placeText(const glm::i64vec3& dims, std::uint64_t position) {
    const auto width = std::uint64_t(dims.x);
    const auto height = std::uint64_t(dims.y);
    return "(" + std::to_string(position % width) + ", " +
           std::to_string(position / width % height) + ", " +
           std::to_string(position / width / height) + ")";
}

RawScan scan(const DenseSource& source, const ReadOptions& options, const Listener& listener) {
    RawScan whole;
    if (options.bits) whole.census.distinct.giveUp();
    source.forEachLayer(
        [&](int, int slices, const std::byte* bytes) {
            const std::size_t count =
                std::size_t(source.dims.x) * std::size_t(source.dims.y) * std::size_t(slices);
            whole.append(scanRawValues(bytes, count, source.type, source.bigEndian,
                                       !whole.census.distinct.tooMany()));
        },
        listener);
    return whole;
}

void settleNonFinite(const DenseSource& source, RawScan& scan, std::optional<double> nanValue) {
    if (scan.nonFinite == 0) return;
    if (!nanValue) {
        throw Error(ErrorCode::kInput, source.where,
                    countText(scan.nonFinite, "NaN or infinite value") + ", the first at " +
                        placeText(source.dims, scan.firstNonFinite),
                    "finite values (`nanValue` VALUE replaces them)");
    }
    if (source.type == RawType::kFloat32) {
        requireFloatNan(*nanValue);
        scan.census.add(float(*nanValue));
    } else {
        scan.census.add(*nanValue);
    }
    FrequentValues replaced;
    replaced.add(*nanValue, scan.nonFinite);
    scan.frequent.append(replaced);
}

// Returns the values that may belong to a twentieth of the voxels or more.
std::vector<FrequentValue> frequentOf(const RawScan& scan) {
    std::vector<FrequentValue> frequent = scan.frequent.values();
    const double voxels = double(scan.census.count);
    std::erase_if(frequent,
                  [&](const FrequentValue& one) { return double(one.count) < voxels / 20; });
    return frequent;
}

// Types beyond 16 bits are read twice, first to choose their codes.
bool needsScan(RawType type) {
    return rawTypeBytes(type) > 2;
}

CodeBook fixedBook(RawType type) {
    if (type == RawType::kInt8) return CodeBook::integer(std::numeric_limits<std::int8_t>::min());
    if (type == RawType::kInt16) return CodeBook::integer(std::numeric_limits<std::int16_t>::min());
    return CodeBook::integer(0);
}

// Facts about a source's values, found before encoding.
struct Survey {
    double bulkMagnitude = 0;      // as for ErrorMeter
    double low = 0, high = 0;      // of the values
    bool ints = true;              // as ValueCensus::ints
    std::vector<double> frequent;  // candidates for the most frequent value
};

// Whether whole numbers stored as doubles are certainly unrounded.
bool isWithinDoubles(const ValueCensus& census) {
    return std::max(std::fabs(census.min), std::fabs(census.max)) <= 0x1p53;
}

// Reads all values and chooses their code book.
Survey chooseBook(const DenseSource& source, const ReadOptions& options, const Listener& listener,
                  VolumeData& volume) {
    RawScan whole = scan(source, options, listener);
    settleNonFinite(source, whole, options.nanValue);
    volume.replaced = whole.nonFinite;
    volume.readError = whole.census.rounding;
    const bool isReal = source.type == RawType::kFloat32 || source.type == RawType::kFloat64;
    const bool real = isReal && !(source.standsForWhole && whole.census.whole);
    if (isReal && !real) whole.census.exact = isWithinDoubles(whole.census);
    whole.census.frequent = frequentOf(whole);
    volume.codeBook = chooseBook(whole.census, real, options, source.where);
    Survey survey{
        bulkMagnitude(whole.census), whole.census.min, whole.census.max, whole.census.ints, {}};
    for (const FrequentValue& one : whole.census.frequent) survey.frequent.push_back(one.value);
    return survey;
}

void warnOfChanges(const DenseSource& source, const ReadOptions& options, const VolumeData& volume,
                   const Listener& listener) {
    for (const std::string& note : source.notes) listener.warn(source.where + ": " + note);
    if (volume.replaced > 0) {
        listener.warn(source.where + ": " + countText(volume.replaced, "NaN or infinite value") +
                      " replaced by " + numberText(*options.nanValue));
    }
    if (volume.readError > 0) {
        listener.warn(source.where + ": values read as the nearest doubles, off by up to " +
                      numberText(volume.readError));
    }
}

template <typename Tree>
class SliceAdder {
  public:
    using Value = typename Tree::ValueType;

    SliceAdder(const DenseSource& source, Tree& tree)
        : source_(source), builder_(tree, checked(source)) {
        const int slices = source.stepSlices();
        requireMemory(source.where,
                      double(source.sliceBytes()) * slices + builder_.worstBytes(slices));
    }

    DenseTreeBuilder<Tree>& builder() { return builder_; }

    /// Reads blocks by fill(block, values).
    template <typename Fill, typename Tally>
    void add(int first, int slices, const std::byte* bytes, const Fill& fill, const Tally& tally) {
        requireMemory(source_.where, builder_.worstBytes(slices));
        const std::size_t valueBytes = std::size_t(rawTypeBytes(source_.type));
        builder_.add(
            first, slices,
            [&](const glm::ivec3& corner, const glm::ivec3& size, Value* values) {
                const std::size_t start = std::size_t(corner.z) * source_.sliceBytes() +
                                          std::size_t(corner.y) * source_.rowBytes() +
                                          std::size_t(corner.x) * valueBytes;
                fill(RawBlock{bytes + start, source_.rowBytes(), source_.sliceBytes(), size},
                     values);
            },
            tally);
    }

  private:
    // Returns the size after checking the builder's memory.
    static glm::ivec3 checked(const DenseSource& source) {
        const glm::ivec3 dims(source.dims);
        requireMemory(source.where, DenseTreeBuilder<Tree>::bytes(dims));
        return dims;
    }

    const DenseSource& source_;
    DenseTreeBuilder<Tree> builder_;
};

// Whether leaves are read on demand, which needs types that become codes without a scan.
bool readsLater(const DenseSource& source, const ReadOptions& options) {
    return options.readLater && !options.keepSource && source.rows && !needsScan(source.type);
}

// Returns the codes whose voxels will probably be needed.
SeenCodes wantedCodes(RawType type, const CodeBook& book, const ReadOptions& options) {
    const int count = 1 << (8 * rawTypeBytes(type));
    const std::string name = rawTypeName(type);
    return SeenCodes(
        [&](int code) { return code < count && options.isWanted(name, book.valueOf(Code(code))); });
}

void keepMostFrequent(const std::vector<double>& values, const std::vector<std::uint64_t>& counts,
                      VolumeData& volume) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const FrequentValue one{values[i], counts[i]};
        std::optional<FrequentValue>& most = volume.mostFrequent;
        if (!most || one.count > most->count ||
            (one.count == most->count && one.value < most->value))
            most = one;
    }
}

// Inexact codes lose information: then errors are measured and frequent values counted.
void readCodes(const DenseSource& source, const ReadOptions& options, const Survey& survey,
               const Listener& listener, VolumeData& volume) {
    auto codes = std::make_shared<CodeTree>();
    SliceAdder<CodeTree::Tree> adder(source, codes->tree());
    const BookEncoder encoder(volume.codeBook);
    ErrorMeter meter(volume.codeBook, survey.bulkMagnitude);
    const bool exact = volume.codeBook.isExact();
    const RawCoding coding{source.type,
                           source.bigEndian,
                           volume.codeBook,
                           encoder,
                           options.nanValue.value_or(0),
                           exact ? nullptr : &meter};
    const EncodeBlock encode = blockEncoder(coding);
    CodeCounts codeCounts(adder.builder().workers());
    const std::vector<double> frequent = exact ? std::vector<double>() : survey.frequent;
    std::vector<std::uint64_t> counts(frequent.size());
    source.forEachLayer(
        [&](int first, int slices, const std::byte* bytes) {
            const std::size_t values =
                std::size_t(source.dims.x) * std::size_t(source.dims.y) * std::size_t(slices);
            const auto more = countEqual(bytes, values, coding, frequent);
            std::transform(more.begin(), more.end(), counts.begin(), counts.begin(), std::plus());
            adder.add(
                first, slices, bytes,
                [&](const RawBlock& block, Code* values) { encode(block, coding, values); },
                [&](std::size_t worker, const glm::ivec3& size, const Code* values) {
                    codeCounts.addBlock(worker, size, std::span<const Code, 512>(values, 512));
                });
        },
        listener);
    volume.histogram = codeCounts.take();
    codes->noteLeaves(adder.builder().takeLeaves());
    volume.codes = std::move(codes);
    summarize(volume);
    if (exact) return;
    volume.valueMin = survey.low;
    volume.valueMax = survey.high;
    volume.mostFrequent = FrequentValue{volume.mostFrequent->value, 0};
    keepMostFrequent(frequent, counts, volume);
    volume.codeError = meter.error();
    warnOfCodeError(source.where, volume, options, listener);
}

// @param nonFinite  replaces NaN and infinities; empty: they stay
template <typename Tree>
std::shared_ptr<Tree> readTree(const DenseSource& source, std::optional<double> nonFinite,
                               const Listener& listener) {
    using Value = typename Tree::ValueType;
    auto tree = std::make_shared<Tree>();
    SliceAdder<Tree> adder(source, *tree);
    std::optional<Value> nanValue;
    if (nonFinite) nanValue = valueAs<Value>(*nonFinite);
    source.forEachLayer(
        [&](int first, int slices, const std::byte* bytes) {
            adder.add(
                first, slices, bytes,
                [&](const RawBlock& block, Value* values) {
                    readValues(block, source.type, source.bigEndian, nanValue, values);
                },
                [](auto&&...) {});
        },
        listener);
    return tree;
}

// @param asInt64  reads uint64 as int64 of the same bits
std::shared_ptr<openvdb::TreeBase> readSourceTree(const DenseSource& source,
                                                  std::optional<double> nonFinite, bool asInt64,
                                                  const Listener& listener) {
    if (asInt64) return readTree<openvdb::Int64Tree>(source, nonFinite, listener);
    switch (source.type) {
        case RawType::kFloat32:
            return readTree<openvdb::FloatTree>(source, nonFinite, listener);
        case RawType::kFloat64:
        case RawType::kUint64:
            return readTree<openvdb::DoubleTree>(source, nonFinite, listener);
        case RawType::kUint32:
        case RawType::kInt64:
            return readTree<openvdb::Int64Tree>(source, nonFinite, listener);
        default:
            return readTree<openvdb::Int32Tree>(source, nonFinite, listener);
    }
}

TreeGrid readSourceGrid(const DenseSource& source, std::optional<double> nonFinite, bool asInt64,
                        const Listener& listener) {
    TreeGrid grid{readSourceTree(source, nonFinite, asInt64, listener),
                  {},
                  makeMapIfAny(source.worldFromIndex)};
    grid.metadata.insert(openvdb::GridBase::META_GRID_NAME, source.name);
    return grid;
}

// Returns the bytes per value in readSourceGrid's grid.
double gridValueBytes(RawType type) {
    return rawTypeBytes(type) > 4 || type == RawType::kUint32 ? 8 : 4;
}

// Under a memory limit, checks the volume's memory before any of it is taken.
void requireLimit(const DenseSource& source, const ReadOptions& options, bool keep,
                  const Listener& listener) {
    if (memoryLimit() == 0) return;
    Listener stopping;
    stopping.progress = [&](double) { listener.report(0); };
    double bytesPerBlock = leafBytes<CodeTree::Leaf>() + options.bytesPerBlock;
    if (keep) {
        const double valueBytes = gridValueBytes(source.type);
        bytesPerBlock += sizeof(CodeTree::Leaf) + CodeTree::Leaf::SIZE * valueBytes +
                         options.bytesPerInexactBlock * (valueBytes / 4);
    }
    requireMemory(source.where, double(countMixedBlocks(source, stopping)) * bytesPerBlock);
}

void warnOfNothing(const DenseSource& source, const VolumeData& volume, const Listener& listener) {
    const std::uint64_t count = std::uint64_t(volume.box.voxels()) - volume.activeCount;
    if (count == 0) return;
    listener.warn(source.where + ": " +
                  countText(count, "voxel holds what fills pictures up and counts",
                            "voxels hold what fills pictures up and count") +
                  " as nothing");
}

// Reads a volume with voxels that are nothing. They become inactive, with the other voxels' least
// value as background: this is the clear end of ramps, and the value for dense formats.
Volume readWithNothing(const DenseSource& source, const ReadOptions& options,
                       const Listener& listener) {
    constexpr double kReadShare = 0.5;
    const double nothing = source.nothing->value;
    requireLimit(source, options, true, listener);
    TreeGrid grid = readSourceGrid(source, {}, false, partOf(listener, 0, kReadShare));
    grid.metadata.insert(kSpaceKey, source.space);
    if (!source.lengthUnit.empty()) grid.metadata.insert(kLengthUnitKey, source.lengthUnit);
    grid.metadata.insert(kSourceTypeKey, std::string(rawTypeName(source.valueType())));
    const IndexBox box{glm::ivec3(0), glm::ivec3(source.dims) - 1};
    grid.metadata.insert(kBoxMinKey, box.min);
    grid.metadata.insert(kBoxMaxKey, box.max);
    grid.apply<ScalarTrees>(
        [&](auto& tree) { dropValue(tree, nothing, leastOther(tree, nothing)); });
    const Listener coding = partOf(listener, kReadShare, 1);
    VolumeData volume = volumeOfGrid(
        std::move(grid), {coding, source.where, rawTypeName(source.valueType()), options});
    volume.name = source.name;
    volume.worldFromIndex = source.worldFromIndex;
    volume.box = box;
    warnOfChanges(source, options, volume, listener);
    warnOfNothing(source, volume, listener);
    return volumeOfFile(source.where, std::move(volume));
}

// @param anyUnsigned  as readDenseUnsigned
Volume read(const DenseSource& source, const ReadOptions& options, bool anyUnsigned,
            const Listener& listener) {
    if (source.nothing) return readWithNothing(source, options, listener);
    const double scanned = needsScan(source.type) ? 0.5 : 0.0;
    VolumeData volume;
    volume.codeBook = fixedBook(source.type);
    Survey survey;
    if (needsScan(source.type))
        survey = chooseBook(source, options, partOf(listener, 0, scanned), volume);
    const bool asInt64 = options.keepSource && source.type == RawType::kUint64 &&
                         !volume.codeBook.isExact() && (anyUnsigned || survey.ints);
    if (asInt64) volume.readError = 0;
    warnOfChanges(source, options, volume, listener);
    const bool keep = (options.keepSource || options.keepInexact) && !volume.codeBook.isExact();
    const bool later = readsLater(source, options);
    // Memory for reading on demand cannot be known yet.
    if (!later) requireLimit(source, options, keep, listener);
    const double coded = keep ? 0.75 : 1;
    if (later) {
        std::optional<SeenCodes> wanted;
        if (options.isWanted) wanted.emplace(wantedCodes(source.type, volume.codeBook, options));
        CodesOnDemand codes =
            codesOnDemand(source, volume.codeBook, wanted ? &*wanted : nullptr, listener);
        volume.codes = std::move(codes.tree);
        volume.histogram = std::move(codes.histogram);
        summarize(volume);
    } else {
        readCodes(source, options, survey, partOf(listener, scanned, coded), volume);
    }
    if (keep) {
        volume.source = std::make_shared<const SourceGrid>(SourceGrid{readSourceGrid(
            source, options.nanValue.value_or(0), asInt64, partOf(listener, coded, 1))});
    }

    volume.name = source.name;
    volume.type = rawTypeName(source.type);
    volume.gridClass = "unknown";
    volume.space = source.space;
    volume.lengthUnit = source.lengthUnit;
    volume.labels = source.labels;
    volume.box = {glm::ivec3(0), glm::ivec3(source.dims) - 1};
    volume.worldFromIndex = source.worldFromIndex;
    return volumeOfFile(source.where, std::move(volume));
}

}  // namespace

Volume readDense(const DenseSource& source, const ReadOptions& options, const Listener& listener) {
    return read(source, options, false, listener);
}

Volume readDenseUnsigned(const DenseSource& source, const ReadOptions& options,
                         const Listener& listener) {
    return read(source, options, true, listener);
}

Volume readSparse(const DenseSource& source, double background, const ReadOptions& options,
                  const Listener& listener) {
    constexpr double kReadShare = 0.5;
    // Rounding of uint64 shows only before values become doubles.
    double readError = 0;
    if (source.type == RawType::kUint64)
        readError = scan(source, options, partOf(listener, 0, 0.1)).census.rounding;
    TreeGrid grid = readSourceGrid(source, {}, false, partOf(listener, 0.1, kReadShare));
    if (!source.space.empty()) grid.metadata.insert(kSpaceKey, source.space);
    if (!source.lengthUnit.empty()) grid.metadata.insert(kLengthUnitKey, source.lengthUnit);
    if (source.labels) grid.metadata.insert(kLabelsKey, labelText(*source.labels));
    grid.apply<ScalarTrees>(
        [&](auto& tree) { dropValue(tree, background, std::isnan(background) ? 0 : background); });
    const Listener coding = partOf(listener, kReadShare, 1);
    VolumeData volume =
        volumeOfGrid(std::move(grid), {coding, source.where, rawTypeName(source.type), options});
    volume.name = source.name;
    volume.worldFromIndex = source.worldFromIndex;
    volume.readError = readError;
    const std::uint64_t replaced = std::exchange(volume.replaced, 0);
    warnOfChanges(source, options, volume, listener);
    volume.replaced = replaced;
    listener.report(1);
    return volumeOfFile(source.where, std::move(volume));
}

}  // namespace deltasplat
