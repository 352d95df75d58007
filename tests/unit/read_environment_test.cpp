// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "deltasplat/error.h"
#include "deltasplat/optics/environment.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using test::errorOf;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void write(const fs::path& file, const ImageSpec& spec, const std::vector<float>& values) {
    const auto out = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(out && out->open(file.string(), spec)) << OIIO::geterror();
    ASSERT_TRUE(out->write_image(TypeDesc::FLOAT, values.data())) << out->geterror();
    ASSERT_TRUE(out->close());
}

// 0.25, 0.5, 0.75, ...
std::vector<float> ramp(std::size_t count) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = 0.25f * float(i + 1);
    return values;
}

struct Read {
    Environment environment;
    std::vector<std::string> warnings;
};

Read readWith(const fs::path& file) {
    Read result;
    Listener listener;
    listener.warning = [&](const std::string& line) { result.warnings.push_back(line); };
    result.environment = readEnvironment(file, listener);
    return result;
}

class ReadEnvironment : public ::testing::Test {
  protected:
    // Writes and reads a picture.
    Read readBack(const std::string& name, const ImageSpec& spec,
                  const std::vector<float>& values) const {
        write(folder_ / name, spec, values);
        return readWith(folder_ / name);
    }
    // Returns the error without the folder's name.
    std::string refusalOf(const std::string& name) const {
        std::string error = errorOf([&] { readEnvironment(folder_ / name); });
        const std::string folder = folder_.path().string() + "/";
        for (auto at = error.find(folder); at != error.npos; at = error.find(folder)) {
            error.erase(at, folder.size());
        }
        return error;
    }
    std::string refusalOf(const std::string& name, const ImageSpec& spec,
                          const std::vector<float>& values) const {
        write(folder_ / name, spec, values);
        return refusalOf(name);
    }

    test::TempFolder folder_;
};

TEST_F(ReadEnvironment, FloatsAreReadAsTheyAre) {
    const std::vector<float> values = ramp(24);
    for (const char* name : {"a.exr", "b.tif", "C.EXR", "d.hdr"}) {
        const TypeDesc type = name[0] == 'C' ? TypeDesc::HALF : TypeDesc::FLOAT;
        const Read read = readBack(name, ImageSpec(4, 2, 3, type), values);
        EXPECT_EQ(read.environment.sizePixels, glm::ivec2(4, 2));
        EXPECT_EQ(read.environment.worldFromEnvironment, glm::dmat3(1));
        EXPECT_TRUE(read.warnings.empty());
        ASSERT_EQ(read.environment.rgb.size(), 24u);
        // .hdr has eight bits for each colour, and one exponent.
        const float off = name[0] == 'd' ? 1 / 128.0f : 0;
        for (std::size_t i = 0; i < 24; ++i) {
            EXPECT_NEAR(read.environment.rgb[i], values[i], off * values[i / 3 * 3 + 2]) << name;
        }
    }
}

TEST_F(ReadEnvironment, TheUpperLeftPixelIsTheFirst) {
    std::vector<float> values(24);
    values[0] = 7;
    EXPECT_EQ(readBack("a.exr", ImageSpec(4, 2, 3, TypeDesc::FLOAT), values).environment.rgb,
              values);
}

TEST_F(ReadEnvironment, GreysAreColors) {
    for (const char* name : {"a.exr", "b.tif"}) {
        const Read read = readBack(name, ImageSpec(4, 2, 1, TypeDesc::FLOAT), ramp(8));
        ASSERT_EQ(read.environment.rgb.size(), 24u);
        for (std::size_t i = 0; i < 24; ++i) {
            EXPECT_EQ(read.environment.rgb[i], ramp(8)[i / 3]);
        }
    }
}

TEST_F(ReadEnvironment, AlphaIsIgnored) {
    ImageSpec spec(2, 1, 4, TypeDesc::FLOAT);
    EXPECT_EQ(readBack("a.exr", spec, {1, 2, 3, 0, 4, 5, 6, 0.5}).environment.rgb,
              (std::vector<float>{1, 2, 3, 4, 5, 6}));
    ImageSpec grey(2, 1, 2, TypeDesc::FLOAT);
    grey.channelnames = {"Y", "A"};
    grey.alpha_channel = 1;
    EXPECT_EQ(readBack("b.exr", grey, {1, 0, 4, 0.5}).environment.rgb,
              (std::vector<float>{1, 1, 1, 4, 4, 4}));
}

TEST_F(ReadEnvironment, WholeNumbersAreSrgbAndWarnedOf) {
    const std::vector<float> values{0, 0.2f, 0.4f, 0.6f, 0.8f, 1};
    for (const char* name : {"a.png", "b.tif"}) {
        const bool fine = name[0] == 'b';
        const ImageSpec spec(2, 1, 3, fine ? TypeDesc::UINT16 : TypeDesc::UINT8);
        const Read read = readBack(name, spec, values);
        ASSERT_EQ(read.environment.rgb.size(), 6u);
        for (std::size_t i = 0; i < 6; ++i) {
            const double v = values[i];
            const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
            EXPECT_NEAR(read.environment.rgb[i], linear, fine ? 2e-5 : 1e-6);
        }
        ASSERT_EQ(read.warnings.size(), 1u);
        EXPECT_EQ(read.warnings[0], (folder_ / name).string() +
                                        ": whole numbers are read as sRGB, which ends at 1: what "
                                        "is brighter, as the sun is, has lost its light");
    }
}

TEST_F(ReadEnvironment, JpegsAreRead) {
    const Read read = readBack("a.jpg", ImageSpec(16, 8, 3, TypeDesc::UINT8),
                               std::vector<float>(16 * 8 * 3, 0.5f));
    EXPECT_NEAR(read.environment.rgb[100], 0.214, 0.01);
}

TEST_F(ReadEnvironment, ValuesBelowZeroAreZeroAndWarnedOf) {
    const Read read =
        readBack("a.exr", ImageSpec(2, 1, 3, TypeDesc::FLOAT), {1, -2, 3, -0.5f, 5, 6});
    EXPECT_EQ(read.environment.rgb, (std::vector<float>{1, 0, 3, 0, 5, 6}));
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_EQ(read.warnings[0],
              (folder_ / "a.exr").string() + ": 2 of 6 values are below 0, and count as 0");
}

TEST_F(ReadEnvironment, OtherPrimariesAreWarnedOf) {
    ImageSpec spec(2, 1, 3, TypeDesc::FLOAT);
    const float aces[8] = {0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
    spec.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), aces);
    const Read read = readBack("a.exr", spec, ramp(6));
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_EQ(read.warnings[0],
              (folder_ / "a.exr").string() + ": colours of other primaries are read as Rec. 709's");
}

TEST_F(ReadEnvironment, RefusesOtherShapes) {
    EXPECT_EQ(refusalOf("a.exr", ImageSpec(4, 4, 3, TypeDesc::FLOAT), ramp(48)),
              "input: a.exr: got 4x4 pixels; expected a lat-long picture, twice as wide as high");
    EXPECT_EQ(refusalOf("b.hdr", ImageSpec(5, 2, 3, TypeDesc::FLOAT), ramp(30)),
              "input: b.hdr: got 5x2 pixels; expected a lat-long picture, twice as wide as high");
    ImageSpec part(4, 2, 3, TypeDesc::FLOAT);
    part.full_width = 8;
    part.full_height = 4;
    EXPECT_EQ(refusalOf("c.exr", part, ramp(24)),
              "input: c.exr: got 4x2 pixels of a picture of 8x4; expected a whole picture");
}

TEST_F(ReadEnvironment, RefusesOtherChannels) {
    ImageSpec spec(2, 1, 2, TypeDesc::FLOAT);
    spec.channelnames = {"U", "V"};
    EXPECT_EQ(refusalOf("a.exr", spec, ramp(4)),
              "input: a.exr: got 2x1 float, channels: 2; expected the channels R, G and B, or one");
}

TEST_F(ReadEnvironment, RefusesWhatIsNotFinite) {
    for (const float odd : {kNan, kInfinity, -kInfinity}) {
        EXPECT_EQ(refusalOf("a.exr", ImageSpec(2, 1, 3, TypeDesc::FLOAT), {1, odd, 3, odd, 5, 6}),
                  "input: a.exr: got 2 of 6 values that are not finite; expected how bright they "
                  "are");
    }
}

TEST_F(ReadEnvironment, RefusesBlack) {
    for (const char* name : {"a.exr", "b.hdr", "c.png"}) {
        EXPECT_EQ(refusalOf(name, ImageSpec(2, 1, 3, TypeDesc::FLOAT), std::vector<float>(6)),
                  std::string("input: ") + name +
                      ": got a picture without light; expected a value above 0");
    }
    EXPECT_EQ(refusalOf("d.exr", ImageSpec(2, 1, 3, TypeDesc::FLOAT), std::vector<float>(6, -1)),
              "input: d.exr: got a picture without light; expected a value above 0");
}

TEST_F(ReadEnvironment, RefusesOtherFiles) {
    const std::string known =
        "; expected an environment named .exr, .hdr, .tif, .tiff, .png, .jpg or .jpeg";
    EXPECT_EQ(refusalOf("a.dcm"), "input: a.dcm: got a file named .dcm" + known);
    EXPECT_EQ(refusalOf("a"), "input: a: got a name without extension" + known);
    EXPECT_EQ(refusalOf("none.exr").substr(0, 16), "input: none.exr:");
    fs::create_directory(folder_ / "folder.hdr");
    EXPECT_EQ(refusalOf("folder.hdr").substr(0, 18), "input: folder.hdr:");
}

TEST_F(ReadEnvironment, RefusesBrokenFiles) {
    for (const std::string name : {"a.exr", "a.hdr", "a.tif", "a.png", "a.jpg"}) {
        const bool whole = name == "a.png" || name == "a.jpg";
        const ImageSpec spec(64, 32, 3, whole ? TypeDesc::UINT8 : TypeDesc::FLOAT);
        write(folder_ / name, spec, ramp(64 * 32 * 3));
        EXPECT_EQ(refusalOf(name), "no error");
        if (name != "a.png") {  // libpng leaks the error's text
            fs::resize_file(folder_ / name, fs::file_size(folder_ / name) / 2);
            const std::string error = refusalOf(name);
            EXPECT_EQ(error.substr(0, 13), "input: " + name + ":") << error;
            EXPECT_EQ(error.find('\n'), error.npos);
        }
        std::ofstream(folder_ / name) << "no picture at all";
        EXPECT_EQ(refusalOf(name).substr(0, 13), "input: " + name + ":");
        fs::resize_file(folder_ / name, 0);
        EXPECT_EQ(refusalOf(name).substr(0, 13), "input: " + name + ":");
    }
}

}  // namespace
}  // namespace deltasplat
