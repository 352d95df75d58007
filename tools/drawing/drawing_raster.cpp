// SPDX-License-Identifier: Apache-2.0
// Every shape becomes a mask of how much of each pixel it covers, which is laid over the picture
// once: where a shape's own parts meet, nothing shows through and nothing is laid on twice.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "base/memory.h"
#include "drawing/drawing.h"
#include "drawing/stroke_font.h"
#include "image/srgb.h"

namespace deltasplat {
namespace {

// How much of each pixel of a part of the picture is covered, 0..1.
class Mask {
  public:
    // Holds the pixels from `low` to `high`, as far as the picture has them.
    Mask(glm::dvec2 low, glm::dvec2 high, glm::ivec2 picture)
        : first_(clamped(glm::floor(low), picture)), end_(clamped(glm::ceil(high), picture)) {
        coverage_.assign(std::size_t(width()) * (end_.y - first_.y), 0.0F);
    }

    glm::ivec2 first() const { return first_; }
    glm::ivec2 end() const { return end_; }
    float& at(int x, int y) {
        return coverage_[std::size_t(y - first_.y) * width() + (x - first_.x)];
    }

  private:
    int width() const { return end_.x - first_.x; }
    static glm::ivec2 clamped(const glm::dvec2& p, glm::ivec2 picture) {
        return {int(std::clamp(p.x, 0.0, double(picture.x))),
                int(std::clamp(p.y, 0.0, double(picture.y)))};
    }

    glm::ivec2 first_;
    glm::ivec2 end_;
    std::vector<float> coverage_;
};

using Points = std::vector<glm::dvec2>;

// The corners of the box around points, `margin` wider.
std::pair<glm::dvec2, glm::dvec2> boxAround(const Points& points, double margin) {
    glm::dvec2 low = points.front();
    glm::dvec2 high = low;
    for (const glm::dvec2& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {low - margin, high + margin};
}

// Where a polygon's edges cross the height y, from left to right.
std::vector<double> crossings(const Points& points, double y) {
    std::vector<double> xs;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec2& a = points[i];
        const glm::dvec2& b = points[(i + 1) % points.size()];
        if ((a.y <= y) == (b.y <= y)) continue;
        xs.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
    std::sort(xs.begin(), xs.end());
    return xs;
}

// Adds `weight` times the part of each pixel of a row that lies between two places.
void addSpan(Mask& mask, int y, double from, double to, double weight) {
    from = std::max(from, double(mask.first().x));
    to = std::min(to, double(mask.end().x));
    for (int x = int(from); x < to; ++x) {
        const double part = std::min(to, x + 1.0) - std::max(from, double(x));
        mask.at(x, y) += float(weight * part);
    }
}

void fill(Mask& mask, const Points& points) {
    // Exact along a row; a row counts as so many lines.
    constexpr int kLines = 16;
    for (int y = mask.first().y; y < mask.end().y; ++y) {
        for (int i = 0; i < kLines; ++i) {
            const std::vector<double> xs = crossings(points, y + (i + 0.5) / kLines);
            for (std::size_t k = 0; k + 1 < xs.size(); k += 2) {
                addSpan(mask, y, xs[k], xs[k + 1], 1.0 / kLines);
            }
        }
    }
}

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 along = b - a;
    const double square = glm::dot(along, along);
    const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0;
    return glm::length(p - a - t * along);
}

void strokeSegment(Mask& mask, const glm::dvec2& a, const glm::dvec2& b, double width) {
    const double reach = 0.5 * width + 0.5;
    const Points ends = {a, b};
    const auto [low, high] = boxAround(ends, reach);
    for (int y = std::max(mask.first().y, int(low.y)); y < std::min(double(mask.end().y), high.y);
         ++y) {
        for (int x = std::max(mask.first().x, int(low.x));
             x < std::min(double(mask.end().x), high.x); ++x) {
            const double distance = distanceToSegment({x + 0.5, y + 0.5}, a, b);
            const double covered = std::clamp(reach - distance, 0.0, std::min(width, 1.0));
            mask.at(x, y) = std::max(mask.at(x, y), float(covered));
        }
    }
}

void stroke(Mask& mask, const Points& points, double width) {
    if (points.size() == 1) strokeSegment(mask, points[0], points[0], width);
    for (std::size_t i = 1; i < points.size(); ++i) {
        strokeSegment(mask, points[i - 1], points[i], width);
    }
}

class Painter {
  public:
    Painter(Image& image, double scale) : image_(image), scale_(scale) {}

    void operator()(const Area& area) {
        if (area.points.empty()) return;
        const Points points = scaled(area.points);
        Mask mask = maskAround(points, 0);
        fill(mask, points);
        paint(mask, area.color, area.opacity);
    }

    void operator()(const Line& line) {
        if (line.points.empty()) return;
        const Points points = scaled(line.points);
        Mask mask = maskAround(points, line.width * scale_ + 1);
        stroke(mask, points, line.width * scale_);
        paint(mask, line.color, 1);
    }

    void operator()(const Label& label) {
        const TextStrokes text = strokesOf(label.text);
        const double before = label.anchor == Label::Anchor::kStart    ? 0
                              : label.anchor == Label::Anchor::kMiddle ? 0.5 * text.width
                                                                       : text.width;
        const double penWidth = label.size * (label.bold ? 0.12 : 0.085);
        for (const Points& points : text.strokes) {
            Line line{{}, label.color, penWidth};
            for (glm::dvec2 p : points) {
                p = label.size * (p - glm::dvec2(before, 0));
                line.points.push_back(label.at + (label.upwards ? glm::dvec2(p.y, -p.x) : p));
            }
            (*this)(line);
        }
    }

  private:
    Points scaled(Points points) const {
        for (glm::dvec2& p : points) p *= scale_;
        return points;
    }

    Mask maskAround(const Points& points, double margin) const {
        const auto [low, high] = boxAround(points, margin);
        return {low, high, image_.size};
    }

    void paint(Mask& mask, const Rgb& color, double opacity) {
        const glm::dvec3 linear(linearFromSrgb(color.r / 255.0), linearFromSrgb(color.g / 255.0),
                                linearFromSrgb(color.b / 255.0));
        for (int y = mask.first().y; y < mask.end().y; ++y) {
            for (int x = mask.first().x; x < mask.end().x; ++x) {
                const auto share = float(opacity * std::min(mask.at(x, y), 1.0F));
                float* const rgba = image_.pixel(x, y);
                for (int c = 0; c < 3; ++c) rgba[c] += share * (float(linear[c]) - rgba[c]);
                rgba[3] += share * (1 - rgba[3]);
            }
        }
    }

    Image& image_;
    double scale_;
};

}  // namespace

Image rasterize(const Drawing& drawing, double scale) {
    const glm::dvec2 size = glm::ceil(scale * drawing.size);
    requireMemory("plot", 4 * sizeof(float) * size.x * size.y);
    Image image{glm::ivec2(size)};
    std::fill(image.rgba.begin(), image.rgba.end(), 1.0F);
    drawOver(image, drawing.items, scale);
    return image;
}

void drawOver(Image& image, const std::vector<Shape>& shapes, double scale) {
    Painter painter(image, scale);
    for (const Shape& shape : shapes) std::visit(painter, shape);
}

}  // namespace deltasplat
