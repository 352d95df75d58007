// SPDX-License-Identifier: Apache-2.0
// Images that say what they are: stacks and hyperstacks of ImageJ and OME-XML, palettes, numbers of
// few bits, thumbnails.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <glm/geometric.hpp>

#include "unit/format_helpers.h"
#include "unit/tiff_helpers.h"

namespace deltasplat {
namespace {

using namespace deltasplat::testing;
using Lines = std::vector<std::string>;

constexpr int kPixels = 12;  // of a page of 4x3

// Pages of 16 bits, with rising numbers from page to page.
TiffPageBytes page16(int page, bool bigEndian = true) {
    TiffPageBytes result;
    result.bits = 16;
    result.pixels = bytesOf(ramp<std::uint16_t>(kPixels, kPixels * page), bigEndian);
    return result;
}

std::string planes16(int first, int last, bool bigEndian = true) {
    std::string bytes;
    for (int page = first; page < last; ++page) bytes += page16(page, bigEndian).pixels;
    return bytes;
}

// One directory, behind whose pixels those of the other planes lie.
void writeOneDirectory(const std::string& file, const std::string& description, int planes,
                       bool bigEndian = true) {
    TiffPageBytes page = page16(0, bigEndian);
    page.description = description;
    page.pixelsPerUnit[0] = page.pixelsPerUnit[1] = 100;
    writeBytes(file, tiffBytes({page}, bigEndian, planes16(1, planes, bigEndian)));
}

void writePages(const std::string& file, const std::string& description, int planes) {
    std::vector<TiffPageBytes> pages;
    for (int page = 0; page < planes; ++page) pages.push_back(page16(page));
    pages[0].description = description;
    writeBytes(file, tiffBytes(pages));
}

std::vector<double> valuesIn(const std::string& file, std::optional<std::int64_t> volume = {}) {
    ReadOptions options;
    options.volume = volume;
    return valuesOf(readVolume(file, options));
}

// Numbers of planes, one after the other.
std::vector<double> planesOf(const std::vector<int>& planes) {
    std::vector<double> values;
    for (const int plane : planes)
        for (int i = 0; i < kPixels; ++i) values.push_back(kPixels * plane + i);
    return values;
}

TEST(ImageJ, StackInOneDirectory) {
    const TempFolder folder;
    const std::string text = "ImageJ=1.53t\nimages=10\nslices=10\nunit=micron\nspacing=0.3\n";
    for (const bool bigEndian : {true, false}) {
        writeOneDirectory("a.tif", text, 10, bigEndian);
        Warnings warnings;
        const Volume volume = readVolume("a.tif", {}, warnings.listener());
        EXPECT_EQ(volume.box().dims(), glm::ivec3(4, 3, 10));
        EXPECT_EQ(volume.type(), "uint16");
        EXPECT_EQ(valuesOf(volume), ramp<double>(120));
        EXPECT_LT(glm::length(volume.voxelSize() - glm::dvec3(0.1, 0.1, 0.3)), 1e-12);
        EXPECT_EQ(volume.lengthUnit(), "um");
        EXPECT_TRUE(warnings.lines.empty());
    }
    writePages("b.tif", text, 10);
    EXPECT_EQ(valuesIn("b.tif"), ramp<double>(120));
}

TEST(ImageJ, SpacingAndUnits) {
    const TempFolder folder;
    const auto placeOf = [](const std::string& text, const ReadOptions& options = {}) {
        writeOneDirectory("a.tif", "ImageJ=1.53t\nimages=2\nslices=2\n" + text, 2);
        const Volume volume = readVolume("a.tif", options);
        const glm::dvec3 size = volume.voxelSize();
        return std::to_string(size.x) + " " + std::to_string(size.z) + " " + volume.lengthUnit();
    };
    EXPECT_EQ(placeOf("unit=\\u00B5m\nspacing=-2"), "0.100000 2.000000 um");
    EXPECT_EQ(placeOf("unit=cm\r\n"), "0.100000 1.000000 cm");
    EXPECT_EQ(placeOf("unit=pixel\nspacing=2"), "0.100000 2.000000 ");
    EXPECT_EQ(placeOf("spacing=2"), "0.100000 2.000000 ");
    // Units of axes that have their own become one.
    EXPECT_EQ(placeOf("unit=micron\nyunit=micron\nzunit=nm\nspacing=500"), "0.100000 0.500000 um");
    EXPECT_EQ(placeOf("unit=micron\nzunit=frog\nspacing=500"), "0.100000 500.000000 ");
    ReadOptions options;
    options.raw.spacing = {1, 1, 1};
    EXPECT_EQ(placeOf("unit=mm\nspacing=2", options), "1.000000 1.000000 ");
}

// Channels count fastest, then slices, then frames.
TEST(ImageJ, Hyperstack) {
    const TempFolder folder;
    const std::string text =
        "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\nframes=2\nhyperstack=true\n";
    writeOneDirectory("one.tif", text, 12);
    writePages("all.tif", text, 12);
    for (const std::string file : {"one.tif", "all.tif"}) {
        EXPECT_EQ(valuesIn(file, 0), planesOf({0, 2, 4}));
        EXPECT_EQ(valuesIn(file, 1), planesOf({1, 3, 5}));
        EXPECT_EQ(valuesIn(file, 2), planesOf({6, 8, 10}));
        EXPECT_EQ(valuesIn(file, 3), planesOf({7, 9, 11}));
        expectRefused(file +
                          ": got 4 volumes (2 channels, 2 times); expected one, chosen by "
                          "`volume` 0 to 3",
                      file);
    }
    ReadOptions fifth;
    fifth.volume = 4;
    expectRefused(
        "one.tif: got no volume 4 among 4 volumes (2 channels, 2 times); expected `volume` 0 to 3",
        "one.tif", fifth);
    writePages("no.tif", "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\n", 12);
    expectInputError("no.tif");
}

TEST(ImageJ, FramesOrChannelsAlone) {
    const TempFolder folder;
    for (const std::string name : {"channel", "frame"}) {
        writeOneDirectory("a.tif", "ImageJ=1.53t\nimages=3\n" + name + "s=3\n", 3);
        Warnings warnings;
        EXPECT_EQ(valuesOf(readVolume("a.tif", {}, warnings.listener())), ramp<double>(36));
        EXPECT_EQ(warnings.lines,
                  Lines{"a.tif: 3 " + (name == "frame" ? "time" : name) + "s are read as slices"});
    }
}

TEST(ImageJ, Calibration) {
    const TempFolder folder;
    const auto read = [](const std::string& text, Warnings& warnings) {
        writeOneDirectory("a.tif", "ImageJ=1.53t\nimages=2\nslices=2\n" + text, 2);
        return readVolume("a.tif", {}, warnings.listener());
    };
    Warnings none;
    // Numbers with a sign, as ImageJ keeps them.
    const Volume whole = read("cf=0\nc0=-32768\nc1=1\nvunit=gray value\n", none);
    EXPECT_EQ(whole.type(), "int16");
    EXPECT_EQ(valuesOf(whole), ramp<double>(24, -32768));
    EXPECT_EQ(valuesOf(read("c0=10\nc1=0.5\n", none)), ramp<double>(24, 10, 0.5));
    EXPECT_EQ(valuesOf(read("c0=0\nc1=1\nmin=3\nmax=7\n", none)), ramp<double>(24));
    EXPECT_EQ(valuesOf(read("cf=20\nc0=10\nc1=2\n", none)), ramp<double>(24));
    EXPECT_TRUE(none.lines.empty());
    Warnings curve;
    EXPECT_EQ(valuesOf(read("cf=4\nc0=10\nc1=2\n", curve)), ramp<double>(24));
    EXPECT_EQ(curve.lines, Lines{"a.tif: values are calibrated by no straight line (ImageJ's "
                                 "cf=4), and read as stored"});
}

TEST(ImageJ, ColoursAndFloats) {
    const TempFolder folder;
    TiffPageBytes page;
    page.samples = 3;
    page.photometric = 2;
    page.pixels = bytesOf(ramp<std::uint8_t>(3 * kPixels));
    page.description = "ImageJ=1.53t\nimages=2\nslices=2\n";
    writeBytes("a.tif", tiffBytes({page}, true, bytesOf(ramp<std::uint8_t>(3 * kPixels, 36))));
    const Volume volume = readVolume("a.tif");
    ASSERT_EQ(volume.box().dims(), glm::ivec3(4, 3, 2));
    // 0.2126 a + 0.7152 (a + 1) + 0.0722 (a + 2)
    EXPECT_EQ(valuesOf(volume), ramp<double>(24, 1, 3));
    TiffPageBytes real;
    real.bits = 32;
    real.more[339] = {3};
    real.pixels = bytesOf(ramp<float>(kPixels, 0.5), true);
    real.description = "ImageJ=1.53t\nimages=2\nslices=2\n";
    writeBytes("b.tif", tiffBytes({real}, true, bytesOf(ramp<float>(kPixels, 12.5), true)));
    EXPECT_EQ(valuesOf(readVolume("b.tif")), ramp<double>(24, 0.5));
}

TEST(ImageJ, FilesThatHoldOtherNumbersOfPages) {
    const TempFolder folder;
    const std::string text = "ImageJ=1.53t\nimages=10\nslices=10\n";
    writeOneDirectory("a.tif", text, 7);
    expectRefused("a.tif: got 7 pages; expected 10 images, as ImageJ says", "a.tif");
    // Who takes pages out of a file keeps what the first one says.
    for (const int pages : {1, 4}) {
        writePages("b.tif", text, pages);
        Warnings warnings;
        EXPECT_EQ(valuesOf(readVolume("b.tif", {}, warnings.listener())),
                  ramp<double>(std::size_t(kPixels * pages)));
        EXPECT_EQ(warnings.lines,
                  Lines{"b.tif: has " + std::to_string(pages) + (pages == 1 ? " page" : " pages") +
                        " and not 10 images, as ImageJ says"});
    }
    writePages("c.tif", "ImageJ=1.53t\nimages=12\nchannels=2\nslices=6\n", 4);
    expectRefused("c.tif: got 4 pages; expected 12 images, as ImageJ says", "c.tif");
    for (const std::string bad : {"0", "-1", "x", "99999999999"}) {
        writePages("d.tif", "ImageJ=1.53t\nimages=" + bad + "\n", 1);
        expectInputError("d.tif");
    }
    writeOneDirectory("s.1.tif", text, 10);
    writeOneDirectory("s.2.tif", text, 10);
    expectRefused("s.1.tif: got 10 pages; expected one in each file of a stack", "s.#.tif");
}

// Files of more than 4 GB have no place for directories of all pages. This one is mostly holes.
TEST(ImageJ, PlanesBeyondFourGigabytes) {
    const TempFolder folder;
    constexpr int kSide = 1024, kFrames = 2200;
    constexpr std::int64_t kPlane = std::int64_t{kSide} * kSide;
    TiffPageBytes page;
    page.width = page.height = kSide;
    page.pixels = std::string(std::size_t(kPlane), '\0');
    page.description = "ImageJ=1.53t\nimages=4400\nslices=2\nframes=2200\n";
    constexpr std::int64_t kFirst = 1000;
    writeBytes("a.tif", tiffBytes({page}, true, "", kFirst));
    const int file = ::open("a.tif", O_WRONLY);
    ASSERT_GE(file, 0);
    const std::int64_t last = kFirst + kPlane * (2 * kFrames - 1);
    ASSERT_EQ(::ftruncate(file, last + kPlane), 0);
    const unsigned char values[2]{7, 9};
    ASSERT_EQ(::pwrite(file, &values[0], 1, last - kPlane + 5), 1);
    ASSERT_EQ(::pwrite(file, &values[1], 1, last + 3), 1);
    ::close(file);
    ReadOptions options;
    options.volume = kFrames - 1;
    const Volume volume = readVolume("a.tif", options);
    EXPECT_EQ(volume.box().dims(), glm::ivec3(kSide, kSide, 2));
    EXPECT_EQ(valueAt(volume, 5, 0, 0), 7);
    EXPECT_EQ(valueAt(volume, 3, 0, 1), 9);
    EXPECT_EQ(valueAt(volume, 0, 0, 0), 0);
}

std::string ome(const std::string& pixels, const std::string& inside = "") {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><!-- <Pixels SizeZ=\"9\"/> -->\n"
           "<OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image ID=\"Image:0\" "
           "Name='a &lt; b'><Pixels ID=\"Pixels:0\" Type=\"uint16\" SizeX=\"4\" SizeY=\"3\" " +
           pixels + ">" + inside + "</Pixels></Image></OME>";
}

TEST(Ome, ChannelsAndTimes) {
    const TempFolder folder;
    const std::string sizes = " SizeZ=\"3\" SizeC=\"2\" SizeT=\"2\"";
    // Which plane a slice is, of channel c and time t.
    const std::map<std::string, std::array<int, 3>> steps{
        {"XYZCT", {1, 3, 6}}, {"XYZTC", {1, 6, 3}}, {"XYCZT", {2, 1, 6}},
        {"XYCTZ", {4, 1, 2}}, {"XYTZC", {2, 6, 1}}, {"XYTCZ", {4, 2, 1}}};
    for (const auto& [order, step] : steps) {
        for (const std::string inside :
             {"", "<TiffData/>", "<TiffData IFD=\"0\" PlaneCount=\"12\"/>"}) {
            writePages("a.ome.tif", ome("DimensionOrder=\"" + order + "\"" + sizes, inside), 12);
            for (int c = 0; c < 2; ++c) {
                for (int t = 0; t < 2; ++t) {
                    const int first = c * step[1] + t * step[2];
                    EXPECT_EQ(valuesIn("a.ome.tif", c + 2 * t),
                              planesOf({first, first + step[0], first + 2 * step[0]}))
                        << order << inside;
                }
            }
            expectRefused(
                "a.ome.tif: got 4 volumes (2 channels, 2 times); expected one, chosen by `volume` "
                "0 to 3",
                "a.ome.tif");
        }
    }
}

TEST(Ome, PlanesInAnotherOrder) {
    const TempFolder folder;
    std::string inside;
    for (int z = 0; z < 3; ++z)
        inside += "<TiffData FirstZ='" + std::to_string(z) + "' IFD='" + std::to_string(2 - z) +
                  "'><UUID FileName=\"before.ome.tif\">urn:uuid:1</UUID></TiffData>";
    writePages("a.tif", ome("DimensionOrder='XYZCT' SizeZ='3' SizeC='1' SizeT='1'", inside), 3);
    EXPECT_EQ(valuesIn("a.tif"), planesOf({2, 1, 0}));
    // What is in another file, or nowhere, is not made up.
    const std::string other =
        inside.substr(0, inside.find("<TiffData FirstZ='2'")) +
        "<TiffData FirstZ='2' IFD='2'><UUID FileName='b.tif'>urn:uuid:2</UUID></TiffData>";
    writePages("before.ome.tif", ome("SizeZ='3' SizeC='1' SizeT='1'", other), 3);
    expectRefused(
        "before.ome.tif: got slice 2 in another file, b.tif; expected all slices of a volume in "
        "one file, as OME-XML describes it",
        "before.ome.tif");
    writePages("c.tif", ome("SizeZ='4' SizeC='1' SizeT='1'"), 3);
    expectRefused(
        "c.tif: got slice 3 of no page (there are 3); expected all slices of a volume in one file, "
        "as OME-XML describes it",
        "c.tif");
    for (const std::string bad : {"0", "-3", "x", "99999999999999999999"}) {
        writePages("d.tif", ome("SizeZ='" + bad + "' SizeC='1' SizeT='1'"), 3);
        expectInputError("d.tif");
    }
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

TEST(Ome, TheLastBlockThatNamesAPlaneHolds) {
    const TempFolder folder;
    const std::string sizes = "DimensionOrder='XYCZT' SizeZ='3' SizeC='2' SizeT='1'";
    writePages("a.tif",
               ome(sizes,
                   "<TiffData IFD='3' FirstZ='1' FirstC='1'/><TiffData PlaneCount='5'/>"
                   "<TiffData IFD='5' FirstC='1'/>"
                   "<TiffData IFD='4' PlaneCount='9' FirstZ='2'/><TiffData FirstZ='3'/>"),
               6);
    EXPECT_EQ(valuesIn("a.tif", 0), planesOf({0, 2, 4}));
    EXPECT_EQ(valuesIn("a.tif", 1), planesOf({5, 3, 5}));
}

// Work and memory go by the length of the text and the number of planes; their product would be
// 10^11 here, and the square of the length 10^13.
TEST(Ome, TextsThatRepeatThemselves) {
    const TempFolder folder;
    const std::string many = "SizeZ='4000000' SizeC='1' SizeT='1'";
    writePages("a.tif", ome(many, repeated("<TiffData/>", 30000)), 3);
    expectRefused(
        "a.tif: got slice 3 of no page (there are 3); expected all slices of a volume in one file, "
        "as OME-XML describes it",
        "a.tif");
    writePages("b.tif", ome("SizeZ='3'", repeated("</Pixels><Pixels " + many + ">", 30000)), 3);
    expectRefused("b.tif: got 8000003 planes; expected at most 4194304", "b.tif");
    writePages("c.tif",
               ome("SizeZ='3'", "<Channel Name='" + repeated("&", 3000000) + "' " + "/>" +
                                    repeated("<TiffData/>", 30000)),
               3);
    EXPECT_EQ(valuesIn("c.tif"), planesOf({0, 1, 2}));
}

TEST(Ome, SizesOfVoxels) {
    const TempFolder folder;
    const auto placeOf = [](const std::string& sizes, Warnings& warnings) {
        writePages("a.tif", ome("SizeZ='3' SizeC='1' SizeT='1' " + sizes), 3);
        const Volume volume = readVolume("a.tif", {}, warnings.listener());
        const glm::dvec3 size = volume.voxelSize();
        return std::to_string(size.x) + " " + std::to_string(size.y) + " " +
               std::to_string(size.z) + " " + volume.lengthUnit();
    };
    Warnings none;
    EXPECT_EQ(placeOf("PhysicalSizeX='0.2' PhysicalSizeY='0.3' PhysicalSizeZ='1.5'", none),
              "0.200000 0.300000 1.500000 um");
    EXPECT_EQ(placeOf("PhysicalSizeX='200' PhysicalSizeXUnit='nm' PhysicalSizeY='200' "
                      "PhysicalSizeYUnit='nm' PhysicalSizeZ='1.5' PhysicalSizeZUnit='&#181;m'",
                      none),
              "200.000000 200.000000 1500.000000 nm");
    EXPECT_EQ(placeOf("", none), "1.000000 1.000000 1.000000 ");
    EXPECT_TRUE(none.lines.empty());
    Warnings flat;
    EXPECT_EQ(placeOf("PhysicalSizeX='2' PhysicalSizeXUnit='mm'", flat),
              "2.000000 2.000000 2.000000 mm");
    EXPECT_EQ(flat.lines, Lines{"a.tif: does not say how far slices are apart (PhysicalSizeZ), and "
                                "is read as if it were as far as pixels"});
}

TEST(Ome, ColoursShareAPlane) {
    const TempFolder folder;
    TiffPageBytes page;
    page.samples = 3;
    page.photometric = 2;
    page.pixels = bytesOf(ramp<std::uint8_t>(3 * kPixels));
    page.description = ome("SizeZ='1' SizeC='3' SizeT='1'", "<Channel SamplesPerPixel='3'/>");
    writeBytes("a.tif", tiffBytes({page}));
    EXPECT_EQ(valuesOf(readVolume("a.tif")), ramp<double>(12, 1, 3));
}

TEST(Tiff, WhatOtherProgramsSay) {
    const TempFolder folder;
    writePages("a.tif", "{\"shape\": [2, 3, 3, 4]}", 6);
    EXPECT_EQ(valuesIn("a.tif", 1), planesOf({3, 4, 5}));
    expectRefused("a.tif: got 2 volumes (axes 2); expected one, chosen by `volume` 0 to 1",
                  "a.tif");
    for (const char* const shape : {"3, 3, 4, 1", "3, 1, 3, 4", "1, 3, 1, 3, 4", "3, 3, 4"}) {
        writePages("a.tif", "{\"shape\": [" + std::string(shape) + "]}", 3);
        EXPECT_EQ(valuesIn("a.tif"), planesOf({0, 1, 2})) << shape;
    }
    writeOneDirectory("b.tif", "{\"shape\": [5, 3, 4], \"truncated\": true}", 5);
    EXPECT_EQ(valuesIn("b.tif"), ramp<double>(60));
    TiffPageBytes metaMorph = page16(0);
    metaMorph.more[33629] = {0, 0, 0, 0};
    writeBytes("c.tif", tiffBytes({metaMorph}, true, planes16(1, 4)));
    EXPECT_EQ(valuesIn("c.tif"), ramp<double>(48));
}

// OpenImageIO would read the first of its slices.
TEST(Tiff, PagesOfSeveralSlices) {
    const TempFolder folder;
    TiffPageBytes page = page16(0);
    page.more[32997] = {3};
    writeBytes("a.tif", tiffBytes({page}, true, planes16(1, 3)));
    expectRefused("a.tif: got page 1 of 3 slices (ImageDepth); expected a page for each slice",
                  "a.tif");
    page.more[32997] = {1};
    writeBytes("b.tif", tiffBytes({page}));
    EXPECT_EQ(valuesIn("b.tif"), ramp<double>(12));
}

TEST(Tiff, ThumbnailsAreLeftOut) {
    const TempFolder folder;
    TiffPageBytes small = page16(9);
    small.kind = 1;
    small.width = 2;
    small.height = 1;
    writeBytes("a.tif", tiffBytes({page16(0), small, page16(1), small}));
    Warnings warnings;
    EXPECT_EQ(valuesOf(readVolume("a.tif", {}, warnings.listener())), ramp<double>(24));
    EXPECT_EQ(warnings.lines,
              Lines{"a.tif: 2 of 4 pages are thumbnails, smaller copies or masks, and left out"});
    writeBytes("s.1.tif", tiffBytes({page16(0), small}));
    writeBytes("s.2.tif", tiffBytes({small, page16(1)}));
    EXPECT_EQ(valuesIn("s.#.tif"), ramp<double>(24));
    // A picture that is small itself is one.
    writeBytes("b.tif", tiffBytes({small}));
    EXPECT_EQ(readVolume("b.tif").box().dims(), glm::ivec3(2, 1, 1));
}

// Packs numbers of few bits, rows ending with whole bytes.
std::string packed(const std::vector<int>& numbers, int bits, int width) {
    std::string bytes;
    for (std::size_t row = 0; row < numbers.size(); row += std::size_t(width)) {
        std::string line(std::size_t((width * bits + 7) / 8), '\0');
        for (int i = 0; i < width * bits; ++i) {
            const int number = numbers[row + std::size_t(i / bits)];
            if (number >> (bits - 1 - i % bits) & 1)
                line[std::size_t(i / 8)] = char(line[std::size_t(i / 8)] | 0x80 >> (i % 8));
        }
        bytes += line;
    }
    return bytes;
}

std::string pngChunk(const std::string& name, const std::string& data) {
    const std::string all = name + data;
    const auto sum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(all.data()), uInt(all.size())));
    return bytesOf<std::uint32_t>({std::uint32_t(data.size())}, true) + all +
           bytesOf<std::uint32_t>({sum}, true);
}

std::string pngBytes(const std::vector<int>& numbers, int bits, int width, char color,
                     const std::string& chunks = "") {
    const std::string rows = packed(numbers, bits, width);
    const std::size_t rowBytes = std::size_t((width * bits + 7) / 8);
    std::string raw;
    for (std::size_t at = 0; at < rows.size(); at += rowBytes)
        raw += std::string(1, '\0') + rows.substr(at, rowBytes);
    std::string data(compressBound(uLong(raw.size())), '\0');
    uLongf size = uLongf(data.size());
    compress(reinterpret_cast<Bytef*>(data.data()), &size,
             reinterpret_cast<const Bytef*>(raw.data()), uLong(raw.size()));
    data.resize(size);
    const std::string header =
        bytesOf<std::uint32_t>(
            {std::uint32_t(width), std::uint32_t(numbers.size()) / std::uint32_t(width)}, true) +
        std::string({char(bits), color, 0, 0, 0});
    return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", header) + chunks + pngChunk("IDAT", data) +
           pngChunk("IEND", "");
}

std::vector<int> allNumbers(int bits, int width) {
    std::vector<int> numbers;
    for (int i = 0; i < 1 << bits; ++i) numbers.push_back(i);
    while (numbers.size() % std::size_t(width) != 0) numbers.push_back(0);
    return numbers;
}

// What is stored counts, as it does of 8 and 16 bits.
TEST(FewBits, ArePlainNumbers) {
    const TempFolder folder;
    for (const int bits : {1, 2, 4}) {
        const std::vector<int> numbers = allNumbers(bits, 5);
        writeBytes("a.png", pngBytes(numbers, bits, 5, 0));
        Warnings warnings;
        EXPECT_EQ(valuesOf(readVolume("a.png", {}, warnings.listener())),
                  std::vector<double>(numbers.begin(), numbers.end()))
            << bits;
        EXPECT_TRUE(warnings.lines.empty());
    }
    for (const int bits : {1, 2, 4, 6, 10, 12, 14}) {
        for (const int photometric : {0, 1}) {
            const std::vector<int> numbers = allNumbers(bits, 5);
            TiffPageBytes page;
            page.width = 5;
            page.height = int(numbers.size()) / 5;
            page.bits = bits;
            page.photometric = photometric;
            page.pixels = packed(numbers, bits, 5);
            writeBytes("a.tif", tiffBytes({page}));
            EXPECT_EQ(valuesIn("a.tif"), std::vector<double>(numbers.begin(), numbers.end()))
                << bits << " " << photometric;
        }
    }
}

// Colours of a palette, all of one brightness.
std::string pngPalette(int colors) {
    std::string bytes;
    for (int i = 0; i < colors; ++i) bytes += std::string(3, char(100));
    return bytes;
}

const std::string kPaletteRemark =
    ": colours of a palette are read as their luminance; `paletteNumbers=true` reads its numbers";

TEST(Palettes, ColoursOrNumbers) {
    const TempFolder folder;
    ReadOptions asNumbers;
    asNumbers.paletteNumbers = true;
    const auto expectBoth = [&](const std::string& file, const std::vector<int>& numbers) {
        Warnings warnings;
        const Volume colors = readVolume(file, {}, warnings.listener());
        EXPECT_EQ(warnings.lines, Lines{file + kPaletteRemark});
        EXPECT_EQ(colors.valueMin(), 100);
        EXPECT_EQ(colors.valueMax(), 100);
        Warnings none;
        EXPECT_EQ(valuesOf(readVolume(file, asNumbers, none.listener())),
                  std::vector<double>(numbers.begin(), numbers.end()))
            << file;
        EXPECT_TRUE(none.lines.empty());
    };
    for (const int bits : {1, 2, 4, 8}) {
        const std::vector<int> numbers = allNumbers(bits, 4);
        const std::string colors = pngChunk("PLTE", pngPalette(1 << bits));
        writeBytes("a.png", pngBytes(numbers, bits, 4, 3, colors));
        expectBoth("a.png", numbers);
        for (const std::size_t clear : {1, 2})
            writeBytes("b.png", pngBytes(numbers, bits, 4, 3,
                                         colors + pngChunk("tRNS", std::string(clear, '\0'))));
        expectBoth("b.png", numbers);
        TiffPageBytes page;
        page.height = int(numbers.size()) / 4;
        page.bits = bits;
        page.photometric = 3;
        page.palette.assign(std::size_t(3 << bits), 100 * 257);
        page.pixels = packed(numbers, bits, 4);
        for (const bool bigEndian : {true, false}) {
            writeBytes("a.tif", tiffBytes({page}, bigEndian));
            expectBoth("a.tif", numbers);
        }
    }
    // A .bmp has a table of colours even for greys.
    std::string bmp = "BM" + bytesOf<std::uint32_t>({0, 0, 54 + 4 * 4, 40}) +
                      bytesOf<std::int32_t>({4, 2}) + bytesOf<std::uint16_t>({1, 8}) +
                      bytesOf<std::uint32_t>({0, 8, 0, 0, 4, 0}) + std::string("\0\0\x9\0", 4);
    for (int i = 1; i < 4; ++i) bmp += std::string("\x80\x10\x20\0", 4);
    writeBytes("a.bmp", bmp + std::string("\3\2\1\0\0\1\2\3", 8));
    EXPECT_EQ(valuesOf(readVolume("a.bmp", asNumbers)),
              (std::vector<double>{0, 1, 2, 3, 3, 2, 1, 0}));
    Warnings ofBmp;
    readVolume("a.bmp", {}, ofBmp.listener());
    EXPECT_EQ(ofBmp.lines, Lines{"a.bmp" + kPaletteRemark});
    // Numbers of 32 colours are numbers of 8 bits.
    writeBytes("c.1.png", pngBytes({0, 1, 31, 30}, 8, 4, 3, pngChunk("PLTE", pngPalette(32))));
    writeBytes("c.2.png", pngBytes({2, 3, 4, 5}, 8, 4, 3, pngChunk("PLTE", pngPalette(6))));
    EXPECT_EQ(valuesOf(readVolume("c.#.png", asNumbers)),
              (std::vector<double>{0, 1, 31, 30, 2, 3, 4, 5}));
    writeBytes("c.3.png", pngBytes({2, 3, 4, 5}, 8, 4, 0));
    expectRefused("c.3.png: got no palette; expected one as in the first slice, or none", "c.#.png",
                  asNumbers);
}

// Of ImageJ's images a palette is how their values are shown.
TEST(Palettes, OfImageJ) {
    const TempFolder folder;
    TiffPageBytes page;
    page.photometric = 3;
    page.palette.assign(std::size_t(3 * 256), 257);
    page.pixels = bytesOf(ramp<std::uint8_t>(kPixels));
    page.description = "ImageJ=1.53t\nimages=2\nslices=2\n";
    writeBytes("a.tif", tiffBytes({page}, true, bytesOf(ramp<std::uint8_t>(kPixels, 12))));
    Warnings warnings;
    EXPECT_EQ(valuesOf(readVolume("a.tif", {}, warnings.listener())), ramp<double>(24));
    EXPECT_EQ(warnings.lines,
              Lines{"a.tif: its palette is how ImageJ shows values, which are read as stored"});
}

}  // namespace
}  // namespace deltasplat
