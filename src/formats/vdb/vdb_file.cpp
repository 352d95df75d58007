// SPDX-License-Identifier: Apache-2.0
#include "formats/vdb/vdb_file.h"

#include <openvdb/io/Compression.h>
#include <openvdb/version.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "formats/vdb/packed_values.h"
#include "formats/vdb/vdb_leaves.h"
#include "formats/vdb/vdb_tree.h"
#include "formats/vdb/vdb_walk.h"
#include "volume/tree_grid.h"
#include "volume/vdb_metadata.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

// The first version that states the compression of each grid, from 2013.
constexpr std::uint32_t kOldestVersion = openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
// The newest version (OpenVDB 13) adds only grids of halves to 224; later ones differ in layout.
constexpr std::uint32_t kNewestVersion = 225;
constexpr std::uint64_t kUuidBytes = 36;

constexpr std::array<const char*, 7> kScalarTypes{"float", "double", kHalfType, "int32",
                                                  "int64", "bool",   "mask"};
// Number types that cannot be read: OpenVDB's names of some, the compiler's names of others.
constexpr std::array<std::string_view, 15> kOtherNumbers{
    "int8", "uint8", "int16", "uint16", "uint32", "uint64", "a", "h",
    "s",    "t",     "j",     "l",      "m",      "x",      "y"};
constexpr std::array<std::string_view, 5> kVectorBegins{"vec", "mat", "quat", "pt", "string"};

constexpr std::uint32_t kCompressions =
    openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC;

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
    if (grid.type == kHalfType) grid.half = true;
    if (!grid.supported && type.starts_with(kTreeFront)) {
        type = type.substr(kTreeFront.size());
        type = type.substr(0, type.find('_'));
    }
    const auto isOne = [&](std::string_view name) { return type == name; };
    grid.numeric = std::any_of(kScalarTypes.begin(), kScalarTypes.end(), isOne) ||
                   std::any_of(kOtherNumbers.begin(), kOtherNumbers.end(), isOne);
    grid.vector = std::any_of(kVectorBegins.begin(), kVectorBegins.end(),
                              [&](std::string_view begin) { return type.starts_with(begin); });
}

VdbGrid readDescriptor(VdbBytes& bytes, bool hasOffsets) {
    VdbGrid grid;
    grid.uniqueName = bytes.text();
    grid.name = grid.numberedName();
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

std::string whereOf(const std::filesystem::path& file, const VdbGrid& grid) {
    return file.string() + ": grid \"" + grid.name + "\"";
}

// Reads a transform and turns any failure of OpenVDB into one kind of error.
openvdb::math::MapBase::ConstPtr takeMap(std::istream& stream, const std::string& where) {
    std::string got;
    try {
        // Otherwise OpenVDB reads zeros past the end, for as long as a count says.
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        return readMap(stream);
    } catch (const Error&) {
        throw;
    } catch (const std::ios_base::failure&) {
        got = "data that ends too early";
    } catch (const std::bad_alloc&) {
        got = "sizes that memory cannot hold";
    } catch (const std::exception& error) {
        got = printable(error.what());
    }
    throw Error(ErrorCode::kInput, where, got, "a sound OpenVDB grid");
}

// Returns the type of the next transform, and leaves `bytes` before it.
std::string mapTypeAt(VdbBytes& bytes) {
    const std::uint64_t map = bytes.position();
    std::string type = bytes.text(256);  // OpenVDB would trust any length
    bytes.seek(map);
    return type;
}

std::string compressionText(std::uint32_t flags) {
    std::ostringstream text;
    text << "compression flags 0x" << std::hex << flags;
    return text.str();
}

void requireCompression(std::uint32_t flags, const std::string& where) {
    if ((flags & ~kCompressions) == 0) return;
    throw UnreadableGrid(where, compressionText(flags), "none but zip, active mask and Blosc");
}

void requireMapType(const std::string& type, const std::string& where) {
    if (isMapType(type)) return;
    throw UnreadableGrid(where, "a " + printable(type) + " transform", "one that OpenVDB 10 knows");
}

// The part of a grid before its tree.
struct GridHead {
    VdbMetadata metadata;
    VdbRange leafSizes;  // "file_delayed_load"; may be empty
    openvdb::math::MapBase::ConstPtr transform;
    VdbValueFormat format;
};

// Reads up to the tree. A transform stores no size: only reading it shows its end.
GridHead readHead(VdbBytes& bytes, const VdbGrid& grid, const std::filesystem::path& file) {
    constexpr std::uint64_t kMostMapBytes = 4096;
    GridHead head;
    if (!head.format.setType(grid.type, grid.half)) {
        bytes.failCorrupt("a grid of type " + grid.type + " in a file without offsets",
                          "scalar and vector grids");
    }
    const std::string where = whereOf(file, grid);
    bytes.seek(grid.data);
    head.format.compression = bytes.u32();
    requireCompression(head.format.compression, where);
    head.metadata = readMetadata(bytes, grid.half, &head.leafSizes);
    requireMapType(mapTypeAt(bytes), where);
    const std::uint64_t map = bytes.position();
    std::istringstream stream(bytes.bytes(std::min(kMostMapBytes, bytes.size() - map)));
    head.transform = takeMap(stream, where);
    bytes.seek(map + std::uint64_t(stream.tellg()));
    return head;
}

void requireEnd(const VdbBytes& bytes, const VdbGrid& grid) {
    if (bytes.position() == grid.end) return;
    bytes.failCorrupt("a grid that ends at byte " + std::to_string(bytes.position()),
                      std::to_string(grid.end));
}

// Reads the head of a grid whose tree may be another grid's.
GridHead readHeads(VdbBytes& bytes, const VdbGrid& grid, const VdbGrid& owner,
                   const std::filesystem::path& file) {
    GridHead head = readHead(bytes, grid, file);
    if (&owner == &grid) return head;
    requireEnd(bytes, grid);
    if (owner.type != grid.type)
        bytes.failCorrupt(
            "a grid of type " + grid.type + " that shares voxels of type " + owner.type,
            "a sound .vdb file");
    const GridHead tree = readHead(bytes, owner, file);
    head.format = tree.format;
    head.leafSizes = tree.leafSizes;
    return head;
}

// Places leaves by the file's size notes. Returns whether these exist and end where the grid does.
// @param bytes  at the first leaf; stays there
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

bool hasNumbers(const VdbGrid& grid) {
    return grid.isScalar() && grid.type != "bool" && grid.type != "mask";
}

}  // namespace

bool VdbGrid::isScalar() const {
    if (!supported) return false;
    for (const char* scalar : kScalarTypes) {
        if (type == scalar) return true;
    }
    return false;
}

// Separates a grid's name from the suffix that makes it unique.
constexpr char kNameEnd = '\x1e';

std::string VdbGrid::plainName() const {
    return uniqueName.substr(0, uniqueName.find(kNameEnd));
}

std::string VdbGrid::numberedName() const {
    const std::string plain = plainName();
    if (plain.size() == uniqueName.size()) return printable(plain);
    return printable(plain + "[" + uniqueName.substr(plain.size() + 1) + "]");
}

std::string VdbGrid::valueType() const {
    return half && (type == "float" || type == "double") ? kHalfType : type;
}

VdbFile::VdbFile(std::filesystem::path file)
    : file_(std::move(file)), bytes_(FileBytes::plain(file_)) {
    readDirectory();
}

void VdbFile::readDirectory() {
    VdbBytes bytes(bytes_);
    if (bytes.size() < 8 || bytes.i64() != openvdb::OPENVDB_MAGIC) {
        bytes.failCorrupt("no OpenVDB data", "a .vdb file");
    }
    const std::uint32_t version = bytes.u32();
    if (version < kOldestVersion || version > kNewestVersion) {
        bytes.failCorrupt("OpenVDB file version " + std::to_string(version),
                          std::to_string(kOldestVersion) + ".." + std::to_string(kNewestVersion));
    }
    bytes.skip(8);  // the version of the library that wrote it
    const bool hasOffsets = bytes.u8() != 0;
    bytes.skip(kUuidBytes);
    metadata_ = readMetadata(bytes);

    const auto count = std::int32_t(bytes.u32());
    for (std::int32_t i = 0; i < count; ++i) {
        VdbGrid grid = readDescriptor(bytes, hasOffsets);
        if (!hasOffsets) findEnd(bytes, grid);
        bytes.seek(grid.end);
        grids_.push_back(std::move(grid));
    }
    nameGrids();
    findOwners();
}

// OpenVDB numbers grids of the same name, and even a single grid without a name. Other writers do
// not, and another grid may be named "density[0]": then all grids of the name get new numbers.
void VdbFile::nameGrids() {
    std::map<std::string, std::vector<VdbGrid*>> named;
    for (VdbGrid& grid : grids_) named[grid.plainName()].push_back(&grid);
    std::set<std::string> taken;
    for (const bool isAlone : {true, false}) {
        for (const auto& [plain, grids] : named) {
            if ((grids.size() == 1) != isAlone) continue;
            std::set<std::string> own;
            for (VdbGrid* const grid : grids) {
                if (isAlone) grid->name = printable(plain);
                const bool isNumbered = plain != grid->uniqueName;
                if ((isAlone || isNumbered) && !taken.contains(grid->name)) own.insert(grid->name);
            }
            const bool areTold = own.size() == grids.size();
            std::size_t number = 0;
            for (VdbGrid* const grid : grids) {
                while (!areTold) {
                    grid->name = printable(plain) + "[" + std::to_string(number++) + "]";
                    if (!taken.contains(grid->name)) break;
                }
                taken.insert(grid->name);
            }
        }
    }
}

VdbMetadata VdbFile::metadata(const VdbGrid& grid) const {
    VdbBytes bytes(bytes_);
    return summary(grid, bytes).metadata;
}

VdbFile::Summary VdbFile::summary(const VdbGrid& grid, VdbBytes& bytes) const {
    bytes.seek(grid.data);
    const std::uint32_t compression = bytes.u32();
    Summary summary{readMetadata(bytes, grid.half), ""};
    if (!grid.numeric) return summary;
    const std::string map = mapTypeAt(bytes);
    if (!grid.isScalar()) {
        summary.obstacle = "type " + grid.type;
    } else if ((compression & ~kCompressions) != 0) {
        summary.obstacle = compressionText(compression);
    } else if (!isMapType(map) || map == openvdb::math::NonlinearFrustumMap::mapType()) {
        summary.obstacle = "a " + printable(map) + " transform";
    }
    return summary;
}

// Streamed files do not state where their grids end.
void VdbFile::findEnd(VdbBytes& bytes, VdbGrid& grid) const {
    const GridHead head = readHead(bytes, grid, file_);
    if (grid.parentName.empty()) walkTree(bytes, head.format);
    grid.end = bytes.position();
}

// Finds the grid whose voxels each grid has, possibly its own.
void VdbFile::findOwners() {
    std::map<std::string_view, std::size_t> owners;  // the first grid of each name
    for (std::size_t i = 0; i < grids_.size(); ++i)
        if (grids_[i].parentName.empty()) owners.emplace(grids_[i].uniqueName, i);
    for (std::size_t i = 0; i < grids_.size(); ++i) {
        VdbGrid& grid = grids_[i];
        const auto found = owners.find(grid.parentName);
        if (grid.parentName.empty()) {
            grid.owner = i;
        } else if (found != owners.end()) {
            grid.owner = found->second;
            // The owner decides how shared voxels are stored.
            grid.half = grids_[found->second].half;
        }
    }
}

const VdbGrid& VdbFile::ownerOf(const VdbGrid& grid) const {
    if (grid.parentName.empty()) return grid;
    if (grid.owner) return grids_[*grid.owner];
    throw Error(ErrorCode::kInput, file_.string(),
                "grid \"" + grid.name +
                    "\" without "
                    "the grid whose voxels it shares",
                "a sound .vdb file");
}

// A grid whose background is read, but no other value.
struct VdbFile::Found {
    std::string where;
    GridHead head;
    VdbTreeSize size;
    VdbTreePlaces places;          // without those of leaves
    std::vector<char> background;  // as stored
    std::shared_ptr<const FileBytes> file;
    VdbLeaves leaves;
    bool byNotes;  // whether leaves were placed by the file's notes

    VdbValues::Number number() const {
        const auto as = [&]<typename T>(T) -> VdbValues::Number {
            return valueAlone<T>(background.data(), head.format);
        };
        const bool isWide = head.format.bytes == 8;
        if (head.format.real) return isWide ? as(double{}) : as(float{});
        return isWide ? as(std::int64_t{}) : as(std::int32_t{});
    }
};

// @return nothing if notes are asked for but missing
// @param listener  hears how far the file is read or skipped
std::optional<VdbFile::Found> VdbFile::find(const VdbGrid& grid, Find how,
                                            const Listener& listener) const {
    const std::string where = whereOf(file_, grid);
    const VdbGrid& owner = ownerOf(grid);
    VdbBytes bytes(bytes_);
    const GridHead head = readHeads(bytes, grid, owner, file_);
    const std::uint64_t begin = bytes.position();
    bytes.onProgress([&](std::uint64_t position) {
        if (position >= begin && position < owner.end)
            listener.report(double(position - begin) / double(owner.end - begin));
    });
    VdbTreePlaces places;
    const VdbTreeSize size = walkTopology(bytes, head.format, places);
    if (bytes.position() > owner.end) requireEnd(bytes, owner);
    const bool byNotes =
        how != Find::kByWalking && placeBySizes(bytes, head, owner.end, places.leaves, where);
    if (!byNotes) {
        walkLeaves(bytes, head.format, places.leaves);
        requireEnd(bytes, owner);
    }
    std::vector<char> background(head.format.alone);
    bytes.seek(places.background);
    bytes.read(background.data(), background.size());
    std::shared_ptr<const FileBytes> file = bytes_;
    VdbLeaves leaves(file, std::move(places.leaves), head.format, head.transform);
    return Found{where,
                 head,
                 size,
                 std::move(places),
                 std::move(background),
                 std::move(file),
                 std::move(leaves),
                 byNotes};
}

TreeGrid VdbFile::read(const VdbGrid& grid, const Listener& listener) const {
    for (const Find how : {Find::kByNotes, Find::kByWalking}) {
        const Found found = find(grid, how, {}).value();
        const GridHead& head = found.head;
        requireMemory(found.where, found.size.memoryBytes(head.format));
        auto tree = readTree(*found.file, grid.type, head.format, found.background,
                             found.places.nodes, found.leaves, listener);
        if (tree) return {std::move(tree), head.metadata, head.transform};
        if (!found.byNotes) break;
    }
    throw DamagedLeaves(whereOf(file_, grid));
}

std::optional<VdbFile::Packed> VdbFile::readPacked(const VdbGrid& grid) const {
    if (!hasNumbers(grid)) return std::nullopt;
    Found found = find(grid, Find::kByNotes, {}).value();
    requireMemory(found.where, found.size.nodeBytes());
    const auto make = [&]<typename T>(T background) -> std::optional<Packed> {
        auto nodes =
            readNodes(*found.file, found.head.format, background, found.places.nodes, found.leaves);
        if (!nodes) return std::nullopt;
        return Packed{found.head.metadata,
                      found.places.activeVoxels,
                      found.places.activeBox,
                      {PackedGrid::Nodes<T>(std::move(nodes)), std::move(found.leaves)}};
    };
    return std::visit(make, found.number());
}

std::optional<VdbLeaves> VdbFile::readLeaves(const VdbGrid& grid, Find how) const {
    if (grid.type != "int32" && grid.type != "int64") return std::nullopt;
    std::optional<Found> found = find(grid, how, {});
    if (!found || found->size.tiles > 0) return std::nullopt;
    const bool isZero = std::visit([](auto number) { return number == 0; }, found->number());
    return isZero ? std::optional(std::move(found->leaves)) : std::nullopt;
}

std::optional<VdbValues> VdbFile::readValues(const VdbGrid& grid, Find how,
                                             const Listener& listener) const {
    if (!hasNumbers(grid)) return std::nullopt;
    std::optional<Found> found = find(grid, how, listener);
    if (!found) return std::nullopt;
    const VdbValueFormat& format = found->head.format;
    requireMemory(found->where, found->size.codeBytes(format));
    std::optional<VdbTiles> tiles = VdbTiles::read(*found->file, format, found->places.nodes);
    if (!tiles) return std::nullopt;
    return VdbValues{found->head.metadata,     found->number(),    std::move(*tiles),
                     std::move(found->leaves), format.areHalves(), found->byNotes};
}

}  // namespace deltasplat
