// SPDX-License-Identifier: Apache-2.0
#include "annotate/annotate.h"

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <utility>

#include "annotate/axes.h"
#include "annotate/scale_bar.h"
#include "annotate/text_lines.h"
#include "image/srgb.h"

namespace deltasplat {
namespace {

// What has found room in a picture so far.
class Corners {
  public:
    Corners(const AnnotationStyle& style, const Listener& listener)
        : style_(style), listener_(listener) {}

    // What comes first keeps its place.
    bool add(Annotation annotation) {
        const DrawnBox picture{glm::dvec2(0), style_.picture};
        const bool fits =
            picture.contains(annotation.box) &&
            std::none_of(placed_.begin(), placed_.end(), [&](const Annotation& other) {
                return other.box.overlaps(annotation.box);
            });
        if (fits) {
            placed_.push_back(std::move(annotation));
        } else {
            listener_.warn(annotation.option + ": has no room in a picture of " +
                           std::to_string(int(style_.picture.x)) + "x" +
                           std::to_string(int(style_.picture.y)) + " pixels, and is left out");
        }
        return fits;
    }

    std::vector<Annotation> placed() && { return std::move(placed_); }
    double leftOfAll() const {
        double left = style_.picture.x;
        for (const Annotation& annotation : placed_) left = std::min(left, annotation.box.min.x);
        return left;
    }

  private:
    const AnnotationStyle& style_;
    const Listener& listener_;
    std::vector<Annotation> placed_;
};

}  // namespace

std::vector<Annotation> layOut(const AnnotationChoice& choice, const Camera& camera,
                               const std::string& space, const std::string& unit,
                               const std::optional<Legend>& legend, const InkColors& colors,
                               const Listener& listener) {
    const AnnotationStyle style(camera.sizePixels, colors);
    Corners corners(style, listener);
    if (choice.legend && legend) corners.add(drawLegend(*legend, style));
    if (!choice.lines.empty()) {
        bool cut = false;
        const double width = corners.leftOfAll() - 2 * style.margin;
        if (corners.add(drawTextLines(choice.lines, style, width, cut)) && cut)
            listener.warn("--annotate: text is shortened to what the picture has room for");
    }
    if (choice.scaleBar) corners.add(drawScaleBar(scaleBarOf(camera, unit), style));
    if (choice.axes) corners.add(drawAxes(seenAxes(camera, space), style));
    return std::move(corners).placed();
}

const InkColors& inkFor(const Image& image) {
    // Light as it is seen, of about a tenth of the picture on each side.
    const glm::ivec2 border = image.size / 10 + 1;
    double sum = 0;
    std::int64_t count = 0;
    for (int y = 0; y < image.size.y; ++y) {
        for (int x = 0; x < image.size.x; ++x) {
            const bool inside = x >= border.x && x < image.size.x - border.x && y >= border.y &&
                                y < image.size.y - border.y;
            if (inside) continue;
            const float* const rgba = image.pixel(x, y);
            sum +=
                std::clamp(glm::dot(glm::dvec3(rgba[0], rgba[1], rgba[2]), kLuminance), 0.0, 1.0);
            ++count;
        }
    }
    // Half of the way from black to white, as eyes have it.
    constexpr double kMiddle = 0.2;
    return sum > kMiddle * double(count) ? kInkOnLight : kInkOnDark;
}

void annotate(const std::vector<Annotation>& annotations, Image& image) {
    for (const Annotation& annotation : annotations) drawOver(image, annotation.shapes);
}

}  // namespace deltasplat
