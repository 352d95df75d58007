// SPDX-License-Identifier: Apache-2.0
// Volumes of more values than there are codes: what is kept of each value, and what rays see,
// against plain sums in double precision over the values that were written.

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/ingest/value_statistics.h"
#include "deltasplat/render.h"
#include "unit/ingest_helpers.h"
#include "volume/code_tree.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

using testing::TempFolder;

constexpr glm::ivec3 kDims(56, 48, 40);
constexpr std::size_t kVoxels = std::size_t(kDims.x) * kDims.y * kDims.z;

// A volume that a code book of equal steps would spoil.
struct Case {
    const char* name;
    double bulkWidth;  // of all but a hundredth of the values, about
    std::function<double(std::size_t)> valueAt;
};

class Cases {
  public:
    std::vector<Case> all() {
        const auto sign = [](std::size_t i) { return i % 2 == 0 ? 1 : -1; };
        return {
            {"one outlier", 0.006, [&](std::size_t i) { return i == 4711 ? 1000 : in(0, 0.006); }},
            {"outliers of both signs", 0.006,
             [=, this](std::size_t i) {
                 return i % 900 == 7 ? sign(i / 900) * std::pow(10, in(0, 6)) : in(0, 0.006);
             }},
            {"six decades", 1000, [&](std::size_t) { return std::pow(10, in(-3, 3)); }},
            {"six decades of both signs", 1000,
             [=, this](std::size_t i) { return sign(i) * std::pow(10, in(-3, 3)); }},
            {"CT", 4000,
             [&](std::size_t i) { return i % 3 == 0 ? -1000 + in(-9, 9) : in(-1000, 3000); }},
            {"around 0", 2, [&](std::size_t) { return in(-1, 1); }},
            {"denormals", 0.006,
             [&](std::size_t i) {
                 return i % 7 == 0 ? std::ldexp(double(i), -149) : in(0, 0.006);
             }},
            {"the ends of floats", 1,
             [&](std::size_t i) {
                 const double most = double(std::numeric_limits<float>::max());
                 return i == 99 ? most : i == 4711 ? -most : in(0, 1);
             }},
            {"nothing but faint noise", 2e-7,
             [&](std::size_t i) { return i % 5 == 0 ? 0 : in(-1e-7, 1e-7); }},
        };
    }

  private:
    double in(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    std::mt19937 random_{20};
};

template <typename T>
std::vector<T> valuesOf(const Case& one) {
    std::vector<T> values(kVoxels);
    for (std::size_t i = 0; i < kVoxels; ++i) values[i] = T(one.valueAt(i));
    return values;
}

std::size_t placeOf(const glm::ivec3& at) {
    return (std::size_t(at.z) * kDims.y + std::size_t(at.y)) * kDims.x + std::size_t(at.x);
}

openvdb::Coord coordOf(std::size_t i) {
    return {int(i % kDims.x), int(i / kDims.x % kDims.y), int(i / kDims.x / kDims.y)};
}

template <typename T>
Volume readRaw(const std::string& type, const std::vector<T>& values,
               std::vector<std::string>* warnings = nullptr) {
    const std::string file = "v_56x48x40_" + type + ".raw";
    testing::writeBytes(file, testing::bytesOf(values));
    ReadOptions options;
    options.keepInexact = true;
    Listener listener;
    listener.warning = [&](const std::string& line) {
        if (warnings) warnings->push_back(line);
    };
    return readVolume(file, options, listener);
}

double keptValue(const Volume& volume, std::size_t i) {
    return volume.codeBook().valueOf(volume.codes()->tree().getValue(coordOf(i)));
}

// Every value within 2e-4 of itself, or within 2^-16 of the bulk's width.
template <typename T>
void expectKept(const std::string& type) {
    const TempFolder folder;
    Cases cases;
    for (const Case& one : cases.all()) {
        SCOPED_TRACE(one.name);
        const std::vector<T> values = valuesOf<T>(one);
        std::vector<std::string> warnings;
        const Volume volume = readRaw(type, values, &warnings);
        ASSERT_FALSE(volume.codeBook().isExact());
        double largest = 0;
        double low = double(values[0]);
        double high = low;
        for (std::size_t i = 0; i < kVoxels; ++i) {
            const auto own = double(values[i]);
            const double off = std::fabs(keptValue(volume, i) - own);
            ASSERT_LE(off, std::max(2e-4 * std::fabs(own), 0x1p-16 * one.bulkWidth)) << own;
            ASSERT_LE(
                off, volume.codeBook().largestErrorOf(volume.codes()->tree().getValue(coordOf(i))) *
                         (1 + 1e-9));
            largest = std::max(largest, off);
            low = std::min(low, own);
            high = std::max(high, own);
        }
        EXPECT_EQ(volume.codeError().absolute, largest);
        EXPECT_LE(volume.codeError().relative, 2e-4);
        EXPECT_EQ(volume.valueMin(), low);
        EXPECT_EQ(volume.valueMax(), high);
        EXPECT_TRUE(warnings.empty()) << warnings[0];
    }
}

TEST(FloatValues, EveryFloatIsKept) {
    expectKept<float>("float32");
}

TEST(FloatValues, EveryDoubleIsKept) {
    expectKept<double>("float64");
}

// Both needs at once, where codes suffice: not only what is far from 0.
TEST(FloatValues, BesideAnOutlierSmallValuesAreKeptAsThemselves) {
    const TempFolder folder;
    Cases cases;
    const std::vector<float> values = valuesOf<float>(cases.all()[0]);
    const Volume volume = readRaw("float32", values);
    for (std::size_t i = 0; i < kVoxels; ++i) {
        const auto own = double(values[i]);
        const double off = std::fabs(keptValue(volume, i) - own);
        ASSERT_LE(off, 2e-4 * std::fabs(own)) << own;
        if (own < 1) {
            ASSERT_LE(off, 0x1p-16 * 0.006) << own;
        }
    }
}

// Few codes, as asked for, are too few for fog beside an outlier.
TEST(FloatValues, WhatIsKeptBadlyIsSaid) {
    const TempFolder folder;
    Cases cases;
    const std::vector<float> values = valuesOf<float>(cases.all()[0]);
    testing::writeBytes("v_56x48x40_float32.raw", testing::bytesOf(values));
    std::vector<std::string> warnings;
    Listener listener;
    listener.warning = [&](const std::string& line) { warnings.push_back(line); };
    ReadOptions options;
    options.bits = 16;
    const Volume volume = readVolume("v_56x48x40_float32.raw", options, listener);
    EXPECT_GT(volume.codeError().relative, 0.9);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("v_56x48x40_float32.raw: values are kept as codes that are off by"),
              std::string::npos)
        << warnings[0];
    warnings.clear();
    readVolume("v_56x48x40_float32.raw", {}, listener);
    EXPECT_TRUE(warnings.empty());
}

// Frequent values, such as backgrounds, stay what they are, and are counted as they are.
TEST(FloatValues, FrequentValuesAreExact) {
    const TempFolder folder;
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 1e-3);
    for (const double background : {0.7, -1000.3, 0.0}) {
        std::vector<double> values(kVoxels);
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < kVoxels; ++i) {
            const bool has = random() % 4 == 0;
            values[i] = has ? background : background + noise(random);
            count += values[i] == background ? 1 : 0;
        }
        const Volume volume = readRaw("float64", values);
        ASSERT_FALSE(volume.codeBook().isExact());
        ASSERT_TRUE(volume.mostFrequent().has_value());
        EXPECT_EQ(volume.mostFrequent()->value, background);
        EXPECT_EQ(volume.mostFrequent()->count, count);
        EXPECT_EQ(guessBackground(volume), background);
        for (std::size_t i = 0; i < kVoxels; ++i) {
            if (values[i] == background) {
                ASSERT_EQ(keptValue(volume, i), background);
            }
        }
    }
}

TEST(FloatValues, WithoutAFrequentValueThereIsNoBackground) {
    const TempFolder folder;
    std::mt19937 random(5);
    std::vector<float> values(kVoxels);
    // A fifth of the values have one code, but none is frequent.
    for (std::size_t i = 0; i < kVoxels; ++i)
        values[i] = i % 4 == 0 ? std::ldexp(float(random() % 1000000), -149) : float(random());
    const Volume volume = readRaw("float32", values);
    EXPECT_EQ(guessBackground(volume), std::nullopt);
}

// The range of whole numbers of more than 65536 kinds is their own.
TEST(FloatValues, WideIntegersTellTheirOwnRange) {
    const TempFolder folder;
    std::mt19937 random(11);
    std::vector<std::int32_t> values(kVoxels);
    for (std::int32_t& value : values) value = 3 + std::int32_t(random() % 999994u);
    values[7] = 3;
    values[8] = 999996;
    const Volume volume = readRaw("int32", values);
    ASSERT_FALSE(volume.codeBook().isExact());
    EXPECT_EQ(volume.valueMin(), 3);
    EXPECT_EQ(volume.valueMax(), 999996);
}

// One pixel a voxel, pixels on voxels, no footprint: a pixel is a sum, or the largest, of a row.
Image seenAlong(const Volume& volume, Mode mode, int axis) {
    RenderOptions options;
    options.mode = mode;
    options.splat.footprintWidth = 1;
    const char* const views[] = {"right", "top", "front"};
    options.camera.view = views[axis];
    const glm::ivec2 size = axis == 0   ? glm::ivec2(kDims.z, kDims.y)
                            : axis == 1 ? glm::ivec2(kDims.x, kDims.z)
                                        : glm::ivec2(kDims.x, kDims.y);
    options.camera.sizePixels = size;
    options.camera.frameWidthWorld = size.x;
    return render(volume, options).image;
}

template <typename T>
void expectSeen(const Volume& volume, const std::vector<T>& values,
                const std::function<bool(std::size_t)>& isActive) {
    for (int axis = 0; axis < 3; ++axis) {
        const Image sums = seenAlong(volume, Mode::kXray, axis);
        const Image largest = seenAlong(volume, Mode::kMip, axis);
        for (int y = 0; y < sums.size.y; ++y) {
            for (int x = 0; x < sums.size.x; ++x) {
                // Seen from the right, x runs along -z; from the top, y along +z.
                const glm::ivec3 first = axis == 0 ? glm::ivec3(0, kDims.y - 1 - y, kDims.z - 1 - x)
                                         : axis == 1 ? glm::ivec3(x, 0, y)
                                                     : glm::ivec3(x, kDims.y - 1 - y, 0);
                double sum = 0;
                double magnitude = 0;
                double most = -std::numeric_limits<double>::infinity();
                for (int step = 0; step < kDims[axis]; ++step) {
                    glm::ivec3 at = first;
                    at[axis] = step;
                    if (!isActive(placeOf(at))) continue;
                    const auto value = double(values[placeOf(at)]);
                    sum += value;
                    magnitude += std::fabs(value);
                    most = std::max(most, value);
                }
                ASSERT_NEAR(sums.pixel(x, y)[0], sum, 1e-6 * magnitude)
                    << axis << " " << x << " " << y;
                if (std::isinf(most)) continue;
                ASSERT_NEAR(largest.pixel(x, y)[0], most, 1e-5 * std::fabs(most))
                    << axis << " " << x << " " << y;
            }
        }
    }
}

template <typename T>
void expectRaysSee(const std::string& type) {
    const TempFolder folder;
    Cases cases;
    for (const Case& one : cases.all()) {
        // Sums of such are no floats.
        if (std::string(one.name) == "the ends of floats") continue;
        SCOPED_TRACE(one.name);
        const std::vector<T> values = valuesOf<T>(one);
        const Volume volume = readRaw(type, values);
        ASSERT_TRUE(volume.source());
        expectSeen(volume, values, [](std::size_t) { return true; });
    }
}

TEST(FloatValues, RaysSeeFloatsThemselves) {
    expectRaysSee<float>("float32");
}

TEST(FloatValues, RaysSeeDoublesThemselves) {
    expectRaysSee<double>("float64");
}

TEST(FloatValues, RaysSeeWideIntegersThemselves) {
    const TempFolder folder;
    std::mt19937 random(12);
    std::vector<std::int32_t> values(kVoxels);
    for (std::int32_t& value : values) value = std::int32_t(random());
    expectSeen(readRaw("int32", values), values, [](std::size_t) { return true; });
}

TEST(FloatValues, RaysSeeActiveVoxelsOfAGrid) {
    const TempFolder folder;
    openvdb::initialize();
    Cases cases;
    const std::vector<float> values = valuesOf<float>(cases.all()[0]);
    // A tile, a block that is full, and what is not active.
    const auto isActive = [](std::size_t i) { return i % 11 != 0 || i < 9000; };
    auto grid = openvdb::FloatGrid::create(0.5f);
    for (std::size_t i = 0; i < kVoxels; ++i) {
        if (isActive(i)) grid->tree().setValue(coordOf(i), values[i]);
    }
    std::vector<float> expected = values;
    const openvdb::CoordBBox tile(openvdb::Coord(8, 16, 24), openvdb::Coord(15, 23, 31));
    grid->sparseFill(tile, 0.25f, true);
    for (auto at = tile.begin(); at; ++at) {
        const glm::ivec3 place((*at).x(), (*at).y(), (*at).z());
        expected[placeOf(place)] = 0.25f;
    }
    grid->tree().prune();
    grid->setName("density");
    openvdb::io::File("a.vdb").write({grid});
    ReadOptions options;
    options.keepInexact = true;
    const Volume volume = readVolume("a.vdb", options);
    ASSERT_FALSE(volume.codeBook().isExact());
    expectSeen(volume, expected, [&](std::size_t i) { return grid->tree().isValueOn(coordOf(i)); });
}

// Thousands of slices are as exact as one.
TEST(FloatValues, SumsOfManySlicesAreExact) {
    const TempFolder folder;
    constexpr int kSlices = 6000;
    const std::vector<float> values(std::size_t(7) * 7 * kSlices, 0.1f);
    testing::writeBytes("v_7x7x6000_float32.raw", testing::bytesOf(values));
    RenderOptions options;
    options.mode = Mode::kXray;
    options.splat.footprintWidth = 1;
    options.camera.view = "front";
    options.camera.sizePixels = {7, 7};
    options.camera.frameWidthWorld = 7;
    const Image image = render(readVolume("v_7x7x6000_float32.raw"), options).image;
    const double sum = double(0.1f) * kSlices;
    EXPECT_NEAR(image.pixel(3, 3)[0], sum, 1e-6 * sum);
}

}  // namespace
}  // namespace deltasplat
