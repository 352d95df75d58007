// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <limits>
#include <map>
#include <random>
#include <thread>
#include <vector>

#include "deltasplat/image/write_image.h"
#include "deltasplat/threads.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image randomImage(glm::ivec2 size) {
    std::mt19937 random(7);
    const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
    Image image(size);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const float alpha = unit();
        for (int channel = 0; channel < 3; ++channel) image.rgba[i + channel] = alpha * unit();
        image.rgba[i + 3] = alpha;
    }
    return image;
}

Image onePixel(float red, float green, float blue, float alpha) {
    Image image({1, 1});
    image.rgba = {red, green, blue, alpha};
    return image;
}

// What OpenImageIO finds in a file, the samples as they are stored.
template <typename Sample>
struct Stored {
    OIIO::ImageSpec spec;
    std::vector<Sample> samples;
};

template <typename Sample>
Stored<Sample> readBack(const fs::path& file, OIIO::TypeDesc type) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(file.string(), &config);
    if (!input) throw std::runtime_error(OIIO::geterror());
    Stored<Sample> stored{input->spec(), {}};
    stored.samples.resize(std::size_t(stored.spec.image_pixels()) * 4);
    if (!input->read_image(0, 0, 0, 4, type, stored.samples.data())) {
        throw std::runtime_error(input->geterror());
    }
    return stored;
}

template <typename Sample>
std::vector<Sample> writeAndRead(const Image& image, const char* name, OIIO::TypeDesc type,
                                 const ImageFileOptions& options) {
    const test::TempFolder folder;
    writeImage(folder / name, image, options);
    return readBack<Sample>(folder / name, type).samples;
}

TEST(WriteImage, FloatExrIsBitExact) {
    ImageFileOptions options;
    options.floatExr = true;
    Image image = randomImage({37, 21});
    image.rgba[0] = -2.5f;
    image.rgba[1] = 1e30f;
    image.rgba[2] = std::numeric_limits<float>::denorm_min();
    EXPECT_EQ(writeAndRead<float>(image, "out.exr", OIIO::TypeFloat, options), image.rgba);
}

TEST(WriteImage, HalfExrIsWithinHalfAStep) {
    const Image image = randomImage({64, 40});
    const std::vector<float> stored = writeAndRead<float>(image, "out.EXR", OIIO::TypeFloat, {});
    for (std::size_t i = 0; i < stored.size(); ++i) {
        // A half has 11 significant bits, and steps of 2^-24 at the least.
        const float step = std::max(std::ldexp(1.0f, std::ilogb(image.rgba[i]) - 10), 0x1p-24f);
        ASSERT_LE(std::abs(stored[i] - image.rgba[i]), step / 2) << "sample " << i;
    }
}

TEST(WriteImage, ExrKeepsChannelsAndSize) {
    const test::TempFolder folder;
    writeImage(folder / "out.exr", randomImage({5, 3}), {});
    const OIIO::ImageSpec spec = readBack<float>(folder / "out.exr", OIIO::TypeFloat).spec;
    EXPECT_EQ(spec.width, 5);
    EXPECT_EQ(spec.height, 3);
    EXPECT_EQ(spec.format, OIIO::TypeHalf);
    EXPECT_EQ(spec.channelnames, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
}

// Reads the attributes of an OpenEXR header by its published layout, without any library.
std::map<std::string, std::pair<std::string, std::string>> exrAttributes(const std::string& bytes) {
    std::map<std::string, std::pair<std::string, std::string>> attributes;
    std::size_t at = 8;  // behind magic number and version
    while (bytes.at(at) != 0) {
        const std::string name = bytes.c_str() + at;
        at += name.size() + 1;
        const std::string type = bytes.c_str() + at;
        at += type.size() + 1;
        std::int32_t size = 0;
        std::memcpy(&size, &bytes.at(at), 4);
        attributes[name] = {type, bytes.substr(at + 4, std::size_t(size))};
        at += 4 + std::size_t(size);
    }
    return attributes;
}

// A view that is neither symmetric nor without translation, so that a wrong order shows.
glm::dmat4 lopsidedMatrix() {
    glm::dmat4 matrix(1.0);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) matrix[column][row] = 1 + 4 * column + row;
    }
    return matrix;
}

TEST(WriteImage, ExrStoresMatricesForRowVectors) {
    const test::TempFolder folder;
    ImageFileOptions options;
    options.cameraFromWorld = lopsidedMatrix();
    options.ndcFromWorld = lopsidedMatrix() * 0.5;
    writeImage(folder / "out.exr", randomImage({4, 4}), options);
    const auto attributes = exrAttributes(readBytes(folder / "out.exr"));

    const auto& [type, bytes] = attributes.at("worldToCamera");
    ASSERT_EQ(type, "m44f");
    float stored[4][4];
    ASSERT_EQ(bytes.size(), sizeof stored);
    std::memcpy(stored, bytes.data(), sizeof stored);
    const glm::dvec4 world(2, -3, 5, 1);
    const glm::dvec4 camera = *options.cameraFromWorld * world;
    for (int column = 0; column < 4; ++column) {
        double sum = 0;
        for (int row = 0; row < 4; ++row) sum += world[row] * stored[row][column];
        EXPECT_EQ(sum, camera[column]);
    }
    EXPECT_EQ(stored[3][0], 13);  // the translation is the last row

    ASSERT_EQ(attributes.count("worldToNDC"), 1u);
    ASSERT_EQ(attributes.at("worldToNDC").first, "m44f");
    std::memcpy(stored, attributes.at("worldToNDC").second.data(), sizeof stored);
    EXPECT_EQ(stored[3][1], 7);
}

TEST(WriteImage, ExrWithoutACameraHasNoMatrices) {
    const test::TempFolder folder;
    writeImage(folder / "out.exr", randomImage({4, 4}), {});
    const auto attributes = exrAttributes(readBytes(folder / "out.exr"));
    EXPECT_EQ(attributes.count("worldToCamera"), 0u);
    EXPECT_EQ(attributes.count("worldToNDC"), 0u);
}

TEST(WriteImage, OpenImageIoFindsTheMatrices) {
    const test::TempFolder folder;
    ImageFileOptions options;
    options.cameraFromWorld = lopsidedMatrix();
    writeImage(folder / "out.exr", randomImage({4, 4}), options);
    const OIIO::ImageSpec spec = readBack<float>(folder / "out.exr", OIIO::TypeFloat).spec;
    float stored[16] = {};
    ASSERT_TRUE(spec.getattribute("worldtocamera", OIIO::TypeMatrix, stored));
    for (int i = 0; i < 16; ++i) EXPECT_EQ(stored[i], (*options.cameraFromWorld)[i / 4][i % 4]);
}

int yearOfCentury() {
    const std::time_t now = std::time(nullptr);
    return std::gmtime(&now)->tm_year % 100;
}

TEST(WriteImage, StoresMetadataAndNoClockTime) {
    const test::TempFolder folder;
    ImageFileOptions options;
    options.metadata = {{"method", "delta"}, {"command", "render a.vdb -o \"b c.png\""}};
    for (const char* name : {"out.exr", "out.png", "out.tif", "out.jpg"}) {
        writeImage(folder / name, randomImage({4, 4}), options);
        const bool isNamed = name[4] == 'e' || name[4] == 'p';
        const std::string bytes = readBytes(folder / name);
        EXPECT_EQ(bytes.find("20" + std::to_string(yearOfCentury()) + ":"), std::string::npos);
        if (!isNamed) {
            const auto input = OIIO::ImageInput::open((folder / name).string());
            ASSERT_TRUE(input) << OIIO::geterror();
            EXPECT_EQ(input->spec().get_string_attribute("ImageDescription"),
                      "deltasplat:method: delta\ndeltasplat:command: render a.vdb -o \"b c.png\"");
            EXPECT_EQ(input->spec().get_string_attribute("DateTime"), "") << name;
            continue;
        }
        const OIIO::ImageSpec spec = readBack<float>(folder / name, OIIO::TypeFloat).spec;
        EXPECT_EQ(spec.get_string_attribute("deltasplat:method"), "delta") << name;
        EXPECT_EQ(spec.get_string_attribute("deltasplat:command"), "render a.vdb -o \"b c.png\"");
        EXPECT_EQ(spec.get_string_attribute("DateTime"), "") << name;
        EXPECT_EQ(spec.find_attribute("Software"), nullptr) << name;
    }
}

// A segment of a .jpg holds less than 64 KiB.
TEST(WriteImage, JpegShortensMetadata) {
    const test::TempFolder folder;
    ImageFileOptions options;
    options.metadata = {{"command", std::string(200000, 'x')}};
    writeImage(folder / "out.jpg", randomImage({4, 4}), options);
    const auto input = OIIO::ImageInput::open((folder / "out.jpg").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().width, 4);
    EXPECT_EQ(input->spec().get_string_attribute("ImageDescription"),
              "deltasplat:command: " + std::string(30000 - 20, 'x'));
}

// The sample that IEC 61966-2-1 asks for.
template <typename Sample>
Sample expectedSample(double premultiplied, double alpha) {
    const double linear = premultiplied / alpha;
    const double srgb =
        linear <= 0.0031308 ? linear * 12.92 : std::pow(linear, 1.0 / 2.4) * 1.055 - 0.055;
    return Sample(std::floor(srgb * std::numeric_limits<Sample>::max() + 0.5));
}

template <typename Sample>
void expectExact(const char* name, int bits, OIIO::TypeDesc type) {
    ImageFileOptions options;
    options.bits = bits;
    options.dither = false;
    const Image image = randomImage({50, 30});
    const auto stored = writeAndRead<Sample>(image, name, type, options);
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const double alpha = image.rgba[i | 3];
        const Sample expected =
            i % 4 == 3 ? Sample(std::floor(alpha * std::numeric_limits<Sample>::max() + 0.5))
                       : expectedSample<Sample>(image.rgba[i], alpha);
        ASSERT_EQ(stored[i], expected) << "sample " << i;
    }
}

TEST(WriteImage, EightBitPngIsRoundedToNearest) {
    expectExact<std::uint8_t>("out.png", 8, OIIO::TypeUInt8);
}

TEST(WriteImage, SixteenBitPngIsRoundedToNearest) {
    expectExact<std::uint16_t>("out.png", 16, OIIO::TypeUInt16);
}

TEST(WriteImage, TiffIsRoundedToNearest) {
    expectExact<std::uint8_t>("out.tif", 8, OIIO::TypeUInt8);
    expectExact<std::uint16_t>("out.TIFF", 16, OIIO::TypeUInt16);
}

TEST(WriteImage, JpegIsThePictureOverBlack) {
    const test::TempFolder folder;
    // Slow enough that little is lost.
    Image image({64, 48});
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            float* pixel = image.pixel(x, y);
            pixel[3] = float(x + 1) / 64;
            pixel[0] = 0.8f * pixel[3];
            pixel[1] = float(y) / 48 * pixel[3];
            pixel[2] = 2;  // light beyond what can be shown
        }
    }
    ImageFileOptions options;
    options.dither = false;
    writeImage(folder / "out.jpg", image, options);
    const auto input = OIIO::ImageInput::open((folder / "out.jpg").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    ASSERT_EQ(input->spec().nchannels, 3);
    std::vector<std::uint8_t> stored(3 * 64 * 48);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt8, stored.data()));
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const double linear = std::min(1.0f, image.rgba[i / 3 * 4 + i % 3]);
        ASSERT_NEAR(stored[i], expectedSample<std::uint8_t>(linear, 1), 5) << i;
    }
}

// A ramp so slow that its steps would be 200 pixels wide comes out right on average everywhere.
TEST(WriteImage, EightBitsAreDithered) {
    Image image({800, 48});
    const auto alphaAt = [](int x) { return (30 + 4.0 * (x + 0.5) / 800) / 255; };
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 800; ++x) {
            float* pixel = image.pixel(x, y);
            pixel[3] = float(alphaAt(x));
            pixel[0] = pixel[1] = pixel[2] = pixel[3];
        }
    }
    const auto stored =
        writeAndRead<std::uint8_t>(image, "out.png", OIIO::TypeUInt8, ImageFileOptions{});
    for (int left = 0; left < 800; left += 16) {
        double sum = 0;
        double expected = 0;
        for (int y = 0; y < 48; y += 16) {
            for (int i = 0; i < 256; ++i) {
                const int x = left + i % 16;
                sum += stored[4 * std::size_t((y + i / 16) * 800 + x) + 3];
                expected += 255 * alphaAt(x);
            }
        }
        EXPECT_NEAR(sum / 768, expected / 768, 0.03) << left;
    }
    // Whole numbers stay what they are.
    for (std::size_t i = 0; i < stored.size(); i += 4) ASSERT_EQ(stored[i], 255);
}

TEST(WriteImage, PngHasTheDepthAskedForAndIsTaggedSrgb) {
    const test::TempFolder folder;
    for (const int bits : {8, 16}) {
        ImageFileOptions options;
        options.bits = bits;
        writeImage(folder / "out.png", randomImage({4, 4}), options);
        const std::string bytes = readBytes(folder / "out.png");
        EXPECT_EQ(bytes[24], bits);  // IHDR: bit depth
        EXPECT_EQ(bytes[25], 6);     // IHDR: colour with alpha
        EXPECT_NE(bytes.find("sRGB"), std::string::npos);
    }
}

TEST(WriteImage, PngClampsAndIsClearWhereAlphaIsZero) {
    using Samples = std::vector<std::uint8_t>;
    const auto stored = [](const Image& image) {
        ImageFileOptions options;
        options.dither = false;
        return writeAndRead<std::uint8_t>(image, "out.png", OIIO::TypeUInt8, options);
    };
    EXPECT_EQ(stored(onePixel(0.9f, -1, kInfinity, 0.5f)), (Samples{255, 0, 255, 128}));
    EXPECT_EQ(stored(onePixel(1, 1, 1, 0)), (Samples{0, 0, 0, 0}));
    EXPECT_EQ(stored(onePixel(1, kNan, 0, 7)), (Samples{255, 0, 0, 255}));
    EXPECT_EQ(stored(onePixel(1, 1, 1, kNan)), (Samples{0, 0, 0, 0}));
}

TEST(WriteImage, ExrNeverStoresNanOrInfinity) {
    const Image image = onePixel(kNan, kInfinity, -kInfinity, 1e6f);
    EXPECT_EQ(writeAndRead<float>(image, "out.exr", OIIO::TypeFloat, {}),
              (std::vector<float>{0, 65504, -65504, 65504}));
    ImageFileOptions options;
    options.floatExr = true;
    constexpr float kLargest = std::numeric_limits<float>::max();
    EXPECT_EQ(writeAndRead<float>(image, "out.exr", OIIO::TypeFloat, options),
              (std::vector<float>{0, kLargest, -kLargest, 1e6f}));
}

TEST(WriteImage, SamePictureGivesSameBytesOnAnyNumberOfThreads) {
    const test::TempFolder folder;
    const Image image = randomImage({300, 200});
    for (const std::string extension : {".exr", ".png", ".tif", ".jpg"}) {
        for (const int threads : {1, 2, 8}) {
            const ThreadLimit limit(threads);
            OIIO::attribute("threads", threads);
            writeImage(folder / (std::to_string(threads) + extension), image, {});
        }
        const std::string bytes = readBytes(folder / ("1" + extension));
        EXPECT_GT(bytes.size(), 1000u);
        EXPECT_TRUE(bytes == readBytes(folder / ("2" + extension))) << extension;
        EXPECT_TRUE(bytes == readBytes(folder / ("8" + extension))) << extension;
    }
}

// OpenEXR's threads are those of the process.
TEST(WriteImage, ExrIsWrittenByThreadsOfDifferentLimitsAtOnce) {
    const Image image = randomImage({60, 200});
    const std::string expected = encodeImage("out.exr", image, {});
    std::atomic<int> different = 0;
    {
        std::vector<std::jthread> writers;
        for (int first = 0; first < 6; ++first) {
            writers.emplace_back([&, first] {
                for (int i = 0; i < 150; ++i) {
                    const ThreadLimit limit(1 + (7 * first + 3 * i) % 5);
                    if (encodeImage("out.exr", image, {}) != expected) ++different;
                }
            });
        }
    }
    EXPECT_EQ(different, 0);
}

TEST(WriteImage, NoticesAFullDisk) {
    const test::TempFolder folder;
    for (const char* name : {"out.exr", "out.png", "out.tif", "out.jpg"}) {
        fs::create_symlink("/dev/full", folder / name);
        EXPECT_EQ(
            errorOf([&] {
                writeImage(folder / name, randomImage({4, 4}), {});
            }),
            "output: " + (folder / name).string() + ": cannot be written: No space left on device");
        EXPECT_TRUE(fs::is_symlink(folder / name));
    }
    EXPECT_EQ(folder.count(), 4);
}

// A picture of six numbers, of which one pixel has none.
Image numbersImage() {
    Image image({3, 2});
    for (int i = 0; i < 6; ++i) {
        float* const rgba = &image.rgba[std::size_t(i) * 4];
        rgba[0] = rgba[1] = rgba[2] = std::ldexp(float(i) - 2.5F, i * 5);
        rgba[3] = i == 4 ? 0.0F : 1.0F;
    }
    image.rgba[0] = kNan;
    image.rgba[4] = kInfinity;
    return image;
}

std::vector<float> floatsAt(const std::string& bytes, std::size_t place) {
    std::vector<float> values((bytes.size() - place) / sizeof(float));
    std::memcpy(values.data(), bytes.data() + place, values.size() * sizeof(float));
    return values;
}

std::string encoded(const char* name, const ImageFileOptions& options) {
    return encodeImage(name, numbersImage(), options);
}

TEST(WriteImage, PicturesOfNumbersHoldThem) {
    ImageFileOptions options;
    options.numbers = true;
    const float most = std::numeric_limits<float>::max();
    std::vector<float> expected{0, most, -512, 16384, 1572864, 83886080};
    const std::string npy = encoded("a.npy", options);
    EXPECT_EQ(npy.size(), 128U + 6 * 4);
    EXPECT_EQ(npy.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
    EXPECT_EQ(npy.substr(10, 63),
              "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }    ");
    EXPECT_EQ(npy[127], '\n');
    EXPECT_EQ(floatsAt(npy, 128), expected);

    // The second row alone, and nothing where alpha is 0.
    options.nothing = -1;
    options.region = PixelBox{{1, 1}, {3, 2}};
    EXPECT_EQ(floatsAt(encoded("a.npy", options), 128), (std::vector<float>{-1, 83886080}));
    options.region.reset();
    expected[4] = -1;

    options.worldFromPixel = glm::dmat4({0, 2, 0, 0}, {0, 0, -3, 0}, {2, 0, 0, 0}, {10, 20, 30, 1});
    options.space = "RAS";
    const std::string nrrd = encoded("a.nrrd", options);
    const std::string header =
        "NRRD0005\ntype: float\ndimension: 3\nspace: right-anterior-superior\nsizes: 3 2 1\n"
        "space directions: (0,2,0) (0,0,-3) (2,0,0)\nkinds: domain domain domain\n"
        "endian: little\nencoding: raw\nspace origin: (10,20,30)\n\n";
    EXPECT_EQ(nrrd.substr(0, header.size()), header);
    EXPECT_EQ(floatsAt(nrrd, header.size()), expected);
    // MetaImage's world is LPS.
    const std::string mha = encoded("a.mha", options);
    const std::size_t values = mha.size() - 6 * sizeof(float);
    EXPECT_EQ(mha.substr(0, values),
              "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              "CompressedData = False\nTransformMatrix = 0 -1 0 0 0 -1 -1 0 0\n"
              "Offset = -10 -20 30\nCenterOfRotation = 0 0 0\nElementSpacing = 2 3 2\n"
              "DimSize = 3 2 1\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n");
    EXPECT_EQ(floatsAt(mha, values), expected);
    // A part of the picture lies where it lay.
    options.region = PixelBox{{1, 1}, {3, 2}};
    EXPECT_NE(encoded("a.nrrd", options).find("space origin: (10,22,27)\n"), std::string::npos);
    // Lengths of a known unit: said in one, millimetres in the other.
    options.lengthUnit = "cm";
    EXPECT_NE(encoded("a.nrrd", options).find("\nspace units: \"cm\" \"cm\" \"cm\"\n\n"),
              std::string::npos);
    EXPECT_NE(encoded("a.mha", options).find("\nElementSpacing = 20 30 20\n"), std::string::npos);
    EXPECT_NE(encoded("a.mha", options).find("\nDistanceUnits = mm\n"), std::string::npos);

    const test::TempFolder folder;
    options.region.reset();
    writeImage(folder / "a.tif", numbersImage(), options);
    const auto tiff = OIIO::ImageInput::open((folder / "a.tif").string());
    ASSERT_TRUE(tiff);
    EXPECT_EQ(tiff->spec().nchannels, 1);
    EXPECT_EQ(tiff->spec().format, OIIO::TypeFloat);
    std::vector<float> read(6);
    ASSERT_TRUE(tiff->read_image(0, 0, 0, 1, OIIO::TypeFloat, read.data()));
    EXPECT_EQ(read, expected);
}

TEST(WriteImage, PicturesOfColoursAreNoNumbers) {
    for (const char* const name : {"a.npy", "a.nrrd", "a.mha"}) {
        EXPECT_EQ(errorOf([&] { encoded(name, {}); }),
                  std::string("usage: ") + name +
                      ": got a picture of colours; expected one of numbers, or .exr, .png, .tif or "
                      ".jpg");
    }
}

TEST(CheckImageFile, AcceptsWhatCanBeWrittenAndLeavesNothing) {
    const test::TempFolder folder;
    for (const char* name : {"a.exr", "a.png", "a.PNG", "a.tif", "a.tiff", "a.JPG", "a.jpeg"})
        checkImageFile(folder / name, {8, 8}, {});
    EXPECT_EQ(folder.count(), 0);
}

TEST(CheckImageFile, RefusesWhatCannot) {
    const auto check = [](const fs::path& file, const ImageFileOptions& options) {
        return errorOf([&] { checkImageFile(file, {8, 8}, options); });
    };
    EXPECT_EQ(check("out.gif", {}),
              "usage: out.gif: got extension \".gif\"; expected .exr, .png, .tif or .jpg (numbers: "
              ".npy, .nrrd or .mha)");
    EXPECT_EQ(check("out", {}),
              "usage: out: got extension \"\"; expected .exr, .png, .tif or .jpg (numbers: .npy, "
              ".nrrd or .mha)");
    ImageFileOptions sixteen;
    sixteen.bits = 16;
    EXPECT_EQ(check("out.jpg", sixteen), "usage: `bits`: got 16; expected 8 in a .jpg");
    EXPECT_EQ(errorOf([&] {
                  checkImageFile("out.JPG", {8, 65501}, {});
              }),
              "usage: `image.size`: got 8x65501; expected sides of at most 65500 pixels in a .jpg");
    ImageFileOptions twelve;
    twelve.bits = 12;
    EXPECT_EQ(check("out.png", twelve), "usage: `bits`: got 12; expected 8 or 16");
    ImageFileOptions floats;
    floats.floatExr = true;
    EXPECT_EQ(check("out.png", floats), "usage: `floatExr`: got out.png; expected an .exr file");
    EXPECT_EQ(
        check("no_such_folder/out.png", {}),
        "output: no_such_folder/out.png: cannot be written: there is no folder no_such_folder");
}

TEST(WriteImage, RefusesAPictureWithoutPixels) {
    EXPECT_EQ(errorOf([] { writeImage("out.png", Image(), {}); }),
              "usage: out.png: got 0x0 pixels; expected at least 1x1");
}

TEST(CompositeOver, PutsAStraightColourBehind) {
    Image image({2, 1});
    image.rgba = {0.25f, 0.5f, 0, 0.5f, 0, 0, 0, 0};
    compositeOver(image, {1, 0.5f, 0.25f, 0.5f});
    EXPECT_EQ(image.rgba,
              (std::vector<float>{0.5f, 0.625f, 0.0625f, 0.75f, 0.5f, 0.25f, 0.125f, 0.5f}));
}

TEST(CompositeOver, ClearBackgroundChangesNothing) {
    Image image = randomImage({9, 9});
    const std::vector<float> before = image.rgba;
    compositeOver(image, {1, 1, 1, 0});
    EXPECT_EQ(image.rgba, before);
}

}  // namespace
}  // namespace deltasplat
