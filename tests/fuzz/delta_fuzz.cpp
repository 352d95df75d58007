// SPDX-License-Identifier: Apache-2.0
// A delta grid, damaged where a .vdb's own checks do not look: byte 0 chooses the seed grid, byte 1
// what happens to its metadata, the rest changes voxels and text.
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "deltasplat/delta/delta_file.h"
#include "fuzz/fuzz_target.h"

namespace deltasplat::fuzz {
namespace {

// Turns the values of a table into ladders of one rung.
void makePieces(openvdb::GridBase& grid) {
    std::istringstream values(grid.metaValue<std::string>("delta_table"));
    std::string pieces;
    for (std::string value; values >> value;)
        pieces += (pieces.empty() ? "" : " ") + value + " 0.001 1";
    grid.removeMeta("delta_table");
    grid.insertMeta("delta_pieces", openvdb::StringMetadata(pieces));
    grid.insertMeta("delta_code_book", openvdb::StringMetadata("pieces"));
}

// Half, table, linear, pieces, float32 and float64; as voxels, and packed; and a volume whose
// packed deltas say which codes they add up to.
constexpr int kBooks = 6;
constexpr int kKnown = 2 * kBooks;
constexpr int kKinds = kKnown + 1;

// Returns the delta grid of a volume of several columns.
openvdb::GridBase::Ptr writeDeltas(const Volume& volume, const DeltaFileOptions& options) {
    const std::string path = fileWith(".seed.vdb", nullptr, 0);
    DeltaFile file;
    file.add(volume, options);
    file.write(path);
    openvdb::io::File input(path);
    input.open();
    const openvdb::GridBase::Ptr grid = input.readGrid("density");
    input.close();
    std::remove(path.c_str());
    return grid;
}

openvdb::GridBase::Ptr knownDeltaGrid() {
    openvdb::initialize();
    auto source = openvdb::Int32Grid::create();
    source->setName("density");
    for (int i = 0; i < 24 * 24 * 24; ++i) {
        const openvdb::Coord at(i % 24 - 5, i / 24 % 24 + 3, i / 576);
        source->tree().setValueOn(at, at.x() > 9 ? 1 : 1 + i * i % 7);
    }
    const std::string path = fileWith(".seed.vdb", nullptr, 0);
    openvdb::io::File(path).write({source});
    DeltaFileOptions options;
    options.pack = true;
    options.keyInterval = 8;
    return writeDeltas(readVolume(path), options);
}

// Returns the delta grid of a small volume of each kind of code book.
template <typename Grid>
openvdb::GridBase::Ptr deltaGrid(int kind) {
    using Value = typename Grid::ValueType;
    const bool isPacked = kind >= kBooks;
    kind %= kBooks;
    openvdb::initialize();
    auto source = Grid::create(Value(-0.5));
    source->setName("density");
    for (int i = 0; i < 500; ++i) {
        const openvdb::Coord at(i % 13 - 3, i / 13 % 11, i / 40);
        Value value = kind % 2 == 1 ? Value(i % 50) / 3 : Value(i % 37) / 4;
        if (kind >= 4) value = std::sin(Value(i));  // more text than a table is worth
        if (i % 9 == 0) {
            source->tree().setValueOff(at, value);
        } else {
            source->tree().setValueOn(at, value);
        }
    }
    source->setSaveFloatAsHalf(kind == 0);
    const std::string path = fileWith(".seed.vdb", nullptr, 0);
    openvdb::io::File(path).write({source});
    ReadOptions reading;
    reading.keepSource = true;
    if (kind == 2) reading.bits = 12;
    DeltaFileOptions options;
    options.codesOnly = kind < 4;
    options.pack = isPacked;
    const openvdb::GridBase::Ptr grid = writeDeltas(readVolume(path, reading), options);
    if (kind == 3) makePieces(*grid);
    return grid;
}

// Takes numbers from the input, zeros after its end.
class Input {
  public:
    Input(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
    bool empty() const { return at_ == end_; }
    std::uint8_t byte() { return at_ == end_ ? 0 : *at_++; }
    std::int32_t number() {
        std::uint32_t bits = 0;
        for (int i = 0; i < 4; ++i) bits = bits << 8 | byte();
        return std::int32_t(bits);
    }
    std::string text() {
        std::string text;
        for (std::size_t n = byte() % 32; n > 0; --n) text += char(byte());
        return text;
    }

  private:
    const std::uint8_t* at_;
    const std::uint8_t* end_;
};

// Removes an entry of the metadata, or gives it another value or type.
void damageMetadata(Input& input, openvdb::MetaMap& metadata) {
    if (metadata.metaCount() == 0) return;
    auto entry = metadata.beginMeta();
    for (std::size_t n = input.byte() % metadata.metaCount(); n > 0; --n) ++entry;
    const std::string name = entry->first;
    const std::string type = entry->second->typeName();
    metadata.removeMeta(name);
    switch (input.byte() % 4) {
        case 0:
            break;
        case 1:
            metadata.insertMeta(name, openvdb::StringMetadata(input.text()));
            break;
        case 2:
            metadata.insertMeta(
                name, openvdb::Vec3IMetadata({input.number(), input.number(), input.number()}));
            break;
        default:
            if (type == "int32") metadata.insertMeta(name, openvdb::Int32Metadata(input.number()));
            if (type == "int64") metadata.insertMeta(name, openvdb::Int64Metadata(input.number()));
            if (type == "double")
                metadata.insertMeta(name, openvdb::DoubleMetadata(input.number() * 1e30));
    }
}

template <typename Tree>
void damageVoxels(Input& input, Tree& tree) {
    openvdb::Coord at(std::int8_t(input.byte()), std::int8_t(input.byte()),
                      std::int8_t(input.byte()));
    const std::uint8_t how = input.byte();
    typename Tree::ValueType value = how % 2 ? input.number() : std::int8_t(input.byte());
    if (sizeof value > 4 && how % 8 == 7) value <<= 31;
    if (how % 4 == 2) {
        // One bit, where the words of a stream are.
        at = at & 7;
        const auto bit = int(std::uint8_t(value) % (8 * sizeof value));
        value = tree.getValue(at) ^ typename Tree::ValueType(1) << bit;
    }
    if (how % 16 == 0) {
        tree.addTile(1, at, value, true);
    } else if (how % 4 == 1) {
        tree.setValueOff(at);
    } else {
        tree.setValueOn(at, value);
    }
}

}  // namespace

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    for (char kind = 0; kind < kKinds; ++kind) {
        inputs.push_back({kind, 0});
        inputs.push_back({kind, 1, 4, 2, 0, 0, 0, 3, 3, 3, 3, 3, 3});
        inputs.push_back({kind, 0, 1, 2, 3, 0, 7, 4, 4, 4, 1, 0, 0, 0, 1});
        inputs.push_back({kind, 0, 1, 2, 3, 2, 7, 0, 0, 1, 6, 60, 5, 5, 5, 2, 33});
        inputs.push_back({kind, 3, 9, 3, 0, 0, 0, 9, 2, 1, 6, '1', ' ', '2', ' ', '3', '4'});
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < 2 || size > 4096) return 0;
    using openvdb::DoubleGrid, openvdb::FloatGrid;
    static const openvdb::GridBase::Ptr grids[fuzz::kKinds] = {
        fuzz::deltaGrid<FloatGrid>(0),  fuzz::deltaGrid<FloatGrid>(1),
        fuzz::deltaGrid<FloatGrid>(2),  fuzz::deltaGrid<FloatGrid>(3),
        fuzz::deltaGrid<FloatGrid>(4),  fuzz::deltaGrid<DoubleGrid>(5),
        fuzz::deltaGrid<FloatGrid>(6),  fuzz::deltaGrid<FloatGrid>(7),
        fuzz::deltaGrid<FloatGrid>(8),  fuzz::deltaGrid<FloatGrid>(9),
        fuzz::deltaGrid<FloatGrid>(10), fuzz::deltaGrid<DoubleGrid>(11),
        fuzz::knownDeltaGrid()};
    const openvdb::GridBase::Ptr grid = grids[data[0] % fuzz::kKinds]->deepCopyGrid();
    fuzz::Input input(data + 2, size - 2);
    for (int n = data[1] % 4; n > 0; --n) fuzz::damageMetadata(input, *grid);
    using Deltas = openvdb::TypeList<openvdb::Int32Grid, openvdb::Int64Grid>;
    grid->apply<Deltas>([&](auto& deltas) {
        while (!input.empty()) fuzz::damageVoxels(input, deltas.tree());
    });
    const std::string path = fuzz::fileWith(".vdb", nullptr, 0);
    // As a whole grid, straight from the file, and what is asked for of it.
    ReadOptions whole;
    whole.keepSource = true;
    ReadOptions later;
    later.readLater = true;
    for (const ReadOptions& options : {whole, ReadOptions(), later}) {
        try {
            openvdb::io::File(path).write({grid});
        } catch (const openvdb::Exception&) {
            return 0;  // OpenVDB itself writes no such file
        }
        fuzz::readAndCheck(path, options);
    }
    return 0;
}
