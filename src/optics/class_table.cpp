// SPDX-License-Identifier: Apache-2.0
// Based on: P. Sabella, A Rendering Algorithm for Visualizing 3D Scalar Fields, 1988 (absorption
// along a ray), with the opacity correction for the distance between slices of P. Lacroute, Fast
// Volume Rendering Using a Shear-Warp Factorization, 1995.
#include "deltasplat/optics/class_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "number_text.h"
#include "parallel.h"
#include "portable_math.h"

namespace deltasplat {
namespace {

void requireThat(bool holds, const char* flag, const std::string& got, const char* expected) {
    if (!holds) throw Error(ErrorCode::kUsage, gotExpected(flag, got, expected));
}

void checkOptics(const Optics& optics) {
    if (optics.unitDistance) {
        const double unit = *optics.unitDistance;
        requireThat(std::isfinite(unit) && unit > 0, "--unit-distance", numberText(unit),
                    "a number > 0");
    }
    const double extinction = optics.extinctionScale;
    requireThat(std::isfinite(extinction) && extinction >= 0, "--extinction",
                numberText(extinction), "a number >= 0");
    if (optics.range) {
        const glm::dvec2 range = *optics.range;
        requireThat(std::isfinite(range.x) && std::isfinite(range.y) && range.x < range.y,
                    "--range", numberText(range), "LO,HI with LO < HI");
    }
}

double smallest(const glm::dvec3& v) {
    return std::min({v.x, v.y, v.z});
}

// The share of light taken away on the way from one slice to the next. Written without the
// extinction itself, so that opacity 1 (infinite extinction) and thin fog are both exact.
double alphaOf(double opacity, double unitDistancesPerSlice) {
    if (opacity <= 0 || unitDistancesPerSlice <= 0) return 0;
    if (opacity >= 1) return 1;
    return -portable::expm1(portable::log1p(-opacity) * unitDistancesPerSlice);
}

// A code's light for one slice, before it is rounded; that of codes that cannot be seen is 0.
struct CodeLight {
    Code code;
    double alpha;
    glm::dvec3 color;  // not multiplied by alpha
};

std::vector<CodeLight> classifyExactly(const Volume& volume, const Optics& optics,
                                       double unitDistancesPerSlice) {
    const TransferFunction& function = optics.transferFunction;
    const glm::dvec2 range =
        function.normalized ? optics.range.value_or(defaultRange(volume)) : glm::dvec2(0, 1);
    std::vector<CodeLight> codes;
    for (std::size_t code = 0; code < volume.histogram.size(); ++code) {
        if (volume.histogram[code] != 0) codes.push_back({Code(code), 0, {}});
    }
    // A volume of floats may have tens of thousands.
    constexpr std::size_t kRun = 4096;
    parallelFor((codes.size() + kRun - 1) / kRun, [&](std::size_t run) {
        const std::size_t end = std::min((run + 1) * kRun, codes.size());
        for (std::size_t i = run * kRun; i < end; ++i) {
            const double value = volume.codeBook.valueOf(codes[i].code);
            const double x = function.normalized
                                 ? (0.5 * value - 0.5 * range.x) / (0.5 * range.y - 0.5 * range.x)
                                 : value;
            codes[i].alpha = alphaOf(function.opacityAt(x), unitDistancesPerSlice);
            codes[i].color = function.colorAt(x);
        }
    });
    std::erase_if(codes, [](const CodeLight& one) { return !(one.alpha > 0); });
    return codes;
}

// Rounds the colours of all visible codes with one scale a channel.
class ColorRounder {
  public:
    explicit ColorRounder(const std::vector<CodeLight>& visible) {
        oneColor_ = !visible.empty();
        for (const CodeLight& one : visible) {
            largest_ = glm::max(largest_, premultiplied(one));
            oneColor_ = oneColor_ && one.color == visible.front().color;
        }
    }

    bool oneColor() const { return oneColor_; }
    // What is too small for a scale is nothing.
    glm::dvec4 scale() const { return largest_ / double(ClassTable::kMax); }

    ClassTable::Color operator()(const CodeLight& one) const {
        const glm::dvec4 exact = premultiplied(one);
        const auto rounded = [&](int c) {
            if (scale()[c] == 0) return std::int16_t{0};
            return std::int16_t(std::lround(exact[c] / largest_[c] * ClassTable::kMax));
        };
        ClassTable::Color color{};
        color[3] = rounded(3);
        for (int c = 0; c < 3; ++c) {
            // Of one colour, all channels are the opacity: equal, however division rounds.
            if (scale()[c] != 0) color[c] = oneColor_ ? color[3] : rounded(c);
        }
        // What lets all light through shows nothing.
        return color[3] == 0 ? ClassTable::Color{} : color;
    }

  private:
    static glm::dvec4 premultiplied(const CodeLight& one) {
        return {one.alpha * one.color, one.alpha};
    }

    glm::dvec4 largest_{0.0};
    bool oneColor_;
};

// Gives equal colours equal numbers, in the order in which they come. An open hash table at most
// half full: several times as fast as sorting.
class ColorNumbers {
  public:
    explicit ColorNumbers(std::size_t colors)
        : placeBits_(std::bit_width(2 * colors)), classAt_(std::size_t{1} << placeBits_) {}

    Slot numberOf(const ClassTable::Color& color, std::vector<ClassTable::Color>& colors) {
        constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio (D. Knuth)
        if (color == ClassTable::Color{}) return kEmptySlot;
        const auto key = std::bit_cast<std::uint64_t>(color);
        std::size_t place = key * kSpread >> (64 - placeBits_);
        while (classAt_[place] != 0 && colors[classAt_[place]] != color) {
            place = (place + 1) % classAt_.size();
        }
        if (classAt_[place] == 0) {
            if (colors.size() == ClassTable::kMaxClasses) return ClassTable::kMaxClasses - 1;
            classAt_[place] = Slot(colors.size());
            colors.push_back(color);
        }
        return classAt_[place];
    }

  private:
    int placeBits_;
    std::vector<Slot> classAt_;  // 0 where nothing is
};

// Of one colour, the opacity says all.
void numberByOpacity(const std::vector<CodeLight>& visible, const ColorRounder& rounded,
                     ClassTable& table) {
    table.colors.resize(ClassTable::kMax + 1);
    for (int opacity = 0; opacity <= ClassTable::kMax; ++opacity) {
        for (int c = 0; c < 4; ++c) {
            table.colors[opacity][c] = std::int16_t(table.scale[c] == 0 ? 0 : opacity);
        }
    }
    for (const CodeLight& one : visible) table.classOfSlot[one.code + 1] = rounded(one)[3];
}

}  // namespace

ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld) {
    const DefaultFloats floats;
    checkOptics(optics);
    const double unitDistance = optics.unitDistance.value_or(smallest(volume.voxelSize()));
    const std::vector<CodeLight> visible =
        classifyExactly(volume, optics, optics.extinctionScale * (sliceStepWorld / unitDistance));
    const ColorRounder rounded(visible);
    ClassTable table;
    table.scale = rounded.scale();
    table.oneColor = rounded.oneColor();
    table.classOfSlot.assign(kSlotCount, kEmptySlot);
    if (table.oneColor) {
        numberByOpacity(visible, rounded, table);
    } else {
        ColorNumbers numbers(visible.size());
        for (const CodeLight& one : visible) {
            table.classOfSlot[one.code + 1] = numbers.numberOf(rounded(one), table.colors);
        }
    }
    return table;
}

}  // namespace deltasplat
