// SPDX-License-Identifier: Apache-2.0
// Writes the odd files that the command-line tests are given, into the current folder.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointDataGrid.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

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

openvdb::FloatGrid::Ptr floatGrid(const std::string& name) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0F);
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

// A ball of fog, 0.5 everywhere inside.
openvdb::FloatGrid::Ptr ball(const std::string& name) {
    openvdb::FloatGrid::Ptr grid = floatGrid(name);
    auto accessor = grid->getAccessor();
    for (int x = -6; x <= 6; ++x)
        for (int y = -6; y <= 6; ++y)
            for (int z = -6; z <= 6; ++z)
                if (x * x + y * y + z * z <= 36) accessor.setValue({x, y, z}, 0.5F);
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

void writeVdbFiles() {
    writeVdb("ball.vdb", {ball("density")});
    writeVdb("two.vdb", {ball("density"), ball("heat")});
    writeVdb("mixed.vdb", {vectors(), ball("density")});
    writeVdb("none.vdb", {});
    writeVdb("empty.vdb", {floatGrid("density")});
    writeVdb("vectors.vdb", {vectors()});
    writeVdb("points.vdb", {points()});
    writeVdb("frustum.vdb", {frustum()});
    writeVdb("nan.vdb", {notNumbers()});
    writeVdb("one_bad.vdb", {notNumbers(), vectors(), ball("smoke")});
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
    writeBytes("cut_8x8x8_uint8.raw", bytes.substr(0, 500));
    writeBytes("long_8x8x8_uint8.raw", bytes + "more");
    writeBytes("garbage_8x8x8_uint8.raw.gz", "no gzip");
    std::vector<float> values(64, 0.25F);
    values[1 + 4 * (2 + 4 * 3)] = std::nanf("");
    values[63] = -std::numeric_limits<float>::infinity();
    writeBytes("nan_4x4x4_float32.raw",
               {reinterpret_cast<const char*>(values.data()), 4 * values.size()});
}

// Whatever is written to these is refused as by a full disk.
void linkToFullDevice() {
    for (const char* const name : {"full.exr", "full.png", "full.json", "full.raw", "full.svg", "full.vdb"}) {
        std::filesystem::remove(name);
        std::filesystem::create_symlink("/dev/full", name);
    }
    std::filesystem::create_directory("folder.exr");
}

}  // namespace

int main() {
    openvdb::initialize();
    linkToFullDevice();
    writeVdbFiles();
    writeRawFiles();
}
