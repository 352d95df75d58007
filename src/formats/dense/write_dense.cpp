// SPDX-License-Identifier: Apache-2.0
#include "formats/dense/write_dense.h"

#include <openvdb/tree/ValueAccessor.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <system_error>
#include <type_traits>
#include <vector>

#include "base/bits.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/volume.h"
#include "files/file_name.h"
#include "formats/dense/dense_layout.h"
#include "formats/raw/raw_format.h"
#include "formats/vdb/grid_metadata.h"
#include "volume/code_math.h"
#include "volume/code_tree.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/value_cast.h"

namespace deltasplat {

namespace {

/// Writes the values of a box into values[z][y][x]. Thread-safe.
template <typename Value>
using ReadBox = std::function<void(const IndexBox& box, Value* values)>;

/// Returns a reader of a volume's values, from its source or else its codes. Inactive voxels have
/// their own value, or the volume's background for NaN and infinity. Integers beyond 2^53 become
/// the nearest double. The volume outlives the reader.
ReadBox<double> boxReader(const Volume& volume);

/// Returns a reader of unchanged 64-bit integers, unsigned ones as bits; empty for other sources.
ReadBox<std::int64_t> integerReader(const Volume& volume);

/// Stores `count` values as little endian. Returns the largest error.
double storeValues(const double* values, std::size_t count, RawType type, std::byte* out);

/// Stores 64-bit integers, signed or not. Returns 0.
double storeValues(const std::int64_t* values, std::size_t count, RawType type, std::byte* out);

constexpr int kBlock = 8;

// Addresses the voxels of a box in the array of its values.
template <typename Value>
struct BoxArray {
    const IndexBox& box;
    Value* values;

    Value* at(const glm::ivec3& voxel) const {
        const glm::ivec3 place = voxel - box.min;
        const glm::ivec3 dims = box.dims();
        return values +
               (std::size_t(place.z) * std::size_t(dims.y) + std::size_t(place.y)) *
                   std::size_t(dims.x) +
               place.x;
    }
};

// Calls fill(row, count, index of the row's first voxel in its leaf) for each row of a block.
template <typename Value, typename Fill>
void forRows(const IndexBox& block, const BoxArray<Value>& array, const Fill& fill) {
    const glm::ivec3& min = block.min;
    for (int z = min.z; z <= block.max.z; ++z) {
        for (int y = min.y; y <= block.max.y; ++y) {
            const auto first = openvdb::Index((min.x & 7) << 6 | (y & 7) << 3 | (z & 7));
            fill(array.at({min.x, y, z}), block.dims().x, first);
        }
    }
}

template <typename Accessor, typename ValueOf, typename Value>
void readBlock(const Accessor& accessor, const ValueOf& valueOf, const IndexBox& block,
               const BoxArray<Value>& array) {
    const openvdb::Coord corner(block.min.x, block.min.y, block.min.z);
    if (const auto* leaf = accessor.probeConstLeaf(corner)) {
        forRows(block, array, [&](Value* row, int count, openvdb::Index place) {
            constexpr openvdb::Index kAlongX = 64;
            for (int x = 0; x < count; ++x, place += kAlongX) {
                row[x] = valueOf(leaf->getValue(place), leaf->isValueOn(place));
            }
        });
    } else {
        const Value value = valueOf(accessor.getValue(corner), accessor.isValueOn(corner));
        forRows(block, array,
                [&](Value* row, int count, openvdb::Index) { std::fill_n(row, count, value); });
    }
}

template <typename Value, typename Tree, typename ValueOf>
ReadBox<Value> treeReader(const Tree& tree, const ValueOf& valueOf) {
    return [&tree, valueOf](const IndexBox& box, Value* values) {
        // The tree stays unchanged, so it need not know the accessor.
        const openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false> accessor(tree);
        const BoxArray<Value> array{box, values};
        const glm::ivec3 first = box.min & ~(kBlock - 1);
        for (int z = first.z; z <= box.max.z; z += kBlock) {
            for (int y = first.y; y <= box.max.y; y += kBlock) {
                for (int x = first.x; x <= box.max.x; x += kBlock) {
                    const glm::ivec3 corner(x, y, z);
                    readBlock(accessor, valueOf,
                              {glm::max(corner, box.min), glm::min(corner + (kBlock - 1), box.max)},
                              array);
                }
            }
        }
    };
}

ReadBox<double> codeReader(const Volume& volume) {
    return treeReader<double>(
        volume.codes()->tree(),
        [values = valuesOfCodes(volume.codeBook()), background = volume.background()](
            Code code, bool active) { return active ? values[code] : background; });
}

template <typename T>
double store(const double* values, std::size_t count, std::byte* out) {
    double error = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const T value = valueAs<T>(values[i]);
        error = std::max(error, std::abs(double(value) - values[i]));
        storeLittle(value, out + i * sizeof(T));
    }
    return error;
}

ReadBox<double> boxReader(const Volume& volume) {
    if (!volume.source()) return codeReader(volume);
    ReadBox<double> reader;
    const bool isUnsigned = holdsUnsigned(volume);
    volume.source()->grid.apply<ScalarTrees>([&](const auto& tree) {
        using T = typename std::decay_t<decltype(tree)>::ValueType;
        reader = treeReader<double>(tree,
                                    [=, background = volume.background()](T value, bool) -> double {
                                        if (!std::isfinite(double(value))) return background;
                                        if constexpr (std::is_same_v<T, std::int64_t>)
                                            if (isUnsigned) return double(std::uint64_t(value));
                                        return double(value);
                                    });
    });
    return reader;
}

ReadBox<std::int64_t> integerReader(const Volume& volume) {
    const auto* const tree =
        volume.source() ? volume.source()->grid.as<openvdb::Int64Tree>() : nullptr;
    if (!tree) return {};
    return treeReader<std::int64_t>(*tree, [](std::int64_t value, bool) { return value; });
}

double storeValues(const double* values, std::size_t count, RawType type, std::byte* out) {
    return withRawType(type, [&](auto zero) { return store<decltype(zero)>(values, count, out); });
}

double storeValues(const std::int64_t* values, std::size_t count, RawType, std::byte* out) {
    for (std::size_t i = 0; i < count; ++i) storeLittle(values[i], out + i * sizeof(values[i]));
    return 0;
}

/// An AtomicFile that gzips its bytes from some point on, reproducibly: without time and name.
class PackedOutput {
  public:
    /// @throw Error(kOutput) as AtomicFile
    explicit PackedOutput(const std::filesystem::path& finalPath);
    ~PackedOutput();
    PackedOutput(const PackedOutput&) = delete;
    PackedOutput& operator=(const PackedOutput&) = delete;

    /// Packs all bytes from here on. Called at most once.
    void beginGzip();
    /// @throw Error(kOutput) if not all bytes can be written
    void write(const void* bytes, std::size_t size);
    /// Finishes writing: commit() only renames.
    /// @throw Error(kOutput) if not all bytes could be written
    void close();
    /// Gives the file its final name, after close().
    void commit() { file_.commit(); }
    /// Gives a data file and this file, its header, their final names, as AtomicFile does.
    void commitWithData(PackedOutput& data) { file_.commitWithData(data.file_); }

  private:
    void deflateInput(int flush);

    AtomicFile file_;
    std::vector<unsigned char> packed_;  // empty: not packing
    z_stream stream_{};
};

PackedOutput::PackedOutput(const std::filesystem::path& finalPath) : file_(finalPath) {}

PackedOutput::~PackedOutput() {
    if (!packed_.empty()) ::deflateEnd(&stream_);
}

void PackedOutput::beginGzip() {
    constexpr int kGzipWindow = 15 + 16;  // largest window; 16 asks for gzip's own header
    constexpr int kMemoryLevel = 8;
    const int result = ::deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow,
                                      kMemoryLevel, Z_DEFAULT_STRATEGY);
    if (result != Z_OK) throw std::bad_alloc();
    packed_.resize(std::size_t{1} << 18);
}

void PackedOutput::write(const void* bytes, std::size_t size) {
    if (packed_.empty()) return file_.write(bytes, size);
    // zlib never writes to its input, which is not const for historical reasons.
    stream_.next_in = static_cast<Bytef*>(const_cast<void*>(bytes));
    while (size > 0) {
        constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
        stream_.avail_in = uInt(std::min(size, kMost));
        size -= stream_.avail_in;
        deflateInput(Z_NO_FLUSH);
    }
}

void PackedOutput::close() {
    if (!packed_.empty()) {
        stream_.avail_in = 0;
        deflateInput(Z_FINISH);
    }
    file_.close();
}

void PackedOutput::deflateInput(int flush) {
    int result = Z_OK;
    do {
        stream_.next_out = packed_.data();
        stream_.avail_out = uInt(packed_.size());
        result = ::deflate(&stream_, flush);
        file_.write(packed_.data(), packed_.size() - stream_.avail_out);
    } while (flush == Z_FINISH ? result == Z_OK : stream_.avail_out == 0);
}

bool contains(const IndexBox& outer, const IndexBox& inner) {
    return glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
           glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

// Returns the box to write: that of the original file if a grid was made from one.
IndexBox boxOf(const Volume& volume) {
    if (!volume.source()) return volume.box();
    const VdbMetadata& metadata = volume.source()->grid.metadata;
    const auto min = metadata.get<glm::ivec3>(kBoxMinKey);
    const auto max = metadata.get<glm::ivec3>(kBoxMaxKey);
    if (!min || !max) return volume.box();
    const IndexBox box{*min, *max};
    constexpr double kMostVoxels = 0x1p62;  // the readers' own limit
    const glm::dvec3 sides = glm::dvec3(*max) - glm::dvec3(*min) + 1.0;
    const bool sound = !box.empty() && sides.x * sides.y * sides.z <= kMostVoxels;
    return sound && (volume.empty() || contains(box, volume.box())) ? box : volume.box();
}

void requireVoxels(const std::filesystem::path& file, const Volume& volume, const IndexBox& box) {
    if (!box.empty()) return;
    throw Error(ErrorCode::kInput, file.string(),
                "\"" + volume.name() + "\", which has no active voxels",
                "a volume with a bounding box (.vdb holds empty ones)");
}

// Returns the file's name; for a nearly empty box with its size and cost.
std::string whatIsWritten(const std::filesystem::path& file, const Volume& volume,
                          const IndexBox& box, double bytes) {
    constexpr double kNearlyEmpty = 1000;
    if (double(voxelsOf(box)) <
        kNearlyEmpty * double(std::max<std::uint64_t>(volume.activeCount(), 1)))
        return file.string();
    const glm::ivec3 dims = box.dims();
    return file.string() + ": " + std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" +
           std::to_string(dims.z) + " voxels, " + humanBytes(bytes) + ", of which " +
           std::to_string(volume.activeCount()) + " are active (a .vdb stores those alone)";
}

// Checks the disk's free space before hours of work, as far as the size is known.
void requireSpace(const std::filesystem::path& file, const std::string& what,
                  const DenseFormat& format, double bytes) {
    constexpr double kMostPacking = 1032;  // zlib's best ratio
    const double least = format.gzipData ? bytes / kMostPacking : bytes;
    std::error_code error;
    const std::filesystem::path folder = absolute(file, error).parent_path();
    const std::filesystem::space_info space = std::filesystem::space(folder, error);
    if (error || least <= double(space.available)) return;
    throw Error(ErrorCode::kOutput, what + ": cannot be written: needs " + humanBytes(least) +
                                        "; expected at most " +
                                        humanBytes(double(space.available)) + ", which is free");
}

void noteLostStates(const Volume& volume, const IndexBox& box, WriteNotes& notes) {
    if (!volume.hasBackground()) return;
    const std::uint64_t inactive = voxelsOf(box) - volume.activeCount();
    if (inactive != 0) {
        notes.loss(
            countText(inactive,
                      "inactive voxel becomes a voxel like the others, with the value it holds",
                      "inactive voxels become voxels like the others, with the value they "
                      "hold") +
            " (background " + numberText(volume.background()) + ")");
    }
    // A volume that was no grid before had no name but the file's.
    if (volume.source() && !volume.source()->grid.metadata.text(kSourceTypeKey).empty()) return;
    notes.loss("the grid's name \"" + volume.name() + "\", class \"" + volume.gridClass() +
               "\" and other metadata are left out");
}

DenseLayout layoutOf(const Volume& volume, const IndexBox& box, const ValueFacts& facts,
                     const DenseFormat& format, WriteNotes& notes) {
    DenseLayout layout;
    layout.dims = box.dims();
    layout.type = denseType(volume, facts, format.wideIntegers, notes);
    layout.worldFromIndex = volume.worldFromIndex();
    layout.worldFromIndex[3] = volume.worldFromIndex() * glm::dvec4(box.min, 1);
    layout.space = volume.space();
    layout.lengthUnit = volume.lengthUnit();
    layout.labels = volume.labels();
    return layout;
}

void swapBytes(std::vector<std::byte>& data, std::size_t size) {
    for (auto value = data.begin(); value != data.end(); value += std::ptrdiff_t(size))
        std::reverse(value, value + std::ptrdiff_t(size));
}

// Slices within one layer of 8x8x8 blocks, as bytes of the file.
class Layer {
  public:
    Layer(const IndexBox& box, RawType type, bool bigEndian)
        : box_(box),
          type_(type),
          bigEndian_(bigEndian),
          rowBytes_(std::size_t(box.dims().x) * rawTypeBytes(type)) {}

    double bytes() const { return double(rowBytes_) * box_.dims().y * box_.dims().z; }
    const std::vector<std::byte>& data() const { return data_; }

    /// Fills the layer on all threads. Returns the largest error.
    template <typename Value>
    double fill(const ReadBox<Value>& read) {
        data_.resize(rowBytes_ * std::size_t(box_.dims().y) * std::size_t(box_.dims().z));
        const int firstStrip = box_.min.y & ~(kBlock - 1);
        std::vector<double> errors(std::size_t((box_.max.y - firstStrip) / kBlock + 1));
        parallelFor(errors.size(), [&](std::size_t strip) {
            IndexBox part = box_;
            part.min.y = std::max(box_.min.y, firstStrip + int(strip) * kBlock);
            part.max.y = std::min(box_.max.y, firstStrip + int(strip) * kBlock + kBlock - 1);
            errors[strip] = fillStrip(part, read);
        });
        if (bigEndian_) swapBytes(data_, rawTypeBytes(type_));
        return *std::max_element(errors.begin(), errors.end());
    }

  private:
    template <typename Value>
    double fillStrip(const IndexBox& part, const ReadBox<Value>& read) {
        const auto width = std::size_t(part.dims().x);
        const auto values = std::make_unique_for_overwrite<Value[]>(std::size_t(part.voxels()));
        read(part, values.get());
        const Value* row = values.get();
        double error = 0;
        for (int z = 0; z < part.dims().z; ++z) {
            for (int y = part.min.y - box_.min.y; y <= part.max.y - box_.min.y; ++y, row += width) {
                std::byte* out =
                    data_.data() +
                    (std::size_t(z) * std::size_t(box_.dims().y) + std::size_t(y)) * rowBytes_;
                error = std::max(error, storeValues(row, width, type_, out));
            }
        }
        return error;
    }

    IndexBox box_;
    RawType type_;
    bool bigEndian_;
    std::size_t rowBytes_;
    std::vector<std::byte> data_;
};

template <typename Value>
double writeValues(const ReadBox<Value>& read, const IndexBox& box, const DenseLayout& layout,
                   PackedOutput& out, const Listener& listener) {
    double error = 0;
    for (int first = box.min.z; first <= box.max.z; first = (first & ~(kBlock - 1)) + kBlock) {
        IndexBox slices = box;
        slices.min.z = first;
        slices.max.z = std::min(box.max.z, first | (kBlock - 1));
        Layer layer(slices, layout.type, layout.bigEndian);
        error = std::max(error, layer.fill(read));
        out.write(layer.data().data(), layer.data().size());
        listener.report(double(slices.max.z - box.min.z + 1) / box.dims().z);
    }
    return error;
}

}  // namespace

WriteReport writeDense(const std::filesystem::path& file, const DenseFormat& format,
                       const Volume& volume, const Listener& listener) {
    const IndexBox box = boxOf(volume);
    requireVoxels(file, volume, box);
    WriteReport report;
    WriteNotes notes(report, file);
    const ValueFacts facts = factsOf(volume);
    DenseLayout layout = layoutOf(volume, box, facts, format, notes);
    format.settle(layout, file.string(), notes);
    noteLostStates(volume, box, notes);
    const double sliceBytes = double(layout.dims.x) * layout.dims.y * rawTypeBytes(layout.type);
    const std::string what = whatIsWritten(file, volume, box, sliceBytes * layout.dims.z);
    requireMemory(what, 2 * kBlock * sliceBytes);
    requireSpace(file, what, format, sliceBytes * layout.dims.z);

    const std::filesystem::path dataFile = dataFileOf(file);
    PackedOutput head(file);
    std::optional<PackedOutput> separate;
    if (!dataFile.empty()) separate.emplace(dataFile);
    PackedOutput& data = separate ? *separate : head;

    if (format.gzipHeader) head.beginGzip();
    const std::string header = format.header(layout, dataFile.filename().string());
    head.write(header.data(), header.size());
    if (format.gzipData && !format.gzipHeader) data.beginGzip();
    const bool isWide = layout.type == RawType::kInt64 || layout.type == RawType::kUint64;
    const ReadBox<std::int64_t> integers = isWide ? integerReader(volume) : nullptr;
    report.maxError = integers ? writeValues(integers, box, layout, data, listener)
                               : std::max(facts.doubleError, writeValues(boxReader(volume), box,
                                                                         layout, data, listener));

    head.close();
    data.close();
    if (separate) {
        head.commitWithData(*separate);
    } else {
        head.commit();
    }
    report.files = {file};
    if (separate) report.files.push_back(dataFile);
    if (report.maxError != 0) report.lossless = false;
    return report;
}

}  // namespace deltasplat
