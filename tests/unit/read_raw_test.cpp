// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/threads.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using testing::bytesOf;
using testing::TempFolder;
using testing::writeBytes;
using testing::writeGzip;

// A volume as a plain array, x fastest, and the name that its file needs.
template <typename T>
struct Plain {
    glm::ivec3 dims;
    std::vector<T> values;

    Plain(const glm::ivec3& size) : dims(size), values(std::size_t(size.x * size.y * size.z)) {}
    T& at(int x, int y, int z) { return values[std::size_t((z * dims.y + y) * dims.x + x)]; }
    std::string file(const std::string& type) const {
        return "v_" + std::to_string(dims.x) + "x" + std::to_string(dims.y) + "x" +
               std::to_string(dims.z) + "_" + type + ".raw";
    }
};

template <typename T>
Plain<T> randomPlain(const glm::ivec3& dims, double low, double high, unsigned seed) {
    Plain<T> plain(dims);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(low, high);
    for (T& voxel : plain.values) voxel = T(value(random));
    return plain;
}

// Compares every voxel of the box, a rim around it, and all statistics with the plain array.
// `relative` is a share of the voxel's own value; either suffices.
template <typename T>
void expectSame(const Volume& volume, Plain<T>& plain, double tolerance = 0, double relative = 0) {
    const auto& tree = volume.codes()->tree();
    std::map<int, std::uint64_t> counts;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double largestError = 0;
    for (int z = -1; z <= plain.dims.z; ++z) {
        for (int y = -1; y <= plain.dims.y; ++y) {
            for (int x = -1; x <= plain.dims.x; ++x) {
                const bool inside = x >= 0 && y >= 0 && z >= 0 && x < plain.dims.x &&
                                    y < plain.dims.y && z < plain.dims.z;
                Code code = 0;
                const bool active = tree.probeValue(openvdb::Coord(x, y, z), code);
                ASSERT_EQ(active, inside) << x << " " << y << " " << z;
                if (!inside) continue;
                const double value = volume.codeBook().valueOf(code);
                const auto own = double(plain.at(x, y, z));
                ASSERT_NEAR(value, own, std::max(tolerance, relative * std::fabs(own)))
                    << x << y << z;
                ++counts[code];
                low = std::min(low, own);
                high = std::max(high, own);
                largestError = std::max(largestError, std::fabs(value - own));
            }
        }
    }
    EXPECT_EQ(volume.activeCount(), plain.values.size());
    EXPECT_EQ(tree.activeVoxelCount(), plain.values.size());
    EXPECT_EQ(volume.valueMin(), low);
    EXPECT_EQ(volume.valueMax(), high);
    EXPECT_EQ(volume.codeError().absolute, largestError);
    EXPECT_EQ(volume.box(), (IndexBox{glm::ivec3(0), plain.dims - 1}));
    ASSERT_EQ(volume.histogram().size(), std::size_t(kCodeCount));
    for (int code = 0; code < kCodeCount; ++code) {
        const auto found = counts.find(code);
        ASSERT_EQ(volume.histogram()[std::size_t(code)], found == counts.end() ? 0 : found->second);
    }
}

template <typename T>
void expectRoundTrip(const std::string& type, double low, double high, double offset) {
    SCOPED_TRACE(type);
    Plain<T> plain = randomPlain<T>({21, 10, 17}, low, high, 3);
    plain.values[5] = T(low);
    plain.values[6] = T(high);
    for (const bool big : {false, true}) {
        const std::string file = plain.file(type + (big ? "be" : "le"));
        writeBytes(file, bytesOf(plain.values, big));
        const Volume volume = readVolume(file);
        EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kInteger);
        EXPECT_EQ(volume.codeBook().offset, offset);
        EXPECT_EQ(volume.type(), type);
        expectSame(volume, plain);
    }
}

TEST(ReadRaw, IntegersAreExactInBothByteOrders) {
    const TempFolder folder;
    expectRoundTrip<std::uint8_t>("uint8", 0, 255, 0);
    expectRoundTrip<std::int8_t>("int8", -128, 127, -128);
    expectRoundTrip<std::uint16_t>("uint16", 0, 65535, 0);
    expectRoundTrip<std::int16_t>("int16", -32768, 32767, -32768);
    expectRoundTrip<std::uint32_t>("uint32", 4294901760.0, 4294967295.0, 4294901760.0);
    expectRoundTrip<std::int32_t>("int32", -2147483648.0, -2147418113.0, -2147483648.0);
    expectRoundTrip<std::int32_t>("int32", -40000, 25535, -40000);
}

template <typename T>
Plain<T> widePlain(const glm::ivec3& dims, double low, double high) {
    Plain<T> plain = randomPlain<T>(dims, low, high, 4);
    plain.values[100] = T(low);
    plain.values[4000] = T(high);
    return plain;
}

// More than 65536 different values.
template <typename T>
void expectFitted(const std::string& type, double low, double high) {
    SCOPED_TRACE(type);
    Plain<T> plain = widePlain<T>({70, 61, 35}, low, high);
    for (const bool big : {false, true}) {
        const std::string file = plain.file(type + (big ? "be" : ""));
        writeBytes(file, bytesOf(plain.values, big));
        const Volume volume = readVolume(file);
        ASSERT_FALSE(volume.codeBook().isExact());
        EXPECT_EQ(volume.valueMin(), double(T(low)));
        EXPECT_EQ(volume.valueMax(), double(T(high)));
        EXPECT_LE(volume.codeError().relative, 2e-4);
        expectSame(volume, plain, 1e-6 * (high - low), 2e-4);
    }
}

TEST(ReadRaw, WideValuesAreKeptAsThemselves) {
    const TempFolder folder;
    expectFitted<float>("float32", -3.5, 12.25);
    expectFitted<double>("float64", -1e-7, 4e-7);
    expectFitted<std::uint32_t>("uint32", 7, 4e9);
    expectFitted<std::int32_t>("int32", -2e9, 65536);
}

// At most 65536 different values, however far apart.
template <typename T>
void expectTable(const std::string& type, double low, double high) {
    SCOPED_TRACE(type);
    Plain<T> plain = widePlain<T>({19, 9, 30}, low, high);
    for (const bool big : {false, true}) {
        const std::string file = plain.file(type + (big ? "be" : ""));
        writeBytes(file, bytesOf(plain.values, big));
        const Volume volume = readVolume(file);
        ASSERT_EQ(volume.codeBook().kind, CodeBook::Kind::kTable);
        expectSame(volume, plain);
    }
}

TEST(ReadRaw, FewWideValuesAreExact) {
    const TempFolder folder;
    expectTable<float>("float32", -3.5, 12.25);
    expectTable<double>("float64", -1e-7, 4e-7);
    expectTable<std::uint32_t>("uint32", 7, 4e9);
    expectTable<std::int32_t>("int32", -2e9, 65536);
}

TEST(ReadRaw, BitsAskForALinearBook) {
    const TempFolder folder;
    Plain<float> plain = widePlain<float>({19, 9, 30}, -3.5, 12.25);
    writeBytes(plain.file("float32"), bytesOf(plain.values));
    ReadOptions options;
    options.bits = 10;
    const Volume volume = readVolume(plain.file("float32"), options);
    EXPECT_NEAR(volume.codeBook().step, 15.75 / 1023, 15.75 / 1023 / 120);
    expectSame(volume, plain, volume.codeBook().step * 0.5000001);
}

TEST(ReadRaw, WholeNumbersStoredAsRealsAreIntegers) {
    const TempFolder folder;
    Plain<float> plain = randomPlain<float>({19, 9, 30}, 0, 1, 4);
    for (float& value : plain.values) value = std::floor(value * 5000) - 7;
    writeBytes(plain.file("float32"), bytesOf(plain.values));
    const Volume volume = readVolume(plain.file("float32"));
    EXPECT_EQ(volume.codeBook().kind, CodeBook::Kind::kInteger);
    expectSame(volume, plain);
    plain.values[77] = -0.0f;
    writeBytes(plain.file("float32"), bytesOf(plain.values));
    EXPECT_EQ(readVolume(plain.file("float32")).codeBook().kind, CodeBook::Kind::kTable);
}

TEST(ReadRaw, OneValueOfEveryWideType) {
    const TempFolder folder;
    Plain<float> plain({3, 3, 3});
    for (float& value : plain.values) value = -2.75f;
    writeBytes(plain.file("float32"), bytesOf(plain.values));
    expectSame(readVolume(plain.file("float32")), plain);
}

// 16 slices of zeros with one block of noise and one constant block.
Plain<std::uint8_t> blockyPlain(const glm::ivec3& dims) {
    Plain<std::uint8_t> plain(dims);
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                const bool constant = x / 8 == 1 && y / 8 == 0 && z / 8 == 1;
                const bool noisy = x / 8 == 0 && y / 8 == 1 && z / 8 == 0;
                if (constant) plain.at(x, y, z) = 9;
                if (noisy) plain.at(x, y, z) = std::uint8_t(x + 3 * y + 17 * z);
            }
        }
    }
    return plain;
}

TEST(ReadRaw, ConstantBlocksAreTiles) {
    const TempFolder folder;
    Plain<std::uint8_t> plain = blockyPlain({32, 24, 16});
    writeBytes(plain.file("uint8"), bytesOf(plain.values));
    const Volume volume = readVolume(plain.file("uint8"));
    expectSame(volume, plain);
    EXPECT_EQ(volume.codes()->tree().leafCount(), 1u);
    EXPECT_EQ(volume.codes()->tree().activeTileCount(), 4u * 3 * 2 - 1);
    EXPECT_EQ(volume.codes()->tree().getValueDepth(openvdb::Coord(8, 0, 8)), 2);
}

// One voxel that differs, at each place of a block in turn, must make the block a leaf.
TEST(ReadRaw, OneOddVoxelMakesALeaf) {
    const TempFolder folder;
    for (int odd = 0; odd < 512; odd += 7) {
        Plain<std::uint8_t> plain({8, 8, 8});
        plain.values[std::size_t(odd)] = 1;
        writeBytes(plain.file("uint8"), bytesOf(plain.values));
        const Volume volume = readVolume(plain.file("uint8"));
        ASSERT_EQ(volume.codes()->tree().leafCount(), 1u) << odd;
        expectSame(volume, plain);
    }
}

TEST(ReadRaw, EverySizeAtTheBorder) {
    const TempFolder folder;
    for (int size = 1; size <= 17; ++size) {
        for (const glm::ivec3& dims :
             {glm::ivec3(size, 9, 3), glm::ivec3(5, size, 8), glm::ivec3(16, 2, size)}) {
            Plain<std::uint16_t> plain = randomPlain<std::uint16_t>(dims, 0, 65536, unsigned(size));
            writeBytes(plain.file("uint16"), bytesOf(plain.values));
            expectSame(readVolume(plain.file("uint16")), plain);
        }
    }
}

// A border block of one value must not become a tile: it would be active outside of the volume.
TEST(ReadRaw, ConstantBorderBlocksStayInside) {
    const TempFolder folder;
    Plain<std::uint8_t> plain({12, 11, 10});
    for (std::uint8_t& value : plain.values) value = 7;
    writeBytes(plain.file("uint8"), bytesOf(plain.values));
    expectSame(readVolume(plain.file("uint8")), plain);
}

TEST(ReadRaw, GzipEqualsPlain) {
    const TempFolder folder;
    for (const std::string type : {"uint8", "float32"}) {
        Plain<float> wide = randomPlain<float>({17, 19, 23}, -4, 4, 5);
        Plain<std::uint8_t> narrow = randomPlain<std::uint8_t>({17, 19, 23}, 0, 256, 5);
        const std::string bytes = type == "uint8" ? bytesOf(narrow.values) : bytesOf(wide.values);
        writeBytes(wide.file(type), bytes);
        writeGzip(wide.file(type) + ".gz", bytes);
        const Volume plain = readVolume(wide.file(type));
        const Volume zipped = readVolume(wide.file(type) + ".gz");
        EXPECT_EQ(plain.histogram(), zipped.histogram());
        EXPECT_EQ(plain.name(), zipped.name());
        EXPECT_EQ(plain.codeBook().offset, zipped.codeBook().offset);
        EXPECT_EQ(plain.codeBook().step, zipped.codeBook().step);
        EXPECT_TRUE(plain.codes()->tree().hasSameTopology(zipped.codes()->tree()));
        type == "uint8" ? expectSame(zipped, narrow)
                        : expectSame(zipped, wide, zipped.codeBook().step * 0.5000001);
    }
}

// Packed or plain is what the bytes are, not what the name says.
TEST(ReadRaw, PackedByContent) {
    const TempFolder folder;
    Plain<std::uint8_t> plain = randomPlain<std::uint8_t>({17, 19, 23}, 0, 256, 5);
    writeGzip(plain.file("uint8"), bytesOf(plain.values));
    expectSame(readVolume(plain.file("uint8")), plain);
    writeBytes(plain.file("uint8") + ".gz", bytesOf(plain.values));
    expectSame(readVolume(plain.file("uint8") + ".gz"), plain);
    // Values that begin as gzip does.
    Plain<std::uint8_t> alike = plain;
    alike.values[0] = 0x1f, alike.values[1] = 0x8b, alike.values[2] = 8;
    writeBytes(plain.file("uint8"), bytesOf(alike.values));
    expectSame(readVolume(plain.file("uint8")), alike);
}

TEST(ReadRaw, SkipsAHeader) {
    const TempFolder folder;
    Plain<std::uint8_t> plain = randomPlain<std::uint8_t>({9, 8, 7}, 0, 256, 6);
    writeBytes("h.raw", std::string(2000000, 'h') + bytesOf(plain.values));
    writeGzip("h.raw.gz", std::string(2000000, 'h') + bytesOf(plain.values));
    ReadOptions options;
    options.raw.dims = glm::i64vec3(plain.dims);
    options.raw.type = "uint8";
    options.raw.skipBytes = 2000000;
    for (const char* file : {"h.raw", "h.raw.gz"}) {
        const Volume volume = readVolume(file, options);
        expectSame(volume, plain);
        EXPECT_EQ(volume.name(), "h");
    }
}

TEST(ReadRaw, PlacesVoxelsInTheWorld) {
    const TempFolder folder;
    writeBytes("a_2x1x1_uint8.raw", "ab");
    ReadOptions options;
    options.raw.spacing = {0.5, 2, 3};
    options.raw.origin = {10, 20, 30};
    const Volume volume = readVolume("a_2x1x1_uint8.raw", options);
    EXPECT_EQ(volume.worldFromIndex() * glm::dvec4(0, 0, 0, 1), glm::dvec4(10, 20, 30, 1));
    EXPECT_EQ(volume.worldFromIndex() * glm::dvec4(2, 3, 4, 1), glm::dvec4(11, 26, 42, 1));
    EXPECT_EQ(volume.voxelSize(), glm::dvec3(0.5, 2, 3));
    EXPECT_EQ(volume.gridClass(), "unknown");
    EXPECT_EQ(volume.background(), 0);
    EXPECT_EQ(readAllVolumes("a_2x1x1_uint8.raw").size(), 1u);
}

TEST(ReadRaw, ReplacesNonFiniteValues) {
    const TempFolder folder;
    Plain<float> plain = randomPlain<float>({10, 9, 8}, 1, 2, 8);
    Plain<float> dirty = plain;
    const float bad[] = {std::nanf(""), std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity()};
    for (int i = 0; i < 3; ++i) {
        plain.values[std::size_t(100 * i + 50)] = -1.5f;
        dirty.values[std::size_t(100 * i + 50)] = bad[i];
    }
    writeBytes(plain.file("float32"), bytesOf(dirty.values));
    ReadOptions options;
    options.nanValue = -1.5;
    const Volume volume = readVolume(plain.file("float32"), options);
    EXPECT_EQ(volume.valueMin(), -1.5);
    EXPECT_EQ(volume.replaced(), 3u);
    expectSame(volume, plain, volume.codeBook().step * 0.5000001);
}

TEST(ReadRaw, NothingButNansIsTheReplacement) {
    const TempFolder folder;
    Plain<double> plain({2, 2, 2});
    for (double& value : plain.values) value = std::nan("");
    writeBytes(plain.file("float64"), bytesOf(plain.values));
    ReadOptions options;
    options.nanValue = 4;
    const Volume volume = readVolume(plain.file("float64"), options);
    EXPECT_EQ(volume.valueMin(), 4);
    EXPECT_EQ(volume.valueMax(), 4);
}

TEST(ReadRaw, ThreadsDoNotMatter) {
    const TempFolder folder;
    Plain<float> plain = randomPlain<float>({70, 65, 33}, -1, 1, 9);
    writeBytes(plain.file("float32"), bytesOf(plain.values));
    const auto read = [&](int threads) {
        const ThreadLimit limit(threads);
        return readVolume(plain.file("float32"));
    };
    const Volume one = read(1);
    const Volume many = read(4);
    EXPECT_EQ(one.histogram(), many.histogram());
    EXPECT_EQ(one.codeBook().offset, many.codeBook().offset);
    EXPECT_EQ(one.codeBook().step, many.codeBook().step);
    ASSERT_TRUE(one.codeBook().pieces && many.codeBook().pieces);
    EXPECT_EQ(*one.codeBook().table, *many.codeBook().table);
    EXPECT_EQ(one.codeError().absolute, many.codeError().absolute);
    EXPECT_EQ(one.codeError().relative, many.codeError().relative);
    EXPECT_TRUE(one.codes()->tree().hasSameTopology(many.codes()->tree()));
    expectSame(many, plain, 2 * 0x1p-16);
}

TEST(ReadRaw, ReportsRisingProgressUpToOne) {
    const TempFolder folder;
    Plain<float> plain = randomPlain<float>({8, 8, 1000}, -1, 1, 9);
    writeBytes(plain.file("float32"), bytesOf(plain.values));
    std::vector<double> shares;
    Listener listener;
    listener.progress = [&](double share) { shares.push_back(share); };
    readVolume(plain.file("float32"), {}, listener);
    ASSERT_GT(shares.size(), 10u);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GT(shares.front(), 0);
    EXPECT_EQ(shares.back(), 1);
}

}  // namespace
}  // namespace deltasplat
