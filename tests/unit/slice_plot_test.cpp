// SPDX-License-Identifier: Apache-2.0
#include "../tools/info/slice_plot.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace deltasplat {
namespace {

// Along x nothing is visible, along y everything, along z every second slice.
SlicePlot somePlot() {
    SlicePlot plot;
    plot.title = "volume.raw, 4 x 2 x 10";
    plot.visible = "visible: some";
    plot.box = {{-1, 0, 5}, {2, 1, 14}};
    plot.columns[0].assign(4, {0, 0});
    plot.columns[1].assign(2, {40, 10});
    for (int i = 0; i < 10; ++i) plot.columns[2].push_back({i % 2 == 0 ? 8u : 0u, 8});
    return plot;
}

template <class Item>
std::vector<Item> itemsOf(const Drawing& drawing) {
    std::vector<Item> found;
    for (const auto& item : drawing.items) {
        if (const Item* const shape = std::get_if<Item>(&item)) found.push_back(*shape);
    }
    return found;
}

bool says(const Drawing& drawing, const std::string& text) {
    const std::vector<Label> labels = itemsOf<Label>(drawing);
    return std::any_of(labels.begin(), labels.end(),
                       [&](const Label& label) { return label.text == text; });
}

// The areas of the curves: two for each panel, visible first; the two before are the legend's.
Area curveOf(const Drawing& drawing, int axis, bool changed) {
    return itemsOf<Area>(drawing).at(2 + 2 * axis + int(changed));
}

double heightOf(const Area& area) {
    const auto [low, high] =
        std::minmax_element(area.points.begin(), area.points.end(),
                            [](const glm::dvec2& a, const glm::dvec2& b) { return a.y < b.y; });
    return high->y - low->y;
}

double widthOf(const Area& area) {
    const auto [low, high] =
        std::minmax_element(area.points.begin(), area.points.end(),
                            [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x; });
    return high->x - low->x;
}

TEST(SlicePlot, SaysWhatItShows) {
    const Drawing drawing = drawSlicePlots({somePlot()});
    for (const char* const text :
         {"volume.raw, 4 x 2 x 10", "visible: some", "changed from the slice before",
          "along x: comparability 1.0000", "along y: comparability 0.7500",
          "along z: comparability 0.0000", "0 % visible, 0 % changed",
          "100 % visible, 25.0 % changed", "50.0 % visible, 100 % changed", "slice, index x",
          "slice, index z", "share of the slice's voxels (%)", "100"}) {
        EXPECT_TRUE(says(drawing, text)) << text;
    }
}

TEST(SlicePlot, CurvesAreSharesOnOneScale) {
    const Drawing drawing = drawSlicePlots({somePlot()});
    const double full = heightOf(curveOf(drawing, 1, false));
    EXPECT_GT(full, 150);
    EXPECT_EQ(heightOf(curveOf(drawing, 0, false)), 0);
    EXPECT_NEAR(heightOf(curveOf(drawing, 1, true)), 0.25 * full, 1e-9);
    EXPECT_NEAR(heightOf(curveOf(drawing, 2, false)), full, 1e-9);
    EXPECT_NEAR(heightOf(curveOf(drawing, 2, true)), full, 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(widthOf(curveOf(drawing, axis, false)), 312, 1e-9);
    }
}

TEST(SlicePlot, EverySliceIsAStep) {
    // Ten slices, every second one visible: 5 towers on 312 pixels.
    const Area area = curveOf(drawSlicePlots({somePlot()}), 2, false);
    ASSERT_EQ(area.points.size(), 2u * 10 + 2);
    for (int i = 0; i < 10; ++i) {
        EXPECT_NEAR(area.points[2 * i + 1].x - area.points[2 * i].x, 31.2, 1e-9);
        EXPECT_EQ(area.points[2 * i].y, area.points[2 * i + 1].y);
        EXPECT_EQ(area.points[2 * i].y < area.points.back().y, i % 2 == 0) << i;
    }
}

TEST(SlicePlot, ManySlicesShareColumns) {
    EXPECT_EQ(slicesPerColumn(0), 0);
    EXPECT_EQ(slicesPerColumn(1), 1);
    EXPECT_EQ(slicesPerColumn(640), 1);
    EXPECT_EQ(slicesPerColumn(641), 2);
    EXPECT_EQ(slicesPerColumn(2147483647), 3355444);

    // 1001 slices of one voxel, two a column: full up to the last column, which has one slice.
    SlicePlot plot = somePlot();
    plot.box = {{0, 0, 0}, {0, 0, 1000}};
    plot.columns[2].assign(500, {2, 2});
    plot.columns[2].push_back({1, 1});
    const Drawing drawing = drawSlicePlots({plot});
    const Area area = curveOf(drawing, 2, false);
    ASSERT_EQ(area.points.size(), 4u);
    EXPECT_NEAR(widthOf(area), 312, 1e-9);
    EXPECT_TRUE(says(drawing, "100 % visible, 100 % changed"));
}

TEST(SlicePlot, SlicesHaveTheirIndices) {
    const Drawing drawing = drawSlicePlots({somePlot()});
    // -1 to 2 along x, 5 to 14 along z in steps of two.
    for (const char* const text : {"-1", "2", "6", "14"}) EXPECT_TRUE(says(drawing, text)) << text;
    for (const char* const text : {"3", "5", "15"}) EXPECT_FALSE(says(drawing, text)) << text;
}

TEST(SlicePlot, OneRowForEachGrid) {
    const Drawing one = drawSlicePlots({somePlot()});
    const Drawing three = drawSlicePlots({somePlot(), somePlot(), somePlot()});
    EXPECT_EQ(three.size.y, 3 * one.size.y);
    EXPECT_EQ(three.size.x, one.size.x);
    EXPECT_EQ(three.items.size(), 3 * one.items.size());
}

TEST(SlicePlot, NothingIsSaidToBeNothing) {
    SlicePlot plot;
    plot.title = "empty.vdb, density, 0 x 0 x 0";
    const Drawing drawing = drawSlicePlots({plot});
    EXPECT_TRUE(says(drawing, "no active voxels"));
    EXPECT_TRUE(says(drawing, "along x: comparability 1.0000"));
    EXPECT_EQ(svgText(drawing).find("nan"), std::string::npos);
}

TEST(SlicePlot, LongNamesKeepTheirEnds) {
    SlicePlot plot = somePlot();
    plot.title = "begin" + std::string(300, 'x') + "end";
    const std::vector<Label> labels = itemsOf<Label>(drawSlicePlots({plot}));
    const std::string title = labels.front().text;
    EXPECT_LT(title.size(), 120u);
    EXPECT_EQ(title.substr(0, 5), "begin");
    EXPECT_EQ(title.substr(title.size() - 3), "end");
    EXPECT_NE(title.find("..."), std::string::npos);
}

}  // namespace
}  // namespace deltasplat
