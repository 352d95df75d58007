// SPDX-License-Identifier: Apache-2.0
#include "annotate/annotate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <random>
#include <set>

#include "annotate/axes.h"
#include "annotate/scale_bar.h"
#include "annotate/text_lines.h"
#include "drawing/nice_step.h"
#include "drawing/stroke_font.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

constexpr IndexBox kBox{{0, 0, 0}, {99, 79, 59}};

Camera cameraOf(const CameraOptions& options, const std::string& space = "") {
    return makeCamera(options, kBox, glm::dmat4(1), space);
}

Camera cameraOf(const std::string& view, const std::string& space = "",
                glm::ivec2 size = {512, 512}) {
    CameraOptions options;
    options.view = view;
    options.sizePixels = size;
    return cameraOf(options, space);
}

Image opaque(glm::ivec2 size, float level) {
    Image image(size);
    std::fill(image.rgba.begin(), image.rgba.end(), level);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 1;
    return image;
}

// What a listener is told.
struct Warnings {
    std::vector<std::string> lines;
    Listener listener() {
        return {{}, [this](const std::string& line) { lines.push_back(line); }};
    }
    bool name(const std::string& option) const {
        return std::any_of(lines.begin(), lines.end(),
                           [&](const auto& line) { return line.starts_with(option + ": "); });
    }
};

Legend someScale() {
    ValueScale scale;
    scale.range = {-40, 160};
    scale.colorOf = [](double value) { return value < 60 ? Rgb{255, 0, 0} : Rgb{0, 0, 255}; };
    scale.opacityOf = [](double value) { return value < 60 ? 0 : 0.25; };
    return {"a scale", scale};
}

Legend labelsOf(int count) {
    std::vector<LabelColor> labels;
    for (int i = 1; i <= count; ++i) labels.push_back({"label", {std::uint8_t(i), 9, 200}});
    return {"labels", labels};
}

TEST(NiceTicks, AreWrittenAsTheyAreMeant) {
    EXPECT_EQ(niceTicks(0, 1, 8),
              (std::vector<double>{0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1}));
    EXPECT_EQ(niceTicks(-400, 1500, 3), (std::vector<double>{0, 500, 1000, 1500}));
    EXPECT_EQ(niceTicks(-3e-7, 4e-7, 3), (std::vector<double>{-2e-7, 0, 2e-7, 4e-7}));
    EXPECT_EQ(niceTicks(1e6 + 1, 1e6 + 3, 2), (std::vector<double>{1000001, 1000002, 1000003}));
    EXPECT_TRUE(niceTicks(-1.7e308, 1.7e308, 3).empty());
    EXPECT_TRUE(niceTicks(1e300, std::nextafter(1e300, 2e300), 3).empty());
}

TEST(ScaleBar, IsTheLongestRoundLengthThatHasRoom) {
    for (const double frame : {0.0031, 0.5, 1.0, 6.6, 6.7, 99.0, 166.0, 167.0, 1e7}) {
        CameraOptions options;
        options.frameWidthWorld = frame;
        options.sizePixels = {700, 300};
        const ScaleBar bar = scaleBarOf(cameraOf(options), "");
        double longest = 0;
        for (int power = -9; power < 9; ++power) {
            for (const char* const factor : {"1e", "2e", "5e"}) {
                const double length = std::atof((factor + std::to_string(power)).c_str());
                if (length <= 0.3 * frame) longest = std::max(longest, length);
            }
        }
        EXPECT_EQ(bar.lengthWorld, longest) << frame;
        EXPECT_NEAR(bar.lengthPixels, 700 * longest / frame, 1e-9) << frame;
    }
}

TEST(ScaleBar, IsAsLongAsItIsSeen) {
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        CameraOptions options;
        options.projection = projection;
        options.view = "iso";
        options.azimuthDegrees = 17;
        options.sizePixels = {640, 400};
        const Camera camera = cameraOf(options);
        const ScaleBar bar = scaleBarOf(camera, "mm");
        const glm::dvec2 seen =
            camera.pixelFromWorld(camera.targetWorld + bar.lengthWorld * camera.right) -
            camera.pixelFromWorld(camera.targetWorld);
        EXPECT_NEAR(seen.x, bar.lengthPixels, 1e-9);
        EXPECT_NEAR(seen.y, 0, 1e-9);

        // Drawn, it takes as much of a row of pixels.
        Image image = opaque(camera.sizePixels, 0);
        const AnnotationStyle style(camera.sizePixels, kInkOnDark);
        const Annotation drawn = drawScaleBar(bar, style);
        annotate({drawn}, image);
        const double ink = std::pow((250 / 255.0 + 0.055) / 1.055, 2.4);
        double length = 0;
        const int row = int(400 - style.margin - 0.3 * style.font);
        for (int x = 0; x < 640; ++x) length += double(image.pixel(x, row)[1]) / ink;
        EXPECT_NEAR(length, bar.lengthPixels, 1e-4);
    }
}

TEST(ScaleBar, SaysItsUnitAndWhereItHolds) {
    CameraOptions options;
    options.frameWidthWorld = 100;
    EXPECT_EQ(scaleBarOf(cameraOf(options), "").label, "20 units");
    EXPECT_EQ(scaleBarOf(cameraOf(options, "LPS"), "mm").label, "20 mm");
    options.frameWidthWorld = 1;
    EXPECT_EQ(scaleBarOf(cameraOf(options), "").label, "0.2 units");
    // Known lengths in units of which there is one or more.
    for (const auto& [frame, unit, label] : {std::tuple{1.0, "mm", "200 um"},
                                             {1e-3, "mm", "200 nm"},
                                             {1.0, "um", "200 nm"},
                                             {100.0, "um", "20 um"},
                                             {4e4, "um", "10000 um"},
                                             {0.4, "m", "100 mm"},
                                             {1.0, "cm", "2 mm"},
                                             {4.0, "in", "1 in"},
                                             {2.0, "in", "10 mm"},
                                             {2.0, "ft", "100 mm"},
                                             {1e-9, "mm", "2e-10 mm"}}) {
        options.frameWidthWorld = frame;
        const ScaleBar bar = scaleBarOf(cameraOf(options), unit);
        EXPECT_EQ(bar.label, label) << frame << " " << unit;
        // As long as the label says.
        const std::string text = label;
        const std::string shown = text.substr(text.find(' ') + 1);
        EXPECT_NEAR(bar.lengthWorld * millimetresIn(unit) / millimetresIn(shown),
                    std::atof(text.c_str()), 1e-9 * std::atof(text.c_str()))
            << frame << " " << unit;
    }
    CameraOptions eye;
    eye.projection = Projection::kPerspective;
    EXPECT_TRUE(scaleBarOf(cameraOf(eye), "mm").label.ends_with(" mm at target"));
}

TEST(Axes, HaveThePatientsLetters) {
    struct Case {
        const char* space;
        const char* view;
        const char* right;  // and what else points to the right, up and to the camera
        const char* up;
        const char* near;
    };
    // "-R": R points the other way.
    for (const Case& c :
         {Case{"RAS", "front", "-R", "S", "A"}, Case{"LPS", "front", "L", "S", "-P"},
          Case{"RAS", "back", "R", "S", "-A"}, Case{"LPS", "top", "L", "P", "S"},
          Case{"", "front", "x", "y", "z"}, Case{"", "right", "-z", "y", "x"}}) {
        const Camera camera = cameraOf(c.view, c.space);
        const auto find = [&](const std::string& name) {
            for (const SeenAxis& axis : seenAxes(camera, c.space))
                if (name.ends_with(axis.letter)) return axis;
            ADD_FAILURE() << c.space << " has no " << name;
            return SeenAxis();
        };
        const auto sign = [](const std::string& name) { return name.size() > 1 ? -1.0 : 1.0; };
        EXPECT_NEAR(find(c.right).along.x, sign(c.right), 1e-12) << c.space << c.view;
        EXPECT_NEAR(find(c.up).along.y, -sign(c.up), 1e-12) << c.space << c.view;
        EXPECT_NEAR(find(c.near).away, -sign(c.near), 1e-12) << c.space << c.view;
    }
}

TEST(Axes, PointWhereTheWorldDoes) {
    CameraOptions options;
    options.view = "iso";
    options.azimuthDegrees = 31;
    options.rollDegrees = 12;
    const Camera camera = cameraOf(options);
    const auto axes = seenAxes(camera, "");
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = camera.pixelWorld();
        const glm::dvec2 seen = camera.pixelFromWorld(camera.targetWorld + step) -
                                camera.pixelFromWorld(camera.targetWorld);
        EXPECT_NEAR(seen.x, axes[axis].along.x, 1e-9);
        EXPECT_NEAR(seen.y, axes[axis].along.y, 1e-9);
    }
}

// The strokes of each axis' letter, boxed: what there is in its colour besides the arrows.
std::array<DrawnBox, 3> letterBoxes(const std::array<SeenAxis, 3>& axes,
                                    const AnnotationStyle& style) {
    std::array<SeenAxis, 3> bare = axes;
    for (SeenAxis& axis : bare) axis.letter.clear();
    const auto linesOf = [&](const Annotation& annotation, const Rgb& color) {
        std::vector<std::vector<glm::dvec2>> lines;
        for (const Shape& shape : annotation.shapes) {
            const Line* const line = std::get_if<Line>(&shape);
            if (line && line->color.r == color.r && line->color.g == color.g)
                lines.push_back(line->points);
        }
        return lines;
    };
    std::array<DrawnBox, 3> boxes;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto lines = linesOf(drawAxes(axes, style), style.colors.axes[i]);
        const std::size_t arrow = linesOf(drawAxes(bare, style), style.colors.axes[i]).size();
        DrawnBox box{glm::dvec2(1e9), glm::dvec2(-1e9)};
        for (std::size_t n = arrow; n < lines.size(); ++n) {
            for (const glm::dvec2& p : lines[n]) {
                box.min = glm::min(box.min, p);
                box.max = glm::max(box.max, p);
            }
        }
        boxes[i] = box;
    }
    return boxes;
}

TEST(Axes, LettersHavePlacesOfTheirOwn) {
    const AnnotationStyle style({300, 300}, kInkOnDark);
    int letters = 0;
    const auto check = [&](const CameraOptions& options, const std::string& space) {
        const auto boxes = letterBoxes(seenAxes(cameraOf(options, space), space), style);
        for (int i = 0; i < 3; ++i) {
            letters += !boxes[i].empty();
            EXPECT_FALSE(boxes[i].overlaps(boxes[(i + 1) % 3]))
                << options.azimuthDegrees << ' ' << options.elevationDegrees;
        }
    };
    // P points nearly at the viewer.
    CameraOptions options;
    options.azimuthDegrees = 20;
    check(options, "LPS");
    EXPECT_EQ(letters, 3);
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        options.azimuthDegrees = int(random() % 360);
        options.elevationDegrees = int(random() % 180) - 90;
        options.rollDegrees = int(random() % 360);
        check(options, "");
    }
    EXPECT_GE(letters, 0.99 * 3 * 1001);
}

TEST(Annotations, LeaveThePictureAroundThemAlone) {
    const AnnotationChoice choice{true, true, true, {"one line", "and \xc3\xa4nother"}};
    std::mt19937 random(5);
    for (const glm::ivec2 size : {glm::ivec2(256), glm::ivec2(512, 300), glm::ivec2(700, 1200)}) {
        for (const Legend& legend : {someScale(), labelsOf(3), labelsOf(1000)}) {
            Warnings warnings;
            const auto annotations = layOut(choice, cameraOf("iso", "LPS", size), "LPS", "mm",
                                            legend, kInkOnDark, warnings.listener());
            ASSERT_EQ(annotations.size(), 4u);
            EXPECT_TRUE(warnings.lines.empty());
            Image before(size);
            for (float& v : before.rgba) v = float(random() % 1000) / 1000;
            Image after = before;
            annotate(annotations, after);
            std::vector<int> changed(annotations.size());
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    const DrawnBox pixel{{x, y}, {x + 1, y + 1}};
                    bool covered = false;
                    for (std::size_t i = 0; i < annotations.size(); ++i) {
                        if (!annotations[i].box.overlaps(pixel)) continue;
                        EXPECT_FALSE(covered) << "two annotations at one place";
                        covered = true;
                        changed[i] += before.pixel(x, y)[0] != after.pixel(x, y)[0];
                    }
                    if (covered) continue;
                    for (int c = 0; c < 4; ++c)
                        ASSERT_EQ(before.pixel(x, y)[c], after.pixel(x, y)[c]) << x << "," << y;
                }
            }
            for (const int count : changed) EXPECT_GT(count, 50);
        }
    }
}

TEST(Annotations, AreLeftOutWhereThereIsNoRoom) {
    const AnnotationChoice choice{true, true, true, {"text"}};
    for (const int side : {1, 20, 40, 60, 95}) {
        Warnings warnings;
        std::set<std::string> placed;
        for (const Annotation& a : layOut(choice, cameraOf("iso", "", glm::ivec2(side)), "", "",
                                          someScale(), kInkOnDark, warnings.listener()))
            placed.insert(a.option);
        for (const char* const option : {"--legend", "--scale-bar", "--axes", "--annotate"})
            EXPECT_NE(placed.contains(option), warnings.name(option)) << option << " " << side;
        EXPECT_FALSE(warnings.lines.empty());
    }
}

TEST(Annotations, LongTextIsShortened) {
    const std::string text(300, 'w');
    Warnings warnings;
    const auto annotations = layOut({true, false, false, {text, "short"}}, cameraOf("front"), "",
                                    "", someScale(), kInkOnDark, warnings.listener());
    ASSERT_EQ(annotations.size(), 2u);
    EXPECT_LE(annotations[1].box.max.x, annotations[0].box.min.x);
    EXPECT_GT(annotations[1].box.max.x, annotations[0].box.min.x - 40);
    EXPECT_TRUE(warnings.name("--annotate"));
    // More lines than there is room for.
    Warnings many;
    const auto lines = layOut({false, false, false, std::vector<std::string>(100, "line")},
                              cameraOf("front"), "", "", {}, kInkOnDark, many.listener());
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(many.name("--annotate"));
}

TEST(Legend, ShowsValuesInTheirPlaces) {
    const glm::ivec2 size(512);
    const AnnotationStyle style(size, kInkOnDark);
    Image image = opaque(size, 0);
    annotate({drawLegend(someScale(), style)}, image);
    // Half of the bar's rows are red, the lower ones; the opacities beside it are those of blue.
    int red = 0;
    int blue = 0;
    int lowestBlue = 0;
    int highestRed = size.y;
    for (int y = 0; y < size.y; ++y) {
        bool isRed = false;
        bool isBlue = false;
        for (int x = 0; x < size.x; ++x) {
            const float* rgba = image.pixel(x, y);
            isRed = isRed || (rgba[0] == 1 && rgba[1] == 0 && rgba[2] == 0);
            isBlue = isBlue || (rgba[0] == 0 && rgba[1] == 0 && rgba[2] == 1);
        }
        red += isRed;
        blue += isBlue;
        if (isRed) highestRed = std::min(highestRed, y);
        if (isBlue) lowestBlue = y;
    }
    EXPECT_NEAR(red + blue, 0.4 * size.y, 1);
    EXPECT_NEAR(red, blue, 1);
    EXPECT_EQ(highestRed, lowestBlue + 1);
}

TEST(Legend, ListsAsManyLabelsAsThereIsRoomFor) {
    for (const int count : {1, 7, 200}) {
        const glm::ivec2 size(300);
        const Annotation legend = drawLegend(labelsOf(count), AnnotationStyle(size, kInkOnDark));
        EXPECT_LE(legend.box.max.y, size.y);
        std::size_t shown = 0;
        std::size_t lines = 0;
        for (const Shape& shape : legend.shapes)
            std::holds_alternative<Area>(shape) ? ++shown : ++lines;
        EXPECT_EQ(shown == std::size_t(count), count < 10);
        // Every stroke and every frame has a rim.
        const auto strokes = [](const std::string& text) { return strokesOf(text).strokes.size(); };
        std::size_t expected = strokes("labels") + shown * (strokes("label") + 1);
        if (shown < std::size_t(count))
            expected += strokes("and " + std::to_string(std::size_t(count) - shown) + " more");
        EXPECT_EQ(lines, 2 * expected) << count;
    }
}

TEST(Annotations, AreDarkOnLightPictures) {
    const auto isDark = [](const Image& image) { return inkFor(image).ink.r < 128; };
    EXPECT_TRUE(isDark(opaque({40, 30}, 1)));
    EXPECT_FALSE(isDark(opaque({40, 30}, 0)));
    EXPECT_FALSE(isDark(Image({40, 30})));
    EXPECT_TRUE(isDark(opaque({1, 1}, 1)));
    // It is the border that counts.
    Image bright = opaque({40, 30}, 0);
    for (int y = 4; y < 26; ++y)
        for (int x = 5; x < 35; ++x) bright.pixel(x, y)[1] = 1;
    EXPECT_FALSE(isDark(bright));
}

}  // namespace
}  // namespace deltasplat
