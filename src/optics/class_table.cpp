// SPDX-License-Identifier: Apache-2.0
// Based on: P. Sabella, A Rendering Algorithm for Visualizing 3D Scalar Fields, 1988 (absorption
// along a ray), with the opacity correction for the distance between slices of P. Lacroute, Fast
// Volume Rendering Using a Shear-Warp Factorization, 1995.
#include "deltasplat/optics/class_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <tuple>
#include <utility>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "number_text.h"
#include "optics/check_optics.h"
#include "optics/color_digits.h"
#include "optics/largest_alpha.h"
#include "parallel.h"
#include "portable_math.h"

namespace deltasplat {
namespace {

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

double unitDistancesIn(double stepWorld, const Volume& volume, const Optics& optics) {
    const double unitDistance = optics.unitDistance.value_or(smallest(volume.voxelSize()));
    return optics.extinctionScale * (stepWorld / unitDistance);
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

    ColorDigits operator()(const CodeLight& one) const {
        glm::dvec4 exact = premultiplied(one);
        for (int c = 0; c < 4; ++c)
            exact[c] = scale()[c] == 0 ? 0 : exact[c] / largest_[c] * ClassTable::kMax;
        // Of one colour, all channels are the opacity: equal, however division rounds.
        for (int c = 0; oneColor_ && c < 3; ++c) exact[c] = scale()[c] == 0 ? 0 : exact.a;
        const ColorDigits digits = digitsOf(exact);
        const auto isClear = [](const ClassTable::Color& color) { return color[3] == 0; };
        // What lets all light through shows nothing.
        return std::all_of(digits.begin(), digits.end(), isClear) ? ColorDigits{} : digits;
    }

  private:
    static glm::dvec4 premultiplied(const CodeLight& one) {
        return {one.alpha * one.color, one.alpha};
    }

    glm::dvec4 largest_{0.0};
    bool oneColor_;
};

// Returns what visible codes look like, in their order. A volume of floats may have tens of
// thousands.
std::vector<ColorDigits> roundColors(const std::vector<CodeLight>& visible,
                                     const ColorRounder& rounded) {
    std::vector<ColorDigits> digits(visible.size());
    parallelForChunks(visible.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) digits[i] = rounded(visible[i]);
    });
    return digits;
}

// Gives equal colours equal numbers, in the order in which they come. An open hash table at most
// half full: several times as fast as sorting.
class ColorNumbers {
  public:
    explicit ColorNumbers(std::size_t colors)
        : placeBits_(std::bit_width(2 * colors)), classAt_(std::size_t{1} << placeBits_) {}

    Slot numberOf(const ColorDigits& color) {
        if (isSame(color, {})) return kEmptySlot;
        std::size_t place = hashOf(color) >> (64 - placeBits_);
        while (classAt_[place] != 0 && !isSame(colors_[classAt_[place]], color)) {
            place = (place + 1) % classAt_.size();
        }
        if (classAt_[place] == 0) {
            if (colors_.size() == ClassTable::kMaxClasses) return ClassTable::kMaxClasses - 1;
            classAt_[place] = Slot(colors_.size());
            colors_.push_back(color);
        }
        return classAt_[place];
    }

    // [classes]: by number.
    std::vector<ColorDigits> take() { return std::move(colors_); }

  private:
    // As a call of the C library, comparing would take as long as all else.
    static bool isSame(const ColorDigits& a, const ColorDigits& b) {
        std::uint64_t differing = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            differing |= std::bit_cast<std::uint64_t>(a[i]) ^ std::bit_cast<std::uint64_t>(b[i]);
        return differing == 0;
    }
    static std::uint64_t hashOf(const ColorDigits& color) {
        constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio (D. Knuth)
        std::uint64_t hash = 0;
        for (const ClassTable::Color& digit : color) {
            const auto bits = std::bit_cast<std::uint64_t>(digit);
            if (bits != 0) hash = (hash ^ hash >> 32 ^ bits) * kSpread;
        }
        return hash;
    }

    int placeBits_;
    std::vector<Slot> classAt_;  // 0 where nothing is
    std::vector<ColorDigits> colors_{ColorDigits{}};
};

// Of one colour, the opacity says all.
void numberByOpacity(const std::vector<CodeLight>& visible, const std::vector<ColorDigits>& digits,
                     ClassTable& table) {
    std::vector<ClassTable::Color>& colors = table.planes.front().high.colors;
    colors.resize(ClassTable::kMax + 1);
    for (int opacity = 0; opacity <= ClassTable::kMax; ++opacity) {
        for (int c = 0; c < 4; ++c) {
            colors[opacity][c] = std::int16_t(table.scale[c] == 0 ? 0 : opacity);
        }
    }
    for (std::size_t i = 0; i < visible.size(); ++i)
        table.classOfSlot[visible[i].code + 1] = digits[i][0][3];
}

// Orders classes so that those with the same digits lie together: by the first that is not zero,
// then by the last. Returns the new number of each.
std::vector<Slot> orderByDigits(std::vector<ColorDigits>& colors) {
    constexpr std::size_t kUses = 1 << std::tuple_size_v<ColorDigits>;
    std::array<unsigned, kUses> uses;
    std::iota(uses.begin(), uses.end(), 0u);
    std::sort(uses.begin(), uses.end(), [](unsigned a, unsigned b) {
        const auto keyOf = [](unsigned use) {
            return use == 0 ? std::pair(-1, 0)
                            : std::pair(std::countr_zero(use), int(std::bit_width(use)));
        };
        return std::pair(keyOf(a), a) < std::pair(keyOf(b), b);
    });
    std::vector<std::uint8_t> useOf;
    std::array<bool, kUses> occurs{};
    for (const ColorDigits& color : colors) {
        useOf.push_back(std::uint8_t(usedDigits(color)));
        occurs[useOf.back()] = true;
    }
    std::vector<Slot> numbers(colors.size());
    std::vector<ColorDigits> ordered;
    ordered.reserve(colors.size());
    for (const unsigned use : uses) {
        for (std::size_t i = 0; occurs[use] && i < colors.size(); ++i) {
            if (useOf[i] != use) continue;
            numbers[i] = Slot(ordered.size());
            ordered.push_back(colors[i]);
        }
    }
    colors = std::move(ordered);
    return numbers;
}

// Takes a digit of all classes. None are kept if all are zero, unless they must be.
void takeDigit(const std::vector<ColorDigits>& colors, std::size_t i, bool always,
               ClassTable::Digit& digit) {
    digit.colors.clear();
    for (const ColorDigits& color : colors) digit.colors.push_back(color[i]);
    const auto isUsed = [](const ClassTable::Color& color) { return color != ClassTable::Color{}; };
    const auto& all = digit.colors;
    const auto first = std::find_if(all.begin(), all.end(), isUsed);
    if (first == all.end()) {
        if (!always) digit.colors.clear();
        return;
    }
    digit.first = int(first - all.begin());
    digit.last = int(std::find_if(all.rbegin(), all.rend(), isUsed).base() - all.begin());
}

void numberByColor(const std::vector<CodeLight>& visible, const std::vector<ColorDigits>& digits,
                   ClassTable& table) {
    ColorNumbers numbers(visible.size());
    for (std::size_t i = 0; i < visible.size(); ++i)
        table.classOfSlot[visible[i].code + 1] = numbers.numberOf(digits[i]);
    std::vector<ColorDigits> colors = numbers.take();
    const std::vector<Slot> numberOf = orderByDigits(colors);
    for (const CodeLight& one : visible) {
        Slot& number = table.classOfSlot[one.code + 1];
        number = numberOf[std::size_t(number)];
    }
    for (std::size_t p = 0; p < table.planes.size(); ++p) {
        takeDigit(colors, 2 * p, true, table.planes[p].high);
        takeDigit(colors, 2 * p + 1, false, table.planes[p].low);
    }
}

// Returns which digits any code has.
unsigned digitsInUse(const std::vector<ColorDigits>& digits) {
    unsigned used = 0;
    for (const ColorDigits& one : digits) used |= usedDigits(one);
    return used;
}

glm::dvec4 unitsOfDigit(const ClassTable::Digit& digit, Slot number) {
    if (digit.colors.empty()) return glm::dvec4(0);
    const ClassTable::Color& color = digit.colors[std::size_t(number)];
    return {color[0], color[1], color[2], color[3]};
}

}  // namespace

glm::dvec4 ClassTable::scaleOf(int plane) const {
    return scale * std::ldexp(1.0, -kPlaneBits * plane);
}

glm::dvec4 ClassTable::unitsOf(Slot number) const {
    constexpr double kLow = 1.0 / (1 << kDigitBits);
    constexpr double kFiner = 1.0 / (1 << kPlaneBits);
    glm::dvec4 units(0.0);
    double scaleOfPlane = 1;
    for (const Plane& plane : planes) {
        units += scaleOfPlane *
                 (unitsOfDigit(plane.high, number) + kLow * unitsOfDigit(plane.low, number));
        scaleOfPlane *= kFiner;
    }
    return units;
}

glm::dvec4 ClassTable::lightOfCode(Code code) const {
    return unitsOf(classOfSlot[code + 1]) * scale;
}

ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld) {
    const DefaultFloats floats;
    checkOptics(optics);
    const std::vector<CodeLight> visible =
        classifyExactly(volume, optics, unitDistancesIn(sliceStepWorld, volume, optics));
    const ColorRounder rounded(visible);
    const std::vector<ColorDigits> digits = roundColors(visible, rounded);
    ClassTable table;
    table.scale = rounded.scale();
    table.oneColor = rounded.oneColor();
    table.classOfSlot.assign(kSlotCount, kEmptySlot);
    const unsigned used = digitsInUse(digits);
    table.planes.resize(used < 4 ? 1 : 2);
    if (table.oneColor && used < 2) {
        numberByOpacity(visible, digits, table);
    } else {
        numberByColor(visible, digits, table);
    }
    return table;
}

double largestAlpha(const Volume& volume, const Optics& optics) {
    const DefaultFloats floats;
    checkOptics(optics);
    double opacity = 0;
    for (const TransferFunction::OpacityPoint& point : optics.transferFunction.opacities)
        opacity = std::max(opacity, point.opacity);
    return alphaOf(opacity, unitDistancesIn(smallest(volume.voxelSize()), volume, optics));
}

}  // namespace deltasplat
