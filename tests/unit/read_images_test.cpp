// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "unit/format_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

template <typename T>
TypeDesc typeOf() {
    return OIIO::BaseTypeFromC<T>::value;
}

template <typename T>
void writeImage(const std::string& file, const ImageSpec& spec, const std::vector<T>& values) {
    auto out = ImageOutput::create(file);
    ASSERT_TRUE(out && out->open(file, spec)) << OIIO::geterror();
    ASSERT_TRUE(out->write_image(typeOf<T>(), values.data()));
    out->close();
}

// Pages of 4x3, with rising values.
template <typename T>
void writePages(const std::string& file, int pages, const std::string& compression = "none") {
    auto out = ImageOutput::create(file);
    ImageSpec spec(4, 3, 1, typeOf<T>());
    spec.attribute("compression", compression);
    const std::vector<ImageSpec> specs(std::size_t(pages), spec);
    ASSERT_TRUE(out->open(file, pages, specs.data())) << out->geterror();
    for (int page = 0; page < pages; ++page) {
        const bool ready = page == 0 || out->open(file, spec, ImageOutput::AppendSubimage);
        ASSERT_TRUE(ready) << out->geterror();
        const auto values = ramp<T>(12, 12 * page);
        ASSERT_TRUE(out->write_image(typeOf<T>(), values.data()));
    }
    out->close();
}

void writeStack(const std::vector<std::string>& files) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        writeImage(files[i], ImageSpec(4, 3, 1, TypeDesc::UINT8),
                   ramp<std::uint8_t>(12, 12 * double(i)));
    }
}

TEST(ReadImages, PagesOfATiff) {
    const TempFolder folder;
    for (const std::string compression : {"none", "lzw", "zip"}) {
        writePages<std::uint16_t>("a.tif", 11, compression);
        const Volume volume = readVolume("a.tif");
        EXPECT_EQ(volume.name(), "a");
        EXPECT_EQ(volume.type(), "uint16");
        EXPECT_EQ(volume.space(), "");
        EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 11));
        EXPECT_EQ(valuesOf(volume), ramp<double>(132));
        EXPECT_EQ(volume.worldFromIndex(), glm::dmat4(1));
    }
}

TEST(ReadImages, TypesOfTiff) {
    const TempFolder folder;
    writePages<std::uint8_t>("a.tiff", 2);
    EXPECT_EQ(readVolume("a.tiff").type(), "uint8");
    writePages<std::int16_t>("b.tiff", 2);
    EXPECT_EQ(readVolume("b.tiff").type(), "int16");
    writePages<float>("c.tiff", 2);
    EXPECT_EQ(readVolume("c.tiff").type(), "float32");
    EXPECT_EQ(valuesOf(readVolume("c.tiff")), ramp<double>(24));
    writePages<double>("d.tiff", 2);
    EXPECT_EQ(readVolume("d.tiff").type(), "float64");
}

// OpenImageIO would turn those of 8 bits round, and no others.
TEST(ReadImages, ZeroIsWhite) {
    const TempFolder folder;
    const auto readTurned = [](std::string bytes) {
        // The entry of the photometric interpretation: 262, short, one, 1.
        const std::string entry("\x06\x01\x03\x00\x01\x00\x00\x00\x01\x00", 10);
        const std::size_t place = bytes.find(entry);
        EXPECT_NE(place, std::string::npos);
        bytes[place + 8] = 0;
        writeBytes("b.tif", bytes);
        Warnings warnings;
        const Volume volume = readVolume("b.tif", {}, warnings.listener());
        EXPECT_EQ(warnings.lines,
                  std::vector<std::string>{"b.tif: 0 is white in it; values are read as stored"});
        return valuesOf(volume);
    };
    for (const int tile : {0, 16}) {
        ImageSpec spec(4, 3, 1, TypeDesc::UINT8);
        spec.attribute("compression", "none");
        spec.tile_width = spec.tile_height = tile;
        writeImage("a.tif", spec, ramp<std::uint8_t>(12));
        EXPECT_EQ(readTurned(testing::readBytes("a.tif")), ramp<double>(12)) << tile;
        spec.format = TypeDesc::UINT16;
        writeImage("a.tif", spec, ramp<std::uint16_t>(12));
        EXPECT_EQ(readTurned(testing::readBytes("a.tif")), ramp<double>(12)) << tile;
    }
}

// OpenImageIO would read zeros.
TEST(ReadImages, DoublesInTilesOrOneRow) {
    const TempFolder folder;
    ImageSpec row(4, 1, 1, TypeDesc::DOUBLE);
    writeImage("row.tif", row, ramp<double>(4));
    ImageSpec tiles(16, 16, 1, TypeDesc::DOUBLE);
    tiles.tile_width = tiles.tile_height = 16;
    writeImage("tiles.tif", tiles, ramp<double>(256));
    for (const std::string file : {"row.tif", "tiles.tif"}) {
        expectError(ErrorCode::kInput,
                    file +
                        ": got 64-bit numbers in tiles or one row, which OpenImageIO cannot "
                        "read; expected float32, or strips of an image of more rows",
                    [&] { readVolume(file); });
    }
    writeImage("strips.tif", ImageSpec(4, 2, 1, TypeDesc::DOUBLE), ramp<double>(8));
    EXPECT_EQ(valuesOf(readVolume("strips.tif")), ramp<double>(8));
}

// Tiles that are smaller than the image, go over its edges, or both; of several channels the first.
TEST(ReadImages, Tiles) {
    const TempFolder folder;
    for (const glm::ivec2& size : {glm::ivec2(4, 3), glm::ivec2(16, 32), glm::ivec2(37, 18)}) {
        for (const int channels : {1, 2}) {
            ImageSpec spec(size.x, size.y, channels, TypeDesc::UINT16);
            spec.tile_width = spec.tile_height = 16;
            const auto pixels = std::size_t(size.x * size.y);
            std::vector<std::uint16_t> values;
            for (std::size_t i = 0; i < pixels; ++i)
                for (int channel = 0; channel < channels; ++channel)
                    values.push_back(std::uint16_t(channel == 0 ? i : 60000));
            writeImage("t.tif", spec, values);
            EXPECT_EQ(valuesOf(readVolume("t.tif")), ramp<double>(pixels)) << size.x;
        }
    }
}

TEST(ReadImages, StackByPattern) {
    const TempFolder folder;
    std::filesystem::create_directory("s");
    writeStack({"s/slice.0008.png", "s/slice.0009.png", "s/slice.0010.png"});
    writeStack({"s/other.0001.png", "s/slice.10.png", "s/slice.001x.png"});
    for (const std::string name : {"s/slice.####.png", "s/slice.%04d.png", "./s/slice.####.png"}) {
        const Volume volume = readVolume(name);
        EXPECT_EQ(volume.name(), "slice");
        EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 3));
        EXPECT_EQ(valuesOf(volume), ramp<double>(36));
    }
    EXPECT_EQ(readVolume("s/slice.##.png").box().dims(), glm::ivec3(4, 3, 1));
}

TEST(ReadImages, StackOfNumbersWithoutZeros) {
    const TempFolder folder;
    writeStack({"a9.png", "a10.png", "a11.png"});
    for (const std::string name : {"a#.png", "a%d.png"}) {
        EXPECT_EQ(valuesOf(readVolume(name)), ramp<double>(36));
    }
}

// Behind a backslash a sign is part of the name, and a file that is there is no stack.
TEST(ReadImages, SignsThatAreNoNumbers) {
    const TempFolder folder;
    writeStack({"a#.1.png", "a#.2.png", "b%d#c1.png", "b%d#c2.png", "c#.png", "c1.png", "c2.png"});
    EXPECT_EQ(valuesOf(readVolume("a\\#.#.png")), ramp<double>(24));
    EXPECT_EQ(readVolume("b\\%d\\#c%d.png").box().dims(), glm::ivec3(4, 3, 2));
    EXPECT_EQ(readVolume("c#.png").box().dims(), glm::ivec3(4, 3, 1));
}

TEST(ReadImages, EverySecondNumber) {
    const TempFolder folder;
    writeStack({"a.02.png", "a.04.png", "a.06.png"});
    EXPECT_EQ(valuesOf(readVolume("a.##.png")), ramp<double>(36));
}

TEST(ReadImages, OneFileIsOnePicture) {
    const TempFolder folder;
    writeStack({"a.0001.png", "a.0002.png"});
    EXPECT_EQ(readVolume("a.0001.png").box().dims(), glm::ivec3(4, 3, 1));
}

TEST(ReadImages, Folder) {
    const TempFolder folder;
    std::filesystem::create_directory("stack");
    writeStack({"stack/z9.png", "stack/z10.png", "stack/z11.png"});
    writeBytes("stack/notes.txt", "text");
    Warnings warnings;
    const Volume volume = readVolume("stack", {}, warnings.listener());
    EXPECT_EQ(volume.name(), "stack");
    EXPECT_EQ(valuesOf(volume), ramp<double>(36));
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{"stack: 1 file that is no image is passed over, notes.txt"});
}

TEST(ReadImages, SpacingAndOrigin) {
    const TempFolder folder;
    writeStack({"a.1.png", "a.2.png"});
    ReadOptions options;
    options.raw.spacing = {2, 3, 4};
    options.raw.origin = {10, 20, 30};
    EXPECT_EQ(readVolume("a.#.png", options).worldFromIndex(),
              glm::dmat4(2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1));
    options.raw.spacing->y = 0;
    expectError(ErrorCode::kUsage, "`spacing`: got 0; expected three numbers from 1e-15 to 1e+15",
                [&] { readVolume("a.#.png", options); });
}

TEST(ReadImages, ColoursBecomeLuminance) {
    const TempFolder folder;
    std::vector<std::uint16_t> colors;
    for (int i = 0; i < 12; ++i) {
        colors.insert(colors.end(),
                      {std::uint16_t(1000 * i), std::uint16_t(500), std::uint16_t(7)});
    }
    writeImage("a.1.png", ImageSpec(4, 3, 3, TypeDesc::UINT16), colors);
    for (auto& color : colors) color = 30000;
    writeImage("a.2.png", ImageSpec(4, 3, 3, TypeDesc::UINT16), colors);
    Warnings warnings;
    const Volume volume = readVolume("a.#.png", {}, warnings.listener());
    EXPECT_EQ(volume.type(), "uint16");
    for (int i = 0; i < 12; ++i) {
        const double sum = 0.2126 * 1000 * i + 0.7152 * 500 + 0.0722 * 7;
        EXPECT_NEAR(valueAt(volume, i % 4, i / 4, 0), sum, 0.5);
        EXPECT_EQ(valueAt(volume, i % 4, i / 4, 1), 30000);
    }
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{"a.1.png: colours are read as their luminance"});
}

TEST(ReadImages, AlphaIsLeftOut) {
    const TempFolder folder;
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 12; ++i) {
        pixels.insert(pixels.end(), {std::uint8_t(i * 20), std::uint8_t(i)});
    }
    ImageSpec spec(4, 3, 2, TypeDesc::UINT8);
    spec.channelnames = {"Y", "A"};
    spec.alpha_channel = 1;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    writeImage("a.png", spec, pixels);
    Warnings warnings;
    EXPECT_EQ(valuesOf(readVolume("a.png", {}, warnings.listener())), ramp<double>(12, 0, 20));
    EXPECT_EQ(warnings.lines,
              std::vector<std::string>{"a.png: only the first of 2 channels is read"});
}

TEST(ReadImages, SingleBits) {
    const TempFolder folder;
    ImageSpec spec(8, 2, 1, TypeDesc::UINT8);
    spec.attribute("oiio:BitsPerSample", 1);
    std::vector<std::uint8_t> pixels(16, 0);
    pixels[3] = 255;
    writeImage("a.tif", spec, pixels);
    Warnings warnings;
    EXPECT_EQ(valueAt(readVolume("a.tif", {}, warnings.listener()), 3, 0, 0), 1);
    EXPECT_TRUE(warnings.lines.empty());
}

// The last slices of a scan are often empty, and pack well.
TEST(ReadImages, SlicesThatPackWell) {
    const TempFolder folder;
    const std::vector<std::uint8_t> black(512 * 512);
    for (const std::string file : {"a.png", "a.jpg", "a.bmp", "a.tif", "a.pgm"}) {
        SCOPED_TRACE(file);
        ImageSpec spec(512, 512, 1, TypeDesc::UINT8);
        if (file == "a.tif") spec.attribute("compression", "zip");
        writeImage(file, spec, black);
        const Volume volume = readVolume(file);
        EXPECT_EQ(volume.box().dims(), glm::ivec3(512, 512, 1));
        EXPECT_EQ(volume.valueMax(), 0);
    }
}

// Samples are what a file holds, whatever the largest may be.
TEST(ReadImages, SamplesOfPgmAreNotStretched) {
    const TempFolder folder;
    std::string all = "P5\n# a comment\n256 256\n65535\n";
    for (int n = 0; n < 65536; ++n) all += {char(n >> 8), char(n & 255)};
    writeBytes("all.pgm", all);
    Warnings warnings;
    const Volume whole = readVolume("all.pgm", {}, warnings.listener());
    int wrong = 0;
    for (int n = 0; n < 65536; ++n) wrong += valueAt(whole, n % 256, n / 256, 0) != n;
    EXPECT_EQ(wrong, 0);
    const auto expectSamples = [&](const std::string& bytes, std::vector<int> samples) {
        writeBytes("a.pgm", bytes);
        const Volume volume = readVolume("a.pgm", {}, warnings.listener());
        for (int n = 0; n < int(samples.size()); ++n)
            EXPECT_EQ(valueAt(volume, n, 0, 0), samples[std::size_t(n)]) << bytes.substr(0, 20);
    };
    expectSamples(std::string("P5 3 1 4095\n\x0f\xff\0\1\4\0", 18), {4095, 1, 1024});
    expectSamples("P2\n3 1\n4095\n4095 1\n# of twelve bits\n 3543", {4095, 1, 3543});
    expectSamples("P2 3 1 15 15 0 7", {15, 0, 7});
    expectSamples(std::string("P5 3 1 15\n\17\0\7", 13), {15, 0, 7});
    EXPECT_TRUE(warnings.lines.empty());
    const auto expectBad = [&](const std::string& bytes, const std::string& message) {
        writeBytes("a.pgm", bytes);
        expectRefused("a.pgm: got " + message, "a.pgm");
    };
    expectBad("P2 3 1 15 15 0", "a file that is cut short; expected a whole .pgm image");
    expectBad("P2 3 1 15 15 0 x",
              "a byte 120 where a number should be; expected a whole .pgm image");
    expectBad("P2 3 1 15 15 0 16", "a sample of 16; expected at most 15, as its header says");
    expectBad(std::string("P5 3 1 4095\n\x0f\xff\0\1\4", 17),
              "a file that is cut short; expected a whole .pgm image");
}

TEST(ReadImagesError, Stacks) {
    const TempFolder folder;
    expectRefused("a.####.png: got no file of that name; expected files such as a.0001.png",
                  "a.####.png");
    expectRefused("no/a.##.png: got no file of that name; expected files such as a.01.png",
                  "no/a.##.png");
    writeStack({"a.01.png", "a.02.png", "a.04.png"});
    expectRefused("a.##.png: got no file a.03.png; expected 3 or more numbers in a row",
                  "a.##.png");
    writeStack({"h.1.png", "h.3.png", "h.4.png"});
    expectRefused("h.#.png: got no file h.2.png; expected 3 or more numbers in a row", "h.#.png");
    writeImage("a.03.png", ImageSpec(3, 4, 1, TypeDesc::UINT8), ramp<std::uint8_t>(12));
    expectRefused(
        "a.03.png: got 3x4 uint8, channels: 1; expected 4x3 uint8, channels: 1, as in the first "
        "slice",
        "a.##.png");
    writeImage("a.03.png", ImageSpec(4, 3, 1, TypeDesc::UINT16), ramp<std::uint16_t>(12));
    expectRefused(
        "a.03.png: got 4x3 uint16, channels: 1; expected 4x3 uint8, channels: 1, as in the first "
        "slice",
        "a.##.png");
    writePages<std::uint8_t>("b.1.tif", 1);
    writePages<std::uint8_t>("b.2.tif", 2);
    expectRefused("b.2.tif: got 2 pages; expected one in each file of a stack", "b.#.tif");
}

TEST(ReadImagesError, Folders) {
    const TempFolder folder;
    std::filesystem::create_directory("empty");
    expectRefused(
        "empty: got a folder without DICOM files and images; expected a DICOM folder, a folder of "
        "images, or a file",
        "empty");
    std::filesystem::create_directory("mixed");
    writeStack({"mixed/1.png", "mixed/2.tif"});
    expectRefused(
        "mixed: got images of several kinds (.png, .tif); expected a folder with the images of one "
        "stack",
        "mixed");
}

void writeFolder(const std::vector<std::string>& names) {
    std::filesystem::remove_all("in");
    std::filesystem::create_directory("in");
    std::vector<std::string> files;
    for (const std::string& name : names) files.push_back("in/" + name + ".png");
    writeStack(files);
}

TEST(ReadImagesError, HolesInFolders) {
    const TempFolder folder;
    const auto refused = [](const std::string& message, const std::vector<std::string>& names) {
        writeFolder(names);
        expectRefused("in: got " + message, "in");
    };
    refused("no file s.0003.png; expected 4 or more numbers in a row",
            {"s.0001", "s.0002", "s.0004", "s.0005"});
    refused("no file s2.png; expected 3 or more numbers in a row", {"s1", "s3", "s4"});
    refused("no file 11.png; expected 3 or more numbers in a row", {"9", "10", "12"});
    refused("no file scan2_t70_s3.png; expected 3 or more numbers in a row",
            {"scan2_t70_s2", "scan2_t70_s1", "scan2_t70_s4"});
    refused("s01.png and s1.png, the same number twice; expected each number once",
            {"s01", "s1", "s02", "s03"});
    refused("no file b3.png; expected 3 or more numbers in a row", {"a1", "a2", "b1", "b2", "b4"});
}

// Numbers may begin and step as they like, and what is no counter is none.
TEST(ReadImages, FoldersOfOtherNames) {
    const TempFolder folder;
    for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
             {"s008", "s010", "s012"},
             {"s98", "s99", "s100"},
             {"front", "middle", "rear"},
             {"s1_z0.5", "s2_z1.75", "s3_z9"},
             {"v2_1", "v2_2", "v2_3"},
             {"s10000000000000000000000001", "s10000000000000000000000002",
              "s10000000000000000000000004"}}) {
        writeFolder(names);
        EXPECT_EQ(valuesOf(readVolume("in")), ramp<double>(36)) << names[0];
    }
}

// A slice that cannot be read is none that may be left out.
TEST(ReadImagesError, EntriesThatAreNoFiles) {
    const TempFolder folder;
    const auto refused = [](const std::string& name) {
        EXPECT_THROW(readVolume("in"), Error) << name;
        std::filesystem::remove("in/" + name);
        EXPECT_EQ(valuesOf(readVolume("in")), ramp<double>(36)) << name;
    };
    writeFolder({"s1", "s2", "s3"});
    std::filesystem::create_directory("in/more");
    std::filesystem::create_directory_symlink("more", "in/link");
    std::filesystem::create_symlink("nowhere", "in/.hidden");
    for (const char* const name : {"s4.png", "notes"}) {
        std::filesystem::create_symlink("nowhere.png", "in/" + std::string(name));
        refused(name);
        std::filesystem::create_symlink(name, "in/" + std::string(name));
        refused(name);
        ASSERT_EQ(mkfifo(("in/" + std::string(name)).c_str(), 0600), 0);
        refused(name);
    }
}

TEST(ReadImagesError, DamagedFiles) {
    const TempFolder folder;
    writeBytes("a.png", "no image");
    writeBytes("a.tif", "");
    writeBytes("b.tif", "no TIFF at all, but long enough to be one");
    writeImage("d.png", ImageSpec(40, 30, 1, TypeDesc::UINT8), ramp<std::uint8_t>(1200));
    const std::string png = readBytes("d.png");
    writeBytes("d.png", png.substr(0, png.size() / 2));
    for (const std::string file : {"a.png", "d.png"}) {
        expectInputError(file);
        try {
            readVolume(file);
        } catch (const Error& error) {
            const std::string text = error.what();
            EXPECT_EQ(text.rfind(file + ": got what OpenImageIO refuses (", 0), 0u) << text;
        }
    }
    expectRefused("a.tif: got no TIFF header; expected a TIFF file", "a.tif");
    expectRefused("b.tif: got no TIFF header; expected a TIFF file", "b.tif");
}

// Pages whose tables lie behind their pixels, as OpenImageIO writes them, lose whole pages.
TEST(ReadImagesError, TiffCutAnywhere) {
    const TempFolder folder;
    for (const std::string compression : {"none", "lzw", "zip"}) {
        writePages<std::uint16_t>("a.tif", 3, compression);
        const std::string whole = readBytes("a.tif");
        for (std::size_t size = 0; size < whole.size(); ++size) {
            writeBytes("b.tif", whole.substr(0, size));
            expectInputError("b.tif");
        }
    }
    writePages<std::uint8_t>("a.tif", 1);
    const std::string whole = readBytes("a.tif");
    writeBytes("b.tif", whole.substr(0, 100));
    expectRefused(
        "b.tif: got page 1 that goes on behind the 100 bytes of the file; expected a "
        "whole TIFF",
        "b.tif");
}

// One page of a TIFF of 4x3 bytes; `next` is where the next page's table is said to be.
std::string smallTiff(std::uint32_t next, std::uint32_t stripBytes = 12, bool big = false) {
    const auto number = [&](std::uint64_t value) {
        return big ? bytesOf<std::uint64_t>({value})
                   : bytesOf<std::uint32_t>({std::uint32_t(value)});
    };
    const std::vector<std::pair<int, std::uint32_t>> fields{
        {256, 4}, {257, 3},         {258, 8}, {259, 1}, {262, 1}, {273, big ? 272 : 134},
        {278, 3}, {279, stripBytes}};
    std::string file = big ? std::string("II\x2b\0\x08\0\0\0", 8) + number(16)
                           : std::string("II\x2a\0", 4) + number(8);
    file += big ? number(fields.size()) : bytesOf<std::uint16_t>({std::uint16_t(fields.size())});
    for (const auto& [tag, value] : fields) {
        file += bytesOf<std::uint16_t>({std::uint16_t(tag), 4}) + number(1) +
                bytesOf<std::uint32_t>({value}) + std::string(big ? 4 : 0, '\0');
    }
    file += number(next);
    file.resize(big ? 272 : 134);
    return file + bytesOf(ramp<std::uint8_t>(12));
}

TEST(ReadImages, TiffOfOwnMaking) {
    const TempFolder folder;
    writeBytes("a.tif", smallTiff(0));
    EXPECT_EQ(valuesOf(readVolume("a.tif")), ramp<double>(12));
    writeBytes("b.tif", smallTiff(0, 12, true));
    EXPECT_EQ(valuesOf(readVolume("b.tif")), ramp<double>(12));
}

TEST(ReadImagesError, TiffThatDoesNotHoldTogether) {
    const TempFolder folder;
    writeBytes("a.tif", smallTiff(8));
    expectRefused("a.tif: got pages that follow each other in a ring; expected a whole TIFF",
                  "a.tif");
    writeBytes("b.tif", smallTiff(0, 11));
    expectRefused("b.tif: got page 1 with a strip of 11 bytes; expected at least 12", "b.tif");
    writeBytes("c.tif", smallTiff(0, 13));
    expectRefused(
        "c.tif: got page 1 that goes on behind the 146 bytes of the file; expected a whole TIFF",
        "c.tif");
    writeBytes("d.tif", smallTiff(1000));
    expectRefused(
        "d.tif: got page 2 that goes on behind the 146 bytes of the file; expected a whole TIFF",
        "d.tif");
}

// OpenImageIO fills up with grey what a JPEG lacks, and says so only when asked.
TEST(ReadImagesError, CutJpeg) {
    const TempFolder folder;
    for (const int channels : {1, 3}) {
        writeImage("a.jpg", ImageSpec(40, 30, channels, TypeDesc::UINT8),
                   ramp<std::uint8_t>(std::size_t(1200 * channels)));
        const std::string whole = readBytes("a.jpg");
        EXPECT_NO_THROW(readVolume("a.jpg"));
        for (std::size_t size = 0; size < whole.size(); size += 7) {
            writeBytes("b.jpg", whole.substr(0, size));
            expectInputError("b.jpg");
        }
        writeBytes("c.jpg", whole.substr(0, whole.size() - 100) + "\xff\xd9");
        expectInputError("c.jpg");
    }
}

// The header of a PNG with its sizes changed, and its checksum.
// Only the reader of the format that the name says is asked.
TEST(ReadImagesError, FormatsUnderAnotherName) {
    const TempFolder folder;
    writeImage("a.png", ImageSpec(4, 3, 1, TypeDesc::UINT8), ramp<std::uint8_t>(12));
    std::filesystem::copy_file("a.png", "a.tif");
    EXPECT_NO_THROW(readVolume("a.png"));
    EXPECT_THROW(readVolume("a.tif"), Error);
}

TEST(ReadImagesError, SizesBeyondTheData) {
    const TempFolder folder;
    writeImage("a.png", ImageSpec(4, 3, 1, TypeDesc::UINT8), ramp<std::uint8_t>(12));
    std::string bytes = readBytes("a.png");
    for (const int place : {16, 20}) {
        bytes.replace(std::size_t(place), 4, bytesOf<std::uint32_t>({1 << 18}, true));
    }
    const auto sum = std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(&bytes[12]), 17));
    bytes.replace(29, 4, bytesOf<std::uint32_t>({sum}, true));
    writeBytes("a.png", bytes);
    try {
        readVolume("a.png");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput) << error.what();
    }
}

}  // namespace
}  // namespace deltasplat
