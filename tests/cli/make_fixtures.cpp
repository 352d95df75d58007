// SPDX-License-Identifier: Apache-2.0
// Writes the odd files that the command-line tests are given, into the current folder.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "make_several.h"

namespace {

void writeVdb(const std::string& file, const openvdb::GridPtrVec& grids) {
    openvdb::io::File out(file);
    out.write(grids);
    out.close();
}

void writeBytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

std::string readBytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <typename Grid>
typename Grid::Ptr emptyFog(const std::string& name, double background = 0) {
    auto grid = Grid::create(typename Grid::ValueType(background));
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

// A ball of fog, 0.5 everywhere inside.
template <typename Grid = openvdb::FloatGrid>
typename Grid::Ptr ball(const std::string& name, double background = 0) {
    auto grid = emptyFog<Grid>(name, background);
    auto accessor = grid->getAccessor();
    for (int x = -6; x <= 6; ++x)
        for (int y = -6; y <= 6; ++y)
            for (int z = -6; z <= 6; ++z)
                if (x * x + y * y + z * z <= 36) accessor.setValue({x, y, z}, 0.5);
    return grid;
}

openvdb::GridBase::Ptr vectors() {
    openvdb::Vec3SGrid::Ptr grid = openvdb::Vec3SGrid::create();
    grid->setName("velocity");
    grid->getAccessor().setValue({1, 2, 3}, {1.0F, 0.0F, 0.0F});
    return grid;
}

openvdb::GridBase::Ptr points() {
    const std::vector<openvdb::Vec3R> positions = {{0, 0, 0}, {1, 2, 3}};
    auto grid = openvdb::points::createPointDataGrid<openvdb::points::NullCodec,
                                                     openvdb::points::PointDataGrid>(
        positions, *openvdb::math::Transform::createLinearTransform(1.0));
    grid->setName("points");
    return grid;
}

openvdb::GridBase::Ptr frustum() {
    openvdb::FloatGrid::Ptr grid = ball("density");
    const openvdb::BBoxd box({-8, -8, -8}, {8, 8, 8});
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(box, 0.5, 10.0));
    return grid;
}

openvdb::GridBase::Ptr notNumbers() {
    openvdb::FloatGrid::Ptr grid = ball("density");
    grid->getAccessor().setValue({1, 2, 3}, std::nanf(""));
    grid->getAccessor().setValue({2, 2, 3}, std::numeric_limits<float>::infinity());
    return grid;
}

template <typename Grid>
typename Grid::Ptr filled(const std::string& name, openvdb::GridClass gridClass,
                          typename Grid::ValueType value) {
    auto grid = Grid::create();
    grid->setName(name);
    grid->setGridClass(gridClass);
    grid->tree().fill(openvdb::CoordBBox({0, 0, 0}, {11, 11, 11}), value, /*active=*/true);
    return grid;
}

// What a smoke simulation keeps: its solver's fields first, those over the whole domain; undefined
// distances near obstacles, and in fog as well where nothing is active.
openvdb::GridPtrVec cache(const std::string& density) {
    const auto obstacle =
        filled<openvdb::FloatGrid>("phi_obstacle", openvdb::GRID_LEVEL_SET, 10000);
    for (int x = 2; x < 9; ++x) obstacle->getAccessor().setValue({x, 3, 3}, std::nanf(""));
    openvdb::FloatGrid::Ptr fog = ball(density);
    fog->getAccessor().setValueOff({6, 6, 6}, std::nanf(""));
    fog->getAccessor().setValueOff({5, 6, 6}, std::numeric_limits<float>::infinity());
    return {obstacle, filled<openvdb::Int32Grid>("flags", openvdb::GRID_UNKNOWN, 1),
            filled<openvdb::FloatGrid>("shadow", openvdb::GRID_FOG_VOLUME, 1),
            filled<openvdb::FloatGrid>("speed", openvdb::GRID_UNKNOWN, 2), fog};
}

// Two blocks of 8x8x8 voxels that lie as far apart as indices go.
openvdb::GridBase::Ptr farApart() {
    auto grid = openvdb::FloatGrid::create();
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    constexpr int kFar = (1 << 30) - 8;
    for (const openvdb::Coord& first : {openvdb::Coord(0), openvdb::Coord(kFar, kFar, kFar)})
        grid->tree().fill({first, first.offsetBy(7)}, first.x() == 0 ? 0.5f : 1.0f, true);
    return grid;
}

// Balls that differ from ball.vdb, each in one way.
void writeOtherBalls() {
    writeVdb("ball_named.vdb", {ball("smoke")});
    writeVdb("ball_double.vdb", {ball<openvdb::DoubleGrid>("density")});
    writeVdb("ball_background.vdb", {ball("density", -1)});
    const auto classed = ball("density");
    classed->setGridClass(openvdb::GRID_LEVEL_SET);
    writeVdb("ball_class.vdb", {classed});
    const auto active = ball("density");
    active->getAccessor().setValueOn({0, 0, 7}, 0.0F);
    writeVdb("ball_active.vdb", {active});
    const auto moved = ball("density");
    moved->transform().postTranslate({0.5, 0, 0});
    writeVdb("ball_moved.vdb", {moved});
    // The ball at the same place in the world, its indices counted from elsewhere.
    const auto elsewhere = emptyFog<openvdb::FloatGrid>("density");
    for (auto voxel = active->cbeginValueOn(); voxel; ++voxel) {
        if (voxel.getCoord() == openvdb::Coord(0, 0, 7)) continue;
        elsewhere->getAccessor().setValueOn(voxel.getCoord().offsetBy(5, -4, 3), *voxel);
    }
    elsewhere->setTransform(active->transform().copy());
    elsewhere->transform().preTranslate({-5, 4, -3});
    writeVdb("ball_elsewhere.vdb", {elsewhere});
    const auto changed = ball("heat");
    changed->getAccessor().setValueOn({1, 2, 3}, 0.75F);
    writeVdb("three.vdb", {ball("density"), changed, ball("smoke"), vectors()});
    // OpenVDB numbers grids of the same name; not every writer has to.
    writeVdb("same_names.vdb", {ball("density"), ball("densitx")});
    writeBytes("same_names.vdb",
               std::regex_replace(readBytes("same_names.vdb"), std::regex("densitx"), "density"));
    // Grids that would have files of one name.
    writeVdb("odd_grids.a.vdb", {ball("density")});
    writeVdb("odd_grids.b.vdb", {ball("a/b"), ball("a_b"), ball("c")});
    writeBytes("odd_grids.c.vdb", readBytes("same_names.vdb"));
}

// Grids of kinds that are not read, before one that is; grids that are found in odd ways.
void writeOddGrids() {
    writeVdb("frustum_first.vdb", {frustum(), ball("heat")});
    writeVdb("other_type.vdb", {ball("density"), ball("heat")});
    std::string bytes = readBytes("other_type.vdb");
    bytes.replace(bytes.find("Tree_float"), 10, "Tree_uint8");
    writeBytes("other_type.vdb", bytes);
    writeVdb("unnamed.vdb",
             {ball("density"), filled<openvdb::FloatGrid>("", openvdb::GRID_UNKNOWN, 3)});
    writeVdb("long_name.vdb", {ball(std::string(300, 'n')), ball("d")});
    openvdb::GridPtrVec many{ball("density")};
    for (int i = 0; i < 50; ++i) {
        many.push_back(vectors());
        many.back()->setName("v" + std::to_string(i));
    }
    writeVdb("many.vdb", many);
}

void writeVdbFiles() {
    writeOddGrids();
    writeVdb("ball.vdb", {ball("density")});
    const auto surface =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6, openvdb::Vec3f(0), 0.5);
    surface->setName("surface");
    writeVdb("level_set.vdb", {surface});
    writeVdb("two.vdb", {ball("density"), ball("heat")});
    writeVdb("far.vdb", {farApart()});
    const auto patient = ball("density");
    patient->insertMeta("deltasplat_space", openvdb::StringMetadata("LPS"));
    writeVdb("patient.vdb", {patient});
    // Nodding by 30 degrees, and counted from the right to the left.
    const auto tilted = ball("density");
    tilted->insertMeta("deltasplat_space", openvdb::StringMetadata("RAS"));
    const double along = 2 * std::sqrt(0.75);
    tilted->setTransform(openvdb::math::Transform::createLinearTransform(openvdb::math::Mat4d(
        -2.0, 0.0, 0.0, 0.0, 0.0, along, 1.0, 0.0, 0.0, -1.0, along, 0.0, 5.0, 6.0, 7.0, 1.0)));
    writeVdb("tilted.vdb", {tilted});
    writeVdb("cache.vdb", cache("density"));
    writeVdb("cache_named.vdb", cache("steam"));
    writeVdb("mixed.vdb", {vectors(), ball("density")});
    writeVdb("none.vdb", {});
    writeVdb("empty.vdb", {emptyFog<openvdb::FloatGrid>("density")});
    writeVdb("vectors.vdb", {vectors()});
    writeVdb("points.vdb", {points()});
    writeVdb("frustum.vdb", {frustum()});
    writeVdb("nan.vdb", {notNumbers()});
    writeVdb("one_bad.vdb", {notNumbers(), vectors(), ball("smoke")});
    writeOtherBalls();
    const std::string whole = readBytes("ball.vdb");
    writeBytes("cut.vdb", whole.substr(0, whole.size() / 2));
    writeBytes("head_only.vdb", whole.substr(0, 20));
    writeBytes("garbage.vdb", "This is a text and no volume at all.\n");
    writeBytes("zero.vdb", "");
}

void writeRawFiles() {
    std::string bytes(512, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = char(i % 97);
    writeBytes("cube_8x8x8_uint8.raw", bytes);
    writeBytes("plain.raw", bytes);
    writeBytes("detached.raw", bytes);
    writeBytes("detached.nhdr",
               "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n"
               "data file: detached.raw\n");
    std::string changed = bytes;
    changed[5 + 8 * 1 + 64 * 1] = 80;  // instead of 77
    writeBytes("changed_8x8x8_uint8.raw", changed);
    writeBytes("changed.raw", changed);
    writeBytes("half_8x8x4_uint8.raw", bytes.substr(0, 256));
    writeBytes("cut_8x8x8_uint8.raw", bytes.substr(0, 500));
    writeBytes("long_8x8x8_uint8.raw", bytes + "more");
    writeBytes("garbage_8x8x8_uint8.raw.gz", "no gzip");
    // More values than there are codes.
    std::vector<std::int32_t> wide(48 * 48 * 32);
    for (std::size_t i = 0; i < wide.size(); ++i) wide[i] = std::int32_t(3 * i);
    writeBytes("wide_48x48x32_int32.raw",
               {reinterpret_cast<const char*>(wide.data()), 4 * wide.size()});
    std::vector<float> values(64, 0.25F);
    values[1 + 4 * (2 + 4 * 3)] = std::nanf("");
    values[63] = -std::numeric_limits<float>::infinity();
    writeBytes("nan_4x4x4_float32.raw",
               {reinterpret_cast<const char*>(values.data()), 4 * values.size()});
}

// A volume of zeros with a few bars along z, of which one grows denser from slice to slice.
std::string bars(std::size_t width, std::size_t height, std::size_t depth) {
    std::string bytes(width * height * depth, '\0');
    for (std::size_t z = depth / 4; z < depth / 2; ++z) {
        for (std::size_t n = 0; n < 24; ++n) {
            const std::size_t corner = (z * height + 8 + n) * width + 8;
            bytes[corner] = char(200);
            bytes[corner + 4] = char(70 + z % 64);
        }
    }
    return bytes;
}

void writePacked(const std::string& file, const std::string& bytes) {
    const gzFile out = gzopen(file.c_str(), "wb1");
    gzwrite(out, bytes.data(), unsigned(bytes.size()));
    gzclose(out);
}

// Volumes with the names that `bench table1` looks for, in folders and in folders of folders, one
// of them twice.
void writeTable1Files() {
    std::filesystem::create_directories("table1_all/deep/deeper");
    std::filesystem::create_directories("table1_some");
    const std::string ear = bars(128, 128, 30);
    writeBytes("table1_all/fuel_64x64x64_uint8.raw", bars(64, 64, 64));
    writeBytes("table1_all/deep/fuel_64x64x64_uint8.raw", "not this one");
    writeBytes("table1_all/deep/ear_region_128x128x30_uint8.raw", ear);
    writePacked("table1_all/deep/deeper/cthead_256x256x225_uint8.raw.gz", bars(256, 256, 225));
    writePacked("table1_all/deep/engine_256x256x128_uint8.raw.gz", bars(256, 256, 128));
    writeBytes("table1_some/ear_region_128x128x30_uint8.raw", ear);
    writeBytes("table1_some/fuel_64x64x64_uint8.raw", "too short");
    // Around in a circle.
    std::filesystem::remove("table1_some/again");
    std::filesystem::create_directory_symlink(".", "table1_some/again");
}

// A ball of one value, of voxels of another size or elsewhere.
template <typename Grid = openvdb::FloatGrid>
typename Grid::Ptr ballOf(const std::string& name, typename Grid::ValueType value, double voxel = 1,
                          double away = 0) {
    const auto grid = emptyFog<Grid>(name);
    const auto shape = ball("any");
    for (auto place = shape->cbeginValueOn(); place; ++place)
        grid->getAccessor().setValueOn(place.getCoord(), value);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    grid->transform().postTranslate({away, 0, 0});
    return grid;
}

// Smoke, and what may burn in it or colour it.
void writeFire() {
    using openvdb::Vec3SGrid;
    const openvdb::GridBase::Ptr smoke = ball("density");
    writeVdb("fire.vdb",
             {smoke, ballOf("Flame", 0.75f), ballOf("temperature", 1500.0f),
              ballOf("celsius", 900.0f), ballOf("cold", 0.1f), ballOf("coarse", 1500.0f, 2),
              ballOf("fine", 1500.0f, 0.25), ballOf("far", 1500.0f, 1, 100),
              ballOf<Vec3SGrid>("Cd", {0.25f, 0.5f, 2.0f}), ballOf<Vec3SGrid>("v", {-1, 0, 2}),
              ballOf("r", 0.25f), ballOf("g", 0.5f), ballOf("b", 2.0f)});
    writeVdb("layers.vdb", {smoke, emptyFog<openvdb::FloatGrid>("none"), ballOf("g", 0.5f)});
    const auto celsius = ballOf("temperature", 900.0f);
    celsius->getAccessor().setValueOn({0, 0, 0}, -20.0f);
    writeVdb("celsius.vdb", {smoke, celsius});
}

// Whatever is written to these is refused as by a full disk.
void linkToFullDevice() {
    for (const char* const name : {"full.exr", "full.png", "full.json", "full.raw", "full.svg",
                                   "full.vdb", "full.nrrd", "full.mha", "full.nii.gz"}) {
        std::filesystem::remove(name);
        std::filesystem::create_symlink("/dev/full", name);
    }
    std::filesystem::create_directory("folder.exr");
}

// Writes the grids of several files into one.
void joinFiles(const std::string& to, const std::vector<std::string>& from) {
    openvdb::GridPtrVec grids;
    for (const std::string& name : from) {
        openvdb::io::File file(name);
        file.open(/*delayLoad=*/false);
        const openvdb::GridPtrVecPtr held = file.getGrids();
        grids.insert(grids.end(), held->begin(), held->end());
    }
    writeVdb(to, grids);
}

}  // namespace

// make_fixtures [OUTPUT.vdb INPUT.vdb...]: writes all files, or joins some.
int main(int count, char** words) {
    openvdb::initialize();
    if (count > 2) {
        joinFiles(words[1], {words + 2, words + count});
        return 0;
    }
    linkToFullDevice();
    writeVdbFiles();
    writeRawFiles();
    writeTable1Files();
    writeSeveral();
    writeFire();
}
