// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb/vdb_file.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <new>
#include <sstream>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/files/file_bytes.h"
#include "ingest/grids/grid_errors.h"
#include "ingest/vdb/leaf_sizes.h"
#include "ingest/vdb/vdb_bytes.h"
#include "ingest/vdb/vdb_stream.h"
#include "ingest/vdb/vdb_transform.h"
#include "ingest/vdb/vdb_tree.h"
#include "ingest/vdb/vdb_walk.h"
#include "memory.h"
#include "printable.h"

namespace deltasplat {
namespace {

// The first version that says for each grid how it is compressed, from 2013.
constexpr std::uint32_t kOldestVersion = openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
constexpr std::uint64_t kUuidBytes = 36;
// OpenVDB uses it for nothing, but refuses what is none.
const std::string kAnyUuid = "00000000-0000-0000-0000-000000000000";

constexpr std::array<const char*, 6> kScalarTypes{"float", "double", "int32",
                                                  "int64", "bool",   "mask"};

const std::string kTreeFront = "Tree_";
const std::string kTreeBack = "_5_4_3";

// Splits a stored type such as "Tree_float_5_4_3_HalfFloat".
void parseType(const std::string& stored, VdbGrid& grid) {
    static const std::string kHalf = "_HalfFloat";
    std::string type = stored;
    if (type.ends_with(kHalf)) {
        type.resize(type.size() - kHalf.size());
        grid.half = true;
    }
    grid.supported = type.starts_with(kTreeFront) && type.ends_with(kTreeBack);
    if (grid.supported) {
        type = type.substr(kTreeFront.size(), type.size() - kTreeFront.size() - kTreeBack.size());
    }
    grid.type = type;
}

// What tells grids of one name apart stands behind this in the unique one.
constexpr char kNameEnd = '\x1e';

std::string nameOf(const std::string& uniqueName) {
    const std::size_t end = uniqueName.find(kNameEnd);
    if (end == std::string::npos) return uniqueName;
    return uniqueName.substr(0, end) + "[" + uniqueName.substr(end + 1) + "]";
}

VdbGrid readDescriptor(VdbBytes& bytes, bool hasOffsets) {
    VdbGrid grid;
    grid.begin = bytes.position();
    grid.uniqueName = bytes.text();
    grid.name = printable(nameOf(grid.uniqueName));
    parseType(printable(bytes.text()), grid);
    grid.parentName = bytes.text();
    const auto gridStart = std::uint64_t(bytes.i64());
    bytes.i64();
    grid.end = std::uint64_t(bytes.i64());
    grid.data = bytes.position();
    if (hasOffsets && (gridStart != grid.data || grid.end < grid.data)) {
        bytes.failCorrupt("grid offsets that contradict each other", "a sound .vdb file");
    }
    return grid;
}

// For messages.
std::string whereOf(const std::filesystem::path& file, const VdbGrid& grid) {
    return file.string() + ": grid \"" + grid.name + "\"";
}

// Calls read(stream of buffer), and turns whatever goes wrong in OpenVDB into one kind of error.
template <typename Read>
auto guarded(VdbStreamBuf& buffer, const std::string& where, const Read& read) {
    std::string got;
    try {
        std::istream stream(&buffer);
        // Without this OpenVDB goes on with zeros after the end, for as long as a count says.
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        return read(stream);
    } catch (const Error&) {
        throw;
    } catch (const std::ios_base::failure&) {
        got = "data that ends too early";
    } catch (const std::bad_alloc&) {
        got = "sizes that memory cannot hold";
    } catch (const std::exception& error) {
        got = printable(error.what());
    }
    if (buffer.stopped()) std::rethrow_exception(buffer.stopped());
    throw Error(ErrorCode::kInput, gotExpected(where, got, "a sound OpenVDB grid"));
}

// What stands before a grid's tree.
struct GridHead {
    VdbMetadata metadata;
    VdbRange leafSizes;     // OpenVDB's "file_delayed_load"; empty: none
    std::uint64_t map = 0;  // where the transform starts
    openvdb::math::MapBase::ConstPtr transform;
    VdbValueFormat format;
};

// Reads up to the tree. The transform's own fields have no sizes: OpenVDB must say where it ends.
GridHead readHead(VdbBytes& bytes, const VdbGrid& grid, const std::filesystem::path& file) {
    GridHead head;
    if (!head.format.setType(grid.type, grid.half)) {
        bytes.failCorrupt("a grid of type " + grid.type + " in a file without offsets",
                          "scalar and vector grids");
    }
    bytes.seek(grid.data);
    head.format.compression = bytes.u32();
    head.metadata = readMetadata(bytes, grid.half, &head.leafSizes);
    head.map = bytes.position();
    bytes.text(256);  // the transform's type: a length that OpenVDB would trust
    VdbStreamBuf buffer(file);
    buffer.addRange(head.map, bytes.size());
    head.transform = guarded(buffer, whereOf(file, grid), [&](std::istream& stream) {
        const auto transform = readMap(stream);
        bytes.seek(head.map + std::uint64_t(stream.tellg()));
        return transform;
    });
    return head;
}

// Whether OpenVDB reads leaves without finding out whether they are whole.
bool mayBeUnsound(const VdbValueFormat& format) {
    return (format.compression & openvdb::io::COMPRESS_ZIP) != 0 &&
           (format.compression & openvdb::io::COMPRESS_BLOSC) == 0 &&
           format.leaf == VdbValueFormat::Leaf::kValues;
}

void requireEnd(const VdbBytes& bytes, const VdbGrid& grid) {
    if (bytes.position() == grid.end) return;
    bytes.failCorrupt("a grid that ends at byte " + std::to_string(bytes.position()),
                      std::to_string(grid.end));
}

// Finds where leaves lie by what the file notes of their sizes; returns whether it does, and they
// end where the grid does. A note may be wrong all the same.
// @param bytes  at the first leaf, which they are left at
bool placeBySizes(VdbBytes& bytes, const GridHead& head, std::uint64_t end,
                  std::vector<VdbLeaf>& leaves, const std::string& where) {
    constexpr std::uint64_t kMaskBytes = 64;
    std::uint64_t position = bytes.position();
    const std::uint64_t noteBytes = head.leafSizes.size;
    if (noteBytes == 0 || noteBytes > mostLeafSizesBytes(leaves.size())) return false;
    requireMemory(where, double(noteBytes));
    bytes.seek(head.leafSizes.begin);
    const std::string note = bytes.bytes(noteBytes);
    bytes.seek(position);
    const auto sizes = leafSizesOf(note, leaves.size(), head.format);
    if (!sizes) return false;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const std::uint64_t size = kMaskBytes + (*sizes)[i];
        if (size > end - position) return false;
        leaves[i].begin = position;
        leaves[i].size = std::uint32_t(size);
        position += size;
    }
    return position == end;
}

// Whether a grid has a tree of its own, of numbers.
bool hasNumbers(const VdbGrid& grid) {
    return grid.isScalar() && grid.parentName.empty() && grid.type != "bool" && grid.type != "mask";
}

// Reads the background of a grid of numbers; `bytes` moves there.
VdbValues::Number readBackground(VdbBytes& bytes, std::uint64_t place,
                                 const VdbValueFormat& format) {
    bytes.seek(place);
    const auto number = [&]<typename T>(T value) -> VdbValues::Number {
        bytes.read(&value, sizeof value);
        return value;
    };
    const bool isWide = format.bytes == 8;
    if (format.real) return isWide ? number(double{}) : number(float{});
    return isWide ? number(std::int64_t{}) : number(std::int32_t{});
}

// A grid of numbers, none of whose values but the background has been read.
struct FoundNumbers {
    std::string where;  // for messages
    GridHead head;
    VdbTreeSize size;
    VdbTreePlaces places;  // but for those of leaves
    VdbValues::Number background;
    std::shared_ptr<const FileBytes> file;
    VdbLeaves leaves;
    bool byNotes;  // whether leaves lie where the file notes them
};

// Returns nothing if the grid is none of its own, of numbers, or has no notes to be found by.
// @param listener  hears how far the file is read, or passed over
std::optional<FoundNumbers> findNumbers(const std::filesystem::path& path, const VdbGrid& grid,
                                        VdbFile::Find how, const Listener& listener = {}) {
    if (!hasNumbers(grid)) return std::nullopt;
    const std::string where = whereOf(path, grid);
    VdbBytes bytes(path);
    const GridHead head = readHead(bytes, grid, path);
    const std::uint64_t begin = bytes.position();
    bytes.onProgress([&](std::uint64_t position) {
        if (position >= begin && position < grid.end)
            listener.report(double(position - begin) / double(grid.end - begin));
    });
    VdbTreePlaces places;
    const VdbTreeSize size = walkTopology(bytes, head.format, places);
    if (bytes.position() > grid.end) requireEnd(bytes, grid);
    const bool byNotes = how != VdbFile::Find::kByWalking &&
                         placeBySizes(bytes, head, grid.end, places.leaves, where);
    if (!byNotes) {
        if (how == VdbFile::Find::kByNotesAlone) return std::nullopt;
        walkLeaves(bytes, head.format, places.leaves);
        requireEnd(bytes, grid);
    }
    const auto background = readBackground(bytes, places.background, head.format);
    auto file = std::make_shared<const FileBytes>(path);
    VdbLeaves leaves(file, std::move(places.leaves), head.format, head.transform);
    return FoundNumbers{
        where,  head, size, std::move(places), background, std::move(file), std::move(leaves),
        byNotes};
}

// Returns nothing if some of it is damaged, or lies elsewhere.
std::optional<TreeGrid> treeOf(const FoundNumbers& found, const Listener& listener) {
    const auto make = [&]<typename T>(T background) -> std::shared_ptr<openvdb::TreeBase> {
        return readTree(*found.file, found.head.format, background, found.places.nodes,
                        found.leaves, listener);
    };
    auto tree = std::visit(make, found.background);
    if (!tree) return std::nullopt;
    return TreeGrid{std::move(tree), found.head.metadata, found.head.transform};
}

}  // namespace

bool VdbGrid::isScalar() const {
    if (!supported) return false;
    for (const char* scalar : kScalarTypes) {
        if (type == scalar) return true;
    }
    return false;
}

std::string VdbGrid::valueType() const {
    return half && (type == "float" || type == "double") ? "half" : type;
}

VdbFile::VdbFile(std::filesystem::path file) : file_(std::move(file)) {
    readDirectory();
}

void VdbFile::readDirectory() {
    VdbBytes bytes(file_);
    if (bytes.size() < 8 || bytes.i64() != openvdb::OPENVDB_MAGIC) {
        bytes.failCorrupt("no OpenVDB data", "a .vdb file");
    }
    const std::uint32_t version = bytes.u32();
    if (version < kOldestVersion || version > openvdb::OPENVDB_FILE_VERSION) {
        bytes.failCorrupt(
            "OpenVDB file version " + std::to_string(version),
            std::to_string(kOldestVersion) + ".." + std::to_string(openvdb::OPENVDB_FILE_VERSION));
    }
    bytes.skip(8);  // the version of the library that wrote it
    const bool hasOffsets = bytes.u8() != 0;
    bytes.skip(kUuidBytes);
    headerEnd_ = bytes.position();
    metadata_ = readMetadata(bytes);

    const auto count = std::int32_t(bytes.u32());
    for (std::int32_t i = 0; i < count; ++i) {
        VdbGrid grid = readDescriptor(bytes, hasOffsets);
        if (!hasOffsets) findEnd(bytes, grid);
        bytes.seek(grid.end);
        grids_.push_back(std::move(grid));
    }
}

VdbMetadata VdbFile::metadata(const VdbGrid& grid) const {
    VdbBytes bytes(file_);
    return readHead(bytes, grid, file_).metadata;
}

// A file written as a stream says nowhere how long its grids are.
void VdbFile::findEnd(VdbBytes& bytes, VdbGrid& grid) const {
    const GridHead head = readHead(bytes, grid, file_);
    if (grid.parentName.empty()) walkTree(bytes, head.format);
    grid.end = bytes.position();
}

const VdbGrid& VdbFile::parentOf(const VdbGrid& grid) const {
    for (const VdbGrid& other : grids_) {
        if (other.uniqueName == grid.parentName && other.parentName.empty()) return other;
    }
    throw Error(ErrorCode::kInput, gotExpected(file_.string(),
                                               "grid \"" + grid.name +
                                                   "\" without "
                                                   "the grid whose voxels it shares",
                                               "a sound .vdb file"));
}

TreeGrid VdbFile::read(const VdbGrid& grid, const Listener& listener) const {
    for (const Find how : {Find::kByNotes, Find::kByWalking}) {
        const std::optional<FoundNumbers> found = findNumbers(file_, grid, how);
        if (!found) return readByOpenVdb(grid, listener);
        requireMemory(found->where, found->size.memoryBytes(found->head.format));
        std::optional<TreeGrid> read = treeOf(*found, listener);
        if (read) return std::move(*read);
        if (!found->byNotes) break;
    }
    throw DamagedLeaves(whereOf(file_, grid));
}

std::optional<VdbFile::Packed> VdbFile::readPacked(const VdbGrid& grid) const {
    std::optional<FoundNumbers> found = findNumbers(file_, grid, Find::kByNotes);
    if (!found) return std::nullopt;
    requireMemory(found->where, found->size.nodeBytes());
    const VdbTreePlaces& places = found->places;
    const auto make = [&]<typename T>(T background) -> std::optional<Packed> {
        auto nodes =
            readNodes(*found->file, found->head.format, background, places.nodes, found->leaves);
        if (!nodes) return std::nullopt;
        return Packed{found->head.metadata,
                      places.activeVoxels,
                      places.activeBox,
                      {PackedGrid::Nodes<T>(std::move(nodes)), std::move(found->leaves)}};
    };
    return std::visit(make, found->background);
}

// Reads a grid by OpenVDB, which is handed a file of the same header with no metadata of its own
// and just the grids needed.
TreeGrid VdbFile::readByOpenVdb(const VdbGrid& grid, const Listener& listener) const {
    std::vector<const VdbGrid*> needed{&grid};
    if (!grid.parentName.empty()) needed.insert(needed.begin(), &parentOf(grid));

    VdbStreamBuf buffer(file_);
    buffer.addRange(0, headerEnd_ - kUuidBytes);
    buffer.addText(kAnyUuid);
    std::string counts;
    appendU32(counts, 0);
    appendU32(counts, std::uint32_t(needed.size()));
    buffer.addText(counts);
    const std::string where = whereOf(file_, grid);
    VdbBytes bytes(file_);
    for (const VdbGrid* part : needed) {
        const GridHead head = readHead(bytes, *part, file_);
        if (part->parentName.empty()) {
            VdbTreePlaces places;
            const VdbTreeSize size = walkTopology(bytes, head.format, places);
            walkLeaves(bytes, head.format, places.leaves);
            requireMemory(where, size.memoryBytes(head.format));
            if (mayBeUnsound(head.format)) {
                const VdbLeaves leaves(std::make_shared<const FileBytes>(file_),
                                       std::move(places.leaves), head.format, head.transform);
                if (!leaves.areSound()) throw DamagedLeaves(where);
            }
        }
        requireEnd(bytes, *part);
        buffer.addRange(part->begin, part->data + sizeof(std::uint32_t));
        buffer.addText(head.metadata.bytes());
        buffer.addRange(head.map, part->end);
    }
    buffer.onProgress([&](double share) { listener.report(share); });
    openvdb::initialize();
    return guarded(buffer, where, [](std::istream& stream) {
        return fromOpenVdb(openvdb::io::Stream(stream, /*delayLoad=*/false).getGrids()->back());
    });
}

std::optional<VdbLeaves> VdbFile::readLeaves(const VdbGrid& grid, Find how) const {
    if (grid.type != "int32" && grid.type != "int64") return std::nullopt;
    std::optional<FoundNumbers> found = findNumbers(file_, grid, how);
    if (!found || found->size.tiles > 0) return std::nullopt;
    const bool isZero = std::visit([](auto number) { return number == 0; }, found->background);
    return isZero ? std::optional(std::move(found->leaves)) : std::nullopt;
}

std::optional<VdbValues> VdbFile::readValues(const VdbGrid& grid, Find how,
                                             const Listener& listener) const {
    std::optional<FoundNumbers> found = findNumbers(file_, grid, how, listener);
    if (!found) return std::nullopt;
    const VdbValueFormat& format = found->head.format;
    requireMemory(found->where, found->size.codeBytes(format));
    std::optional<VdbTiles> tiles = VdbTiles::read(*found->file, format, found->places.nodes);
    if (!tiles) return std::nullopt;
    return VdbValues{found->head.metadata,
                     found->background,
                     std::move(*tiles),
                     std::move(found->leaves),
                     format.stored != format.bytes,
                     found->byNotes};
}

}  // namespace deltasplat
