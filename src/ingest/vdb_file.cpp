// SPDX-License-Identifier: Apache-2.0
#include "ingest/vdb_file.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <array>
#include <new>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/vdb_bytes.h"
#include "ingest/vdb_stream.h"
#include "memory.h"

namespace deltasplat {
namespace {

// The first version that says for each grid how it is compressed, from 2013.
constexpr std::uint32_t kOldestVersion = openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
constexpr std::uint64_t kUuidBytes = 36;

constexpr std::array<const char*, 6> kScalarTypes{"float", "double", "int32",
                                                  "int64", "bool",   "mask"};

// Splits a stored type such as "Tree_float_5_4_3_HalfFloat".
void parseType(const std::string& stored, VdbGrid& grid) {
    static const std::string kHalf = "_HalfFloat";
    static const std::string kFront = "Tree_";
    static const std::string kBack = "_5_4_3";
    std::string type = stored;
    if (type.ends_with(kHalf)) {
        type.resize(type.size() - kHalf.size());
        grid.half = true;
    }
    grid.supported = type.starts_with(kFront) && type.ends_with(kBack);
    if (grid.supported) {
        type = type.substr(kFront.size(), type.size() - kFront.size() - kBack.size());
    }
    grid.type = type;
}

VdbGrid readDescriptor(VdbBytes& bytes, bool hasOffsets) {
    VdbGrid grid;
    grid.begin = bytes.position();
    grid.uniqueName = bytes.text();
    grid.name = openvdb::io::GridDescriptor::nameAsString(grid.uniqueName);
    parseType(bytes.text(), grid);
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

std::string firstLine(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

// Runs OpenVDB's reader on `buffer`, and turns whatever goes wrong there into one kind of error.
openvdb::GridPtrVecPtr readGrids(VdbStreamBuf& buffer, const std::string& where) {
    std::string got;
    try {
        std::istream stream(&buffer);
        // Without this OpenVDB goes on with zeros after the end, for as long as a count says.
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        return openvdb::io::Stream(stream, /*delayLoad=*/false).getGrids();
    } catch (const std::ios_base::failure&) {
        got = "data that ends too early";
    } catch (const std::bad_alloc&) {
        got = "sizes that memory cannot hold";
    } catch (const std::exception& error) {
        got = firstLine(error.what());
    }
    if (buffer.stopped()) std::rethrow_exception(buffer.stopped());
    throw Error(ErrorCode::kInput, gotExpected(where, got, "a sound OpenVDB grid"));
}

// Codes take two bytes where the grid has sizeof(value), and come on top of the grid.
double memoryNeeded(const VdbGrid& grid, std::int64_t stated) {
    const bool bits = grid.type == "bool" || grid.type == "mask";
    return double(stated) * (bits ? 9.0 : 1.6);
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

VdbFile::VdbFile(std::filesystem::path file, const Listener& listener) : file_(std::move(file)) {
    openvdb::initialize();
    readDirectory();
    if (!hasOffsets_) readWhole(listener);
}

void VdbFile::readDirectory() {
    VdbBytes bytes(file_);
    fileBytes_ = bytes.size();
    if (bytes.size() < 8 || bytes.i64() != openvdb::OPENVDB_MAGIC) {
        bytes.failCorrupt("no OpenVDB data", "a .vdb file");
    }
    version_ = bytes.u32();
    if (version_ < kOldestVersion || version_ > openvdb::OPENVDB_FILE_VERSION) {
        bytes.failCorrupt(
            "OpenVDB file version " + std::to_string(version_),
            std::to_string(kOldestVersion) + ".." + std::to_string(openvdb::OPENVDB_FILE_VERSION));
    }
    bytes.seek(bytes.position() + 8);
    hasOffsets_ = bytes.u8() != 0;
    bytes.seek(bytes.position() + kUuidBytes);
    headerEnd_ = bytes.position();
    readMetadata(bytes);

    const auto count = std::int32_t(bytes.u32());
    for (std::int32_t i = 0; hasOffsets_ && i < count; ++i) {
        grids_.push_back(readDescriptor(bytes, hasOffsets_));
        bytes.seek(grids_.back().end);
    }
}

void VdbFile::readWhole(const Listener& listener) {
    VdbStreamBuf buffer(file_);
    buffer.addRange(0, fileBytes_);
    buffer.onProgress([&](double share) { listener.report(share); });
    const openvdb::GridPtrVecPtr all = readGrids(buffer, file_.string());
    for (const openvdb::GridBase::Ptr& loaded : *all) {
        VdbGrid grid;
        grid.name = grid.uniqueName = loaded->getName();
        parseType(loaded->type(), grid);
        grid.half = loaded->saveFloatAsHalf();
        grid.loaded = loaded;
        grids_.push_back(std::move(grid));
    }
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

openvdb::GridBase::Ptr VdbFile::read(const VdbGrid& grid, const Listener& listener) const {
    if (grid.loaded) return grid.loaded;
    std::vector<const VdbGrid*> needed{&grid};
    if (!grid.parentName.empty()) needed.insert(needed.begin(), &parentOf(grid));

    // A file of the same header with no metadata of its own and just the grids needed.
    const std::string where = file_.string() + ": grid \"" + grid.name + "\"";
    VdbStreamBuf buffer(file_);
    buffer.addRange(0, headerEnd_);
    std::string counts;
    appendU32(counts, 0);
    appendU32(counts, std::uint32_t(needed.size()));
    buffer.addText(counts);
    VdbBytes bytes(file_);
    for (const VdbGrid* part : needed) {
        bytes.seek(part->data);
        const std::uint32_t compression = bytes.u32();
        if ((compression & openvdb::io::COMPRESS_BLOSC) != 0) buffer.guardBlosc();
        const VdbMetadata metadata = readMetadata(bytes);
        requireMemory(where, memoryNeeded(*part, metadata.memoryBytes));
        buffer.addRange(part->begin, part->data + 4);
        buffer.addText(metadata.kept);
        const std::uint64_t rest = bytes.position();
        bytes.text(256);  // the transform's type: a length that OpenVDB would trust
        if (bytes.position() > part->end) {
            bytes.failCorrupt("grid offsets that contradict each other", "a sound .vdb file");
        }
        buffer.addRange(rest, part->end);
    }
    buffer.onProgress([&](double share) { listener.report(share); });
    return readGrids(buffer, where)->back();
}

}  // namespace deltasplat
