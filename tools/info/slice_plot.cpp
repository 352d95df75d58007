// SPDX-License-Identifier: Apache-2.0
#include "info/slice_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "base/text.h"
#include "drawing/nice_step.h"
#include "drawing/stroke_font.h"
#include "volume/code_math.h"

namespace deltasplat {
namespace {

// All lengths are pixels at scale 1.
constexpr double kWidth = 1080;
constexpr double kLeft = 66;
constexpr double kRight = 18;
constexpr double kGap = 30;
constexpr double kPanelWidth = (kWidth - kLeft - kRight - 2 * kGap) / 3;
constexpr double kPanelHeight = 200;
constexpr double kPanelTop = 108;  // from the row's top
constexpr double kRowHeight = kPanelTop + kPanelHeight + 48;
constexpr int kMaxColumns = 640;

constexpr Rgb kInk{34, 34, 34};
constexpr Rgb kGrey{96, 96, 96};
constexpr Rgb kRule{216, 216, 216};
// Told apart by all kinds of eyes, and by their lightness where there is no colour (M. Okabe and
// K. Ito, Color Universal Design, 2008).
constexpr Rgb kVisibleArea{176, 211, 235};
constexpr Rgb kVisibleLine{0, 114, 178};
constexpr Rgb kChangedArea{232, 120, 52};
constexpr Rgb kChangedLine{213, 94, 0};

// One panel's numbers: shares of voxels, 0..1.
struct Curves {
    int slices = 0;
    int slicesPerColumn = 1;
    std::vector<double> visible;  // of each column's voxels
    std::vector<double> changed;
    double visibleShare = 0;  // of the whole volume's voxels
    double changedShare = 0;
};

Curves curvesOf(const std::vector<SliceCounts>& columns, const IndexBox& box, int axis) {
    Curves curves;
    curves.slices = box.dims()[axis];
    curves.slicesPerColumn = slicesPerColumn(curves.slices);
    const double voxels = double(voxelsOf(box));
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const int before = int(i) * curves.slicesPerColumn;
        const int slices = std::min(curves.slicesPerColumn, curves.slices - before);
        const double columnVoxels = voxels / curves.slices * slices;
        curves.visible.push_back(double(columns[i].visible) / columnVoxels);
        curves.changed.push_back(double(columns[i].deltas) / columnVoxels);
        curves.visibleShare += double(columns[i].visible) / voxels;
        curves.changedShare += double(columns[i].deltas) / voxels;
    }
    return curves;
}

std::string formatted(const char* format, double value) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// Three digits that count, down to a ten thousandth.
std::string percentText(double share) {
    const double percent = 100 * share;
    const char* const format = percent >= 99.95   ? "%.0f %%"
                               : percent >= 9.995 ? "%.1f %%"
                               : percent >= 0.995 ? "%.2f %%"
                               : percent >= 0.1   ? "%.3f %%"
                                                  : "%.2g %%";
    return formatted(format, percent);
}

Label label(glm::dvec2 at, const std::string& text, double size, Label::Anchor anchor,
            const Rgb& color = kInk) {
    return {at, text, size, color, anchor};
}

// What text takes of its size at most: the fonts that show an .svg are up to a quarter wider.
constexpr double kWiderFonts = 1.25;

double widthOf(const std::string& text, double size) {
    return kWiderFonts * size * strokesOf(text).width;
}

std::string fitted(const std::string& text, double size, double width) {
    return fittedText(text, width / (kWiderFonts * size));
}

// Draws one row, whose top left corner is `corner`.
class RowPainter {
  public:
    RowPainter(Drawing& drawing, glm::dvec2 corner, const SlicePlot& plot)
        : drawing_(drawing), corner_(corner), plot_(plot) {
        double highest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            curves_[axis] = curvesOf(plot.columns[axis], plot.box, axis);
            for (const double share : curves_[axis].visible) highest = std::max(highest, share);
            for (const double share : curves_[axis].changed) highest = std::max(highest, share);
        }
        // Half a percent of air, so that a curve that stays at the top is seen.
        highest = highest > 0 ? 1.005 * highest : 1;
        step_ = niceStep(highest, 4);
        top_ = highest;
    }

    void paint() {
        const double width = kWidth - kLeft - kRight;
        const glm::dvec2 start = corner_ + glm::dvec2(kLeft, 0);
        Label title = label(start + glm::dvec2(0, 26), fitted(plot_.title, 16, width), 16,
                            Label::Anchor::kStart);
        title.bold = true;
        drawing_.items.push_back(title);
        paintLegend(start + glm::dvec2(0, 49));
        for (int axis = 0; axis < 3; ++axis) paintPanel(axis);
        Label shares = label(corner_ + glm::dvec2(18, kPanelTop + 0.5 * kPanelHeight),
                             "share of the slice's voxels (%)", 12, Label::Anchor::kMiddle, kGrey);
        shares.upwards = true;
        drawing_.items.push_back(shares);
    }

  private:
    void add(std::vector<glm::dvec2> points, const Rgb& color, double width) {
        drawing_.items.push_back(Line{std::move(points), color, width});
    }

    // The text of unknown length comes last.
    void paintLegend(glm::dvec2 at) {
        const std::string changed = "changed from the slice before";
        addSwatch(at, kChangedArea);
        at.x += 25;
        drawing_.items.push_back(label(at, changed, 13, Label::Anchor::kStart));

        at.x += widthOf(changed, 13) + 12;
        addSwatch(at, kVisibleArea);
        add({at + glm::dvec2(0, -10), at + glm::dvec2(18, -10)}, kVisibleLine, 1.5);
        at.x += 25;
        const double left = kWidth - kRight - at.x;
        drawing_.items.push_back(
            label(at, fitted(plot_.visible, 13, left), 13, Label::Anchor::kStart));
    }

    void addSwatch(const glm::dvec2& at, const Rgb& color) {
        const glm::dvec2 right(18, 0);
        const glm::dvec2 up(0, -10);
        drawing_.items.push_back(Area{{at, at + right, at + right + up, at + up}, color});
    }

    void paintPanel(int axis) {
        left_ = corner_.x + kLeft + axis * (kPanelWidth + kGap);
        bottom_ = corner_.y + kPanelTop + kPanelHeight;
        paintTitle(axis);
        paintShares(axis == 0);
        paintCurves(curves_[axis]);
        paintSlices(axis);
    }

    void paintTitle(int axis) {
        const Curves& curves = curves_[axis];
        const double y = corner_.y + kPanelTop - 13;
        Label title =
            label({left_, y - 17}, std::string("along ") + "xyz"[axis], 14, Label::Anchor::kStart);
        title.text += ": comparability " + formatted("%.4f", 1 - curves.changedShare);
        title.bold = true;
        drawing_.items.push_back(title);
        drawing_.items.push_back(label({left_, y},
                                       percentText(curves.visibleShare) + " visible, " +
                                           percentText(curves.changedShare) + " changed",
                                       12, Label::Anchor::kStart, kGrey));
    }

    double heightOf(double share) const { return bottom_ - kPanelHeight * share / top_; }

    // The rules across a panel, and their numbers beside the first one.
    void paintShares(bool numbers) {
        for (int i = 0; i * step_ <= top_; ++i) {
            const double y = heightOf(i * step_);
            if (i > 0) add({{left_, y}, {left_ + kPanelWidth, y}}, kRule, 1);
            if (!numbers) continue;
            drawing_.items.push_back(label({left_ - 7, y + 4}, formatted("%.6g", 100 * i * step_),
                                           12, Label::Anchor::kEnd, kGrey));
        }
    }

    // The upper edge of a curve, a step a column, from left to right.
    std::vector<glm::dvec2> edge(const Curves& curves, const std::vector<double>& shares) const {
        std::vector<glm::dvec2> points;
        const double pixelsPerSlice = kPanelWidth / curves.slices;
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const double y = heightOf(shares[i]);
            const double begin = double(curves.slicesPerColumn) * double(i);
            const double end = std::min(begin + curves.slicesPerColumn, double(curves.slices));
            // What goes on at the same height needs no point.
            if (!points.empty() && points.back().y == y) {
                points.pop_back();
            } else {
                points.push_back({left_ + pixelsPerSlice * begin, y});
            }
            points.push_back({left_ + pixelsPerSlice * end, y});
        }
        return points;
    }

    void paintArea(std::vector<glm::dvec2> upperEdge, const Rgb& color) {
        upperEdge.push_back({left_ + kPanelWidth, bottom_});
        upperEdge.push_back({left_, bottom_});
        drawing_.items.push_back(Area{std::move(upperEdge), color});
    }

    void paintCurves(const Curves& curves) {
        if (curves.visible.empty()) {
            return drawing_.items.push_back(label({left_ + 0.5 * kPanelWidth, bottom_ - 95},
                                                  "no active voxels", 13, Label::Anchor::kMiddle,
                                                  kGrey));
        }
        const std::vector<glm::dvec2> visible = edge(curves, curves.visible);
        paintArea(visible, kVisibleArea);
        const std::vector<glm::dvec2> changed = edge(curves, curves.changed);
        paintArea(changed, kChangedArea);
        add(visible, kVisibleLine, 1.25);
        // A single slice of thousands has no area to speak of, but its line is seen.
        add(changed, kChangedLine, 1);
    }

    // The axis at the bottom, with the slices' indices.
    void paintSlices(int axis) {
        add({{left_, bottom_}, {left_ + kPanelWidth, bottom_}}, kInk, 1);
        drawing_.items.push_back(label({left_ + 0.5 * kPanelWidth, bottom_ + 38},
                                       std::string("slice, index ") + "xyz"[axis], 12,
                                       Label::Anchor::kMiddle, kGrey));
        if (plot_.box.empty()) return;
        const double slices = curves_[axis].slices;
        const double step = std::max(1.0, niceStep(slices, 4));
        const std::int64_t first = plot_.box.min[axis];
        const auto begin = std::int64_t(std::ceil(double(first) / step));
        for (std::int64_t i = begin; double(i) * step <= double(plot_.box.max[axis]); ++i) {
            const double index = double(i) * step;
            const double x = left_ + kPanelWidth * (index - double(first) + 0.5) / slices;
            add({{x, bottom_}, {x, bottom_ + 4}}, kInk, 1);
            drawing_.items.push_back(
                label({x, bottom_ + 19}, numberText(index), 12, Label::Anchor::kMiddle, kGrey));
        }
    }

    Drawing& drawing_;
    glm::dvec2 corner_;
    const SlicePlot& plot_;
    std::array<Curves, 3> curves_;
    double step_ = 1;  // between two rules, as a share
    double top_ = 1;   // the share at a panel's upper edge
    double left_ = 0;  // of the panel being painted
    double bottom_ = 0;
};

}  // namespace

int slicesPerColumn(int sliceCount) {
    return sliceCount / kMaxColumns + (sliceCount % kMaxColumns != 0);
}

Drawing drawSlicePlots(const std::vector<SlicePlot>& plots) {
    Drawing drawing;
    drawing.size = {kWidth, kRowHeight * double(plots.size())};
    for (std::size_t i = 0; i < plots.size(); ++i) {
        RowPainter(drawing, {0, kRowHeight * double(i)}, plots[i]).paint();
    }
    return drawing;
}

}  // namespace deltasplat
