// SPDX-License-Identifier: Apache-2.0
#include "../tools/drawing/drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "../tools/drawing/plot_file.h"
#include "../tools/drawing/stroke_font.h"
#include "../tools/text/utf8_text.h"
#include "deltasplat/error.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

constexpr Rgb kBlack{0, 0, 0};

Drawing drawingOf(std::vector<std::variant<Area, Line, Label>> items, glm::dvec2 size = {20, 10}) {
    return {size, std::move(items)};
}

// How much black lies over the white of the whole picture, in pixels.
double inkOf(const Image& image) {
    double ink = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) ink += 1 - double(image.rgba[i]);
    return ink;
}

TEST(Svg, HoldsWhatIsDrawn) {
    Label label{{3, 4.004}, "a < b & c > \"d\"", 12, {255, 0, 16}, Label::Anchor::kEnd};
    label.bold = true;
    label.upwards = true;
    const Drawing drawing = drawingOf({Area{{{0, 0}, {2, 0}, {2, 1.5}, {0.333, 2}}, {1, 2, 3}, 0.5},
                                       Line{{{1, 1}, {1, 5}, {4, 5}}, {0, 114, 178}, 1.25}, label});
    EXPECT_EQ(svgText(drawing),
              "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20\" height=\"10\" "
              "viewBox=\"0 0 20 10\" font-family=\"Helvetica, Arial, sans-serif\">\n"
              "<rect width=\"20\" height=\"10\" fill=\"#ffffff\"/>\n"
              "<path fill=\"#010203\" fill-opacity=\"0.5\" d=\"M0 0H2V1.5L0.33 2Z\"/>\n"
              "<path fill=\"none\" stroke=\"#0072b2\" stroke-width=\"1.25\" "
              "stroke-linecap=\"round\" stroke-linejoin=\"round\" d=\"M1 1V5H4\"/>\n"
              "<text x=\"3\" y=\"4\" font-size=\"12\" fill=\"#ff0010\" text-anchor=\"end\" "
              "font-weight=\"bold\" transform=\"rotate(-90 3 4)\">"
              "a &lt; b &amp; c &gt; \"d\"</text>\n"
              "</svg>\n");
}

TEST(Svg, IsWellFormedWhateverTheText) {
    const std::string text = svgText(drawingOf({Label{{0, 0}, "a\x01\xff\n\xc3\xbc", 9, kBlack}}));
    EXPECT_NE(text.find(">a???\xc3\xbc</text>"), std::string::npos) << text;
}

TEST(Raster, IsWhiteAndOpaque) {
    const Image image = rasterize(drawingOf({}), 1.5);
    EXPECT_EQ(image.size, glm::ivec2(30, 15));
    for (const float value : image.rgba) EXPECT_EQ(value, 1.0F);
}

TEST(Raster, AreaCoversItsShareOfEachPixel) {
    const Image image =
        rasterize(drawingOf({Area{{{1.25, 1}, {3.5, 1}, {3.5, 2.5}, {1.25, 2.5}}, kBlack}}), 1);
    const double across[] = {0, 0.75, 1, 0.5, 0};
    const double down[] = {0, 1, 0.5, 0};
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            EXPECT_NEAR(1 - image.pixel(x, y)[0], across[x] * down[y], 1e-6) << x << "," << y;
        }
    }
    EXPECT_NEAR(inkOf(image), 2.25 * 1.5, 1e-5);
}

TEST(Raster, AreaOfAnyPolygonIsRight) {
    // A step with a notch, and a triangle; at twice the size four times the area.
    const Area step{{{1, 9}, {1, 4}, {5, 4}, {5, 6.5}, {8, 6.5}, {8, 2}, {11, 2}, {11, 9}}, kBlack};
    const Area triangle{{{12, 9}, {19, 9}, {15.3, 1}}, kBlack};
    const double expected = 4 * 5 + 3 * 2.5 + 3 * 7 + 7 * 8 / 2.0;
    EXPECT_NEAR(inkOf(rasterize(drawingOf({step, triangle}), 1)), expected, 0.02);
    EXPECT_NEAR(inkOf(rasterize(drawingOf({step, triangle}), 2)), 4 * expected, 0.04);
}

TEST(Raster, OpacityMixesLight) {
    const Rgb grey{188, 188, 188};
    const Area all{{{0, 0}, {20, 0}, {20, 10}, {0, 10}}, grey, 0.25};
    const Image image = rasterize(drawingOf({all}), 1);
    const double linear = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(image.pixel(7, 7)[1], 0.75 + 0.25 * linear, 1e-6);
    EXPECT_EQ(image.pixel(7, 7)[3], 1.0F);
}

TEST(Raster, LineOnPixelCentresIsSharp) {
    const Image image = rasterize(drawingOf({Line{{{3.5, 4.5}, {9.5, 4.5}}, kBlack, 1}}), 1);
    for (int x = 0; x < 20; ++x) {
        EXPECT_NEAR(image.pixel(x, 4)[0], x >= 3 && x <= 9 ? 0 : 1, 1e-6) << x;
        EXPECT_NEAR(image.pixel(x, 3)[0], 1, 1e-6);
        EXPECT_NEAR(image.pixel(x, 5)[0], 1, 1e-6);
    }
}

TEST(Raster, LineHasItsWidthAndRoundEnds) {
    const double length = 10;
    const double width = 4;
    const Line line{{{4.3, 5.1}, {4.3 + length, 5.1}}, kBlack, width};
    const double expected = length * width + std::numbers::pi * width * width / 4;
    EXPECT_NEAR(inkOf(rasterize(drawingOf({line}), 1)), expected, 0.02 * expected);
    // One laid over itself is not darker.
    const Line there{{line.points[0], line.points[1], line.points[0]}, kBlack, width};
    EXPECT_EQ(rasterize(drawingOf({line}), 1).rgba, rasterize(drawingOf({there}), 1).rgba);
}

TEST(Raster, WhatLiesOutsideIsLeftOut) {
    const Image image = rasterize(
        drawingOf({Area{{{-5, -5}, {2, -5}, {2, 300}, {-5, 300}}, kBlack},
                   Line{{{15, -100}, {15, -50}}, kBlack, 3}, Label{{-40, -40}, "out", 9, kBlack}}),
        1);
    EXPECT_NEAR(inkOf(image), 2 * 10, 1e-4);
}

TEST(Raster, TextStandsWhereItsAnchorSays) {
    const auto middleOfInk = [](Label label) {
        const Image image = rasterize(drawingOf({std::move(label)}, {100, 100}), 1);
        glm::dvec2 sum(0);
        for (int y = 0; y < 100; ++y) {
            for (int x = 0; x < 100; ++x) {
                sum += (1.0 - image.pixel(x, y)[0]) * glm::dvec2(x + 0.5, y + 0.5);
            }
        }
        return sum / inkOf(image);
    };
    Label label{{50, 60}, "HHHH", 14, kBlack};
    const double half = 0.5 * 14 * strokesOf("HHHH").width;
    const double capital = 0.5 * 14 * 14 * 0.0515;  // half the height of a capital
    const glm::dvec2 start = middleOfInk(label);
    EXPECT_NEAR(start.x, 50 + half, 0.1);
    EXPECT_NEAR(start.y, 60 - capital, 0.5);
    label.anchor = Label::Anchor::kEnd;
    EXPECT_NEAR(middleOfInk(label).x, 50 - half, 0.1);
    label.anchor = Label::Anchor::kMiddle;
    EXPECT_NEAR(middleOfInk(label).x, 50, 0.1);
    label.upwards = true;
    EXPECT_NEAR(middleOfInk(label).x, 50 - capital, 0.5);
    EXPECT_NEAR(middleOfInk(label).y, 60, 0.1);
}

TEST(Raster, DrawsOverLightThatIsThere) {
    // Half covered: half of the light that is there, and half of the shape's, whose alpha is 1.
    Image image(glm::ivec2(3, 1));
    const float there[] = {0.25F, 2, 0, 0.5F};
    for (int x = 0; x < 3; ++x) std::copy(std::begin(there), std::end(there), image.pixel(x, 0));
    drawOver(image, {Area{{{1, 0}, {2, 0}, {2, 0.5}, {1, 0.5}}, {255, 0, 255}}});
    const float half[] = {0.625F, 1, 0.5F, 0.75F};
    for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(image.pixel(0, 0)[c], there[c]);
        EXPECT_EQ(image.pixel(1, 0)[c], half[c]);
        EXPECT_EQ(image.pixel(2, 0)[c], there[c]);
    }
}

TEST(Raster, TooLargeIsRefused) {
    try {
        rasterize(drawingOf({}, {1e7, 1e7}), 1);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kFailed);
    }
}

// Degree, plus-minus, squared, cubed, micro, times, sharp s, dash, and letters with marks.
constexpr char32_t kBeyondAscii[] =
    U"\u00B0\u00B1\u00B2\u00B3\u00B5\u00D7\u00DF\u2013\u00C4\u00CB\u00D6\u00DC\u00E4\u00EB\u00F6"
    U"\u00FC"
    U"\u00C1\u00C9\u00D3\u00DA\u00E1\u00E9\u00F3\u00FA\u00C0\u00C8\u00D2\u00D9\u00E0\u00E8\u00F2"
    U"\u00F9"
    U"\u00C2\u00CA\u00D4\u00DB\u00E2\u00EA\u00F4\u00FB\u00D1\u00F1";

TEST(StrokeFont, EveryCharacterHasAShapeOfItsOwn) {
    std::set<std::vector<double>> shapes;
    std::vector<std::string> characters;
    for (char c = '!'; c <= '~'; ++c) characters.emplace_back(1, c);
    for (const char32_t beyond : std::u32string_view(kBeyondAscii))
        characters.push_back(utf8(std::u32string(1, beyond)));
    for (const std::string& c : characters) {
        const TextStrokes text = strokesOf(c);
        EXPECT_GT(text.width, 0.1) << c;
        EXPECT_LT(text.width, 1.1) << c;
        std::vector<double> shape;
        for (const auto& stroke : text.strokes) {
            EXPECT_FALSE(stroke.empty()) << c;
            for (const glm::dvec2& p : stroke) {
                // Inside its own place, on a line of text.
                EXPECT_GE(p.x, 0) << c;
                EXPECT_LE(p.x, text.width) << c;
                EXPECT_GT(p.y, -0.9) << c;
                EXPECT_LT(p.y, 0.25) << c;
                shape.insert(shape.end(), {p.x, p.y});
            }
        }
        EXPECT_TRUE(shapes.insert(shape).second) << c;
    }
}

TEST(StrokeFont, NumbersStandBelowEachOther) {
    for (char c = '0'; c <= '9'; ++c) {
        EXPECT_EQ(strokesOf(std::string(1, c)).width, strokesOf("0").width) << c;
    }
    EXPECT_NEAR(strokesOf("17 %").width,
                2 * strokesOf("0").width + strokesOf(" ").width + strokesOf("%").width, 1e-12);
}

TEST(StrokeFont, MarksStandAboveTheirLetters) {
    for (const auto& [marked, plain] : {std::pair("\xc3\xa4", "a"), std::pair("\xc3\x96", "O")}) {
        const TextStrokes text = strokesOf(marked);
        const TextStrokes letter = strokesOf(plain);
        EXPECT_EQ(text.width, letter.width);
        ASSERT_EQ(text.strokes.size(), letter.strokes.size() + 2);
        double top = 0;
        for (const auto& stroke : letter.strokes)
            for (const glm::dvec2& p : stroke) top = std::min(top, p.y);
        const glm::dvec2 left = text.strokes[letter.strokes.size()][0];
        const glm::dvec2 right = text.strokes.back()[0];
        EXPECT_LT(std::max(left.y, right.y), top - 0.08) << plain;
        EXPECT_LT(left.x, right.x);
    }
}

TEST(StrokeFont, OtherCharactersAreOneBoxEach) {
    EXPECT_EQ(strokesOf("\xc5\x82").strokes.size(), 1u);
    EXPECT_EQ(strokesOf("\xe2\x82\xac\xc5\x82").strokes.size(), 2u);
    EXPECT_TRUE(strokesOf(" ").strokes.empty());
    EXPECT_EQ(strokesOf("").width, 0);
}

TEST(Utf8, ReadsAndWritesEveryLength) {
    const std::string text = "a\xc3\xbc\xe2\x82\xac\xf0\x9f\x98\x80";
    EXPECT_EQ(codePoints(text), U"a\u00fc\u20ac\U0001f600");
    EXPECT_EQ(utf8(codePoints(text)), text);
}

TEST(Utf8, WhatIsNoneBecomesAQuestionMark) {
    EXPECT_EQ(codePoints("\x80x"), U"?x");               // continues nothing
    EXPECT_EQ(codePoints("x\xc3"), U"x?");               // cut short
    EXPECT_EQ(codePoints("\xc0\xaf"), U"??");            // "/" written too long
    EXPECT_EQ(codePoints("\xe0\x80\xaf"), U"???");       // the same, longer
    EXPECT_EQ(codePoints("\xed\xa0\x80"), U"???");       // half of a pair
    EXPECT_EQ(codePoints("\xf4\x90\x80\x80"), U"????");  // beyond Unicode
    EXPECT_EQ(codePoints("\xef\xbf\xbf"), U"???");       // no character
    EXPECT_EQ(codePoints("\x1b\x7f\xc2\x9b"), U"????");  // controls
    EXPECT_EQ(codePoints("\xe2\x82z"), U"??z");          // interrupted
}

TEST(PlotFile, IsPngOrSvg) {
    const test::TempFolder folder;
    const Drawing drawing = drawingOf({Label{{2, 8}, "x", 9, kBlack}});
    for (const char* const name : {"a.svg", "b.SVG", "c.png"}) {
        checkDrawingFile(folder / name);
        EXPECT_FALSE(std::filesystem::exists(folder / name));
        writeDrawing(folder / name, drawing);
        const std::string bytes = test::readBytes(folder / name);
        const bool png = name[0] == 'c';
        EXPECT_EQ(bytes.substr(1, 3), png ? "PNG" : "svg") << name;
        EXPECT_EQ(bytes == svgText(drawing), !png) << name;
    }
    for (const char* const name : {"a.jpg", "a", "a.svgz"}) {
        try {
            checkDrawingFile(folder / name);
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kUsage);
        }
    }
}

}  // namespace
}  // namespace deltasplat
