// SPDX-License-Identifier: Apache-2.0
// Based on: P. Sabella, A Rendering Algorithm for Visualizing 3D Scalar Fields, 1988 (absorption
// along a ray), with the opacity correction for the distance between slices of P. Lacroute, Fast
// Volume Rendering Using a Shear-Warp Factorization, 1995.
#include "deltasplat/optics/class_table.h"
#include "volume/placement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "base/affine.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "base/uncleared.h"
#include "deltasplat/error.h"
#include "optics/check_optics.h"
#include "optics/color_curve.h"
#include "optics/color_digits.h"

namespace deltasplat {
namespace {

double extinctionOf(double opacity) {
    if (opacity <= 0) return 0;
    if (opacity >= 1) return std::numeric_limits<double>::infinity();
    return -portable::log1p(-opacity);
}

// Share of light absorbed between two slices.
double alphaOf(double extinction, double unitDistancesPerSlice) {
    if (extinction <= 0 || unitDistancesPerSlice <= 0) return 0;
    if (std::isinf(extinction)) return 1;
    return -portable::expm1(-extinction * unitDistancesPerSlice);
}

// Work on codes and classes is cut into runs; float volumes have tens of thousands of codes.
constexpr std::size_t kRun = 1024;

std::size_t runsOf(std::size_t count) {
    return (count + kRun - 1) / kRun;
}

// Calls body(run, begin, end) for runs that cover [0, count), on all threads.
template <typename Body>
void forRuns(std::size_t count, const Body& body) {
    parallelFor(runsOf(count),
                [&](std::size_t run) { body(run, run * kRun, std::min((run + 1) * kRun, count)); });
}

struct CodeLook {
    Code code;
    Look look;
};

std::vector<CodeLook> lookUpSurface(const Volume& volume, const Surface& surface) {
    const Look inside{std::numeric_limits<double>::infinity(), surface.color};
    const bool isBelow = isLevelSet(volume);
    std::vector<CodeLook> codes;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] == 0) continue;
        const double value = volume.codeBook().valueOf(Code(code));
        const bool isInside = isBelow ? value <= surface.isovalue : value >= surface.isovalue;
        if (isInside) codes.push_back({Code(code), inside});
    }
    return codes;
}

std::vector<CodeLook> lookUp(const Volume& volume, const Optics& optics) {
    if (optics.surface) return lookUpSurface(volume, *optics.surface);
    const TransferFunction& function = optics.transferFunction;
    const ColorCurve colors(function);
    const FunctionPlace placeOf(function, volume, optics.range);
    const double unitDistance = unitDistanceOf(volume, optics);
    std::vector<CodeLook> codes;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] != 0) codes.push_back({Code(code), {}});
    }
    forRuns(codes.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double value = volume.codeBook().valueOf(codes[i].code);
            const double x = placeOf(value);
            const double extinction =
                optics.densityScale ? std::max(value, 0.0) * *optics.densityScale * unitDistance
                                    : extinctionOf(function.opacityAt(x));
            codes[i].look = {extinction, colors.at(x)};
        }
    });
    std::erase_if(codes, [](const CodeLook& one) { return !(one.look.extinction > 0); });
    return codes;
}

// A look's light for one step, before rounding.
struct StepLight {
    double alpha;
    glm::dvec3 color;  // not multiplied by alpha
};
using StepLights = UnclearedVector<StepLight>;

template <typename LookOf>
StepLights lightOf(std::size_t count, const LookOf& lookOf, double unitDistances) {
    StepLights lights(count);
    forRuns(count, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            lights[i] = {alphaOf(lookOf(i).extinction, unitDistances), lookOf(i).color};
    });
    return lights;
}

// Light of one voxel behind another.
StepLight behind(const StepLight& front, const StepLight& back) {
    const double rest = (1 - front.alpha) * back.alpha;
    const double alpha = front.alpha + rest;
    // Equal colours stay exactly equal.
    if (!(rest > 0) || front.color == back.color) return {alpha, front.color};
    if (!(front.alpha > 0)) return {alpha, back.color};
    return {alpha, (front.alpha * front.color + rest * back.color) / alpha};
}

// All pairs, in the order of ClassTable::pairs.
StepLights lightOfPairs(const StepLights& lights, SeenThrough seenThrough) {
    StepLights pairs;
    pairs.reserve(lights.size() * lights.size());
    for (const StepLight& first : lights)
        for (const StepLight& second : lights)
            pairs.push_back(seenThrough == SeenThrough::kSecond ? behind(first, second)
                                                                : behind(second, first));
    return pairs;
}

// Rounds the colours of all visible codes with one scale per channel.
class ColorRounder {
  public:
    explicit ColorRounder(const StepLights& lights) {
        std::vector<Seen> runs(runsOf(lights.size()));
        forRuns(lights.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
            Seen seen;
            for (std::size_t i = begin; i < end; ++i) seen.add(lights[i]);
            runs[run] = seen;
        });
        Seen all;
        for (const Seen& run : runs) all.add(run);
        oneColor_ = all.first && all.oneColor;
        largest_ = all.largest;
        // A scale that underflows makes its channel 0.
        scale_ = largest_ / double(ClassTable::kMax);
    }

    bool oneColor() const { return oneColor_; }
    const glm::dvec4& scale() const { return scale_; }

    ColorDigits operator()(const StepLight& one) const {
        const glm::dvec4 light = premultiplied(one);
        const auto unitsOf = [&](int c) {
            return scale_[c] == 0 ? 0 : light[c] / largest_[c] * ClassTable::kMax;
        };
        glm::dvec4 exact(unitsOf(3));
        // With one colour, every channel equals the opacity, however division rounds.
        for (int c = 0; c < 3; ++c) {
            if (!oneColor_ || scale_[c] == 0) exact[c] = unitsOf(c);
        }
        const ColorDigits digits = digitsOf(exact);
        const auto isClear = [](const ClassTable::Color& color) { return color[3] == 0; };
        // A look that lets all light through shows nothing.
        return std::all_of(digits.begin(), digits.end(), isClear) ? ColorDigits{} : digits;
    }

  private:
    static glm::dvec4 premultiplied(const StepLight& one) {
        return {one.alpha * one.color, one.alpha};
    }

    // Summary of the lights that are not clear.
    struct Seen {
        const StepLight* first = nullptr;
        bool oneColor = true;
        glm::dvec4 largest{0.0};

        void add(const StepLight& one) {
            if (one.alpha > 0) add(one, true, premultiplied(one));
        }
        void add(const Seen& others) {
            if (others.first) add(*others.first, others.oneColor, others.largest);
        }

      private:
        void add(const StepLight& other, bool otherIsOneColor, const glm::dvec4& otherLargest) {
            if (!first) first = &other;
            oneColor = oneColor && otherIsOneColor && other.color == first->color;
            largest = glm::max(largest, otherLargest);
        }
    };

    glm::dvec4 largest_;
    glm::dvec4 scale_;
    bool oneColor_;
};

// Lights in digits, in the order of the input, and the union of the used digits.
struct RoundedLights {
    UnclearedVector<ColorDigits> digits;
    unsigned used = 0;
};

RoundedLights roundColors(const StepLights& lights, const ColorRounder& rounder) {
    RoundedLights rounded{UnclearedVector<ColorDigits>(lights.size())};
    std::vector<unsigned> used(runsOf(lights.size()));
    forRuns(lights.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
        unsigned ofRun = 0;
        for (std::size_t i = begin; i < end; ++i) {
            rounded.digits[i] = rounder(lights[i]);
            ofRun |= usedDigits(rounded.digits[i]);
        }
        used[run] = ofRun;
    });
    for (const unsigned ofRun : used) rounded.used |= ofRun;
    return rounded;
}

// Whether opacity rises or falls strictly between different looks, so equal looks are neighbours.
bool areInOrder(const std::vector<CodeLook>& codes) {
    bool rising = true;
    bool falling = true;
    for (std::size_t i = 1; i < codes.size(); ++i) {
        const Look& before = codes[i - 1].look;
        const Look& look = codes[i].look;
        const bool same = look == before;
        rising = rising && (same || look.extinction > before.extinction);
        falling = falling && (same || look.extinction < before.extinction);
    }
    return rising || falling;
}

// Numbers different looks from 1 on, in order of first appearance. Unless looks are in order, uses
// an open hash table, at most half full: several times as fast as sorting.
class LookNumbers {
  public:
    // @param hasClear  whether kClearClass is among the numbers
    LookNumbers(const std::vector<CodeLook>& codes, bool hasClear)
        : inOrder_(areInOrder(codes)), looks_(hasClear ? 2 : 1) {
        looks_.reserve(codes.size() + looks_.size());
        if (inOrder_) return;
        placeBits_ = std::bit_width(2 * codes.size());
        numberAt_.resize(std::size_t{1} << placeBits_);
    }

    Slot numberOf(const Look& look) {
        if (looks_.size() > 1 && look == looks_.back()) return Slot(looks_.size() - 1);
        if (inOrder_) return add(look);
        std::size_t place = hashOf(look) >> (64 - placeBits_);
        while (numberAt_[place] != 0 && !(looks_[std::size_t(numberAt_[place])] == look))
            place = (place + 1) % numberAt_.size();
        if (numberAt_[place] == 0) numberAt_[place] = add(look);
        return numberAt_[place];
    }

    // [numbers]: entry 0 is for invisible codes.
    std::vector<Look> take() { return std::move(looks_); }

  private:
    Slot add(const Look& look) {
        if (looks_.size() == ClassTable::kMaxClasses) return ClassTable::kMaxClasses - 1;
        looks_.push_back(look);
        return Slot(looks_.size() - 1);
    }
    static std::uint64_t hashOf(const Look& look) {
        constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio (D. Knuth)
        std::uint64_t hash = 0;
        // Adding 0 turns -0 into 0.
        for (const double part : {look.extinction, look.color.x, look.color.y, look.color.z})
            hash = (hash ^ hash >> 32 ^ std::bit_cast<std::uint64_t>(part + 0.0)) * kSpread;
        return hash;
    }

    bool inOrder_;
    int placeBits_ = 0;
    std::vector<Slot> numberAt_;  // 0: free
    std::vector<Look> looks_;
};

// Orders classes by their first nonzero digit, then by the last, so that classes with the same
// digits are neighbours; classes without digits come first. Returns each class' new number.
std::vector<Slot> orderByDigits(std::vector<ColorDigits>& colors, std::vector<Look>& looks) {
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
    std::array<std::size_t, kUses> placeOf;
    for (std::size_t i = 0; i < uses.size(); ++i) placeOf[uses[i]] = i;
    std::vector<std::uint8_t> useOf;
    useOf.reserve(colors.size());
    std::array<bool, kUses> occurs{};
    bool ordered = true;
    for (const ColorDigits& color : colors) {
        const unsigned use = usedDigits(color);
        ordered = ordered && (useOf.empty() || placeOf[useOf.back()] <= placeOf[use]);
        useOf.push_back(std::uint8_t(use));
        occurs[use] = true;
    }
    std::vector<Slot> numbers(colors.size());
    std::iota(numbers.begin(), numbers.end(), Slot{0});
    if (ordered) return numbers;
    std::vector<ColorDigits> newColors;
    std::vector<Look> newLooks;
    newColors.reserve(colors.size());
    newLooks.reserve(colors.size());
    for (const unsigned use : uses) {
        for (std::size_t i = 0; occurs[use] && i < colors.size(); ++i) {
            if (useOf[i] != use) continue;
            numbers[i] = Slot(newColors.size());
            newColors.push_back(colors[i]);
            newLooks.push_back(looks[i]);
        }
    }
    colors = std::move(newColors);
    looks = std::move(newLooks);
    return numbers;
}

// Takes a digit of all classes; drops it if it is zero everywhere, unless `always`.
void takeDigit(std::span<const ColorDigits> colors, std::size_t i, bool always,
               ClassTable::Digit& digit) {
    digit.colors.resize(colors.size());
    for (std::size_t n = 0; n < colors.size(); ++n) digit.colors[n] = colors[n][i];
    if (!noteUse(digit) && !always) digit.colors.clear();
}

void takeDigits(std::span<const ColorDigits> colors, ClassTable& table) {
    parallelFor(2 * table.planes.size(), [&](std::size_t i) {
        ClassTable::Plane& plane = table.planes[i / 2];
        takeDigit(colors, i, i % 2 == 0, i % 2 == 0 ? plane.high : plane.low);
    });
}

std::size_t planesOf(unsigned used) {
    return used < 4 ? 1 : 2;
}

// @param digits    of the visible codes
// @param hasClear  whether kClearClass is among the classes
void numberByLook(const std::vector<CodeLook>& visible, std::span<const ColorDigits> digits,
                  bool hasClear, ClassTable& table) {
    LookNumbers numbers(visible, hasClear);
    std::vector<Slot> classOfSlot(kSlotCount, kEmptySlot);
    std::vector<ColorDigits> colors(hasClear ? 2 : 1);
    colors.reserve(visible.size() + colors.size());
    for (std::size_t i = 0; i < visible.size(); ++i) {
        if (usedDigits(digits[i]) == 0) continue;
        const Slot number = numbers.numberOf(visible[i].look);
        classOfSlot[visible[i].code + 1] = number;
        if (std::size_t(number) == colors.size()) colors.push_back(digits[i]);
    }
    table.looks = numbers.take();
    const std::vector<Slot> numberOf = orderByDigits(colors, table.looks);
    for (const CodeLook& one : visible) {
        Slot& number = classOfSlot[one.code + 1];
        number = numberOf[std::size_t(number)];
    }
    table.slots = std::make_shared<const std::vector<Slot>>(std::move(classOfSlot));
    takeDigits(colors, table);
}

}  // namespace

glm::dvec4 ClassTable::scaleOf(int plane) const {
    return scale * std::ldexp(1.0, -kPlaneBits * plane);
}

glm::dvec4 ClassTable::unitsOf(Slot number) const {
    ColorDigits digits{};
    for (std::size_t p = 0; p < planes.size(); ++p) {
        digits[2 * p] = planes[p].high.colors[std::size_t(number)];
        if (!planes[p].low.colors.empty())
            digits[2 * p + 1] = planes[p].low.colors[std::size_t(number)];
    }
    return deltasplat::unitsOf(digits);
}

std::vector<double> ClassTable::alphas() const {
    std::vector<double> alphas;
    const double unitDistances = extinctionScale * (stepWorld / unitDistanceWorld);
    for (const Look& look : looks) alphas.push_back(alphaOf(look.extinction, unitDistances));
    return alphas;
}

glm::dvec4 ClassTable::lightOfCode(Code code) const {
    return unitsOf(classOfSlot()[code + 1]) * scale;
}

ClassTable ClassTable::atSteps(double steps) const {
    const DefaultFloats floats;
    ClassTable table;
    table.slots = slots;
    table.pairs = pairs;
    table.unitDistanceWorld = unitDistanceWorld;
    table.extinctionScale = extinctionScale;
    table.stepWorld = stepWorld * steps;
    table.oneColor = oneColor;
    StepLights lights = lightOf(
        looks.size(), [&](std::size_t i) { return looks[i]; },
        extinctionScale * (table.stepWorld / unitDistanceWorld));
    if (pairs) lights = lightOfPairs(lights, *pairs);
    const ColorRounder rounder(lights);
    const RoundedLights rounded = roundColors(lights, rounder);
    table.scale = rounder.scale();
    table.planes.resize(planesOf(rounded.used));
    parallelFor(2, [&](std::size_t part) {
        if (part == 0) {
            table.looks = looks;
        } else {
            takeDigits(rounded.digits, table);
        }
    });
    return table;
}

ClassTable classify(const Volume& volume, const Optics& optics, double sliceStepWorld) {
    const DefaultFloats floats;
    checkOptics(optics);
    const std::vector<CodeLook> visible = lookUp(volume, optics);
    ClassTable table;
    table.unitDistanceWorld = unitDistanceOf(volume, optics);
    table.extinctionScale = optics.extinctionScale;
    table.stepWorld = sliceStepWorld;
    const StepLights lights = lightOf(
        visible.size(), [&](std::size_t i) { return visible[i].look; },
        table.extinctionScale * (sliceStepWorld / table.unitDistanceWorld));
    const ColorRounder rounder(lights);
    const RoundedLights rounded = roundColors(lights, rounder);
    table.scale = rounder.scale();
    table.oneColor = rounder.oneColor();
    table.planes.resize(planesOf(rounded.used));
    numberByLook(visible, rounded.digits, !optics.parts.empty(), table);
    return table;
}

double largestAlpha(const Volume& volume, const Optics& optics) {
    const DefaultFloats floats;
    checkOptics(optics);
    const double unitDistance = unitDistanceOf(volume, optics);
    double opacity = 0;
    for (const TransferFunction::OpacityPoint& point : optics.transferFunction.opacities)
        opacity = std::max(opacity, point.opacity);
    const double extinction = optics.densityScale
                                  ? volume.valueMax() * *optics.densityScale * unitDistance
                                  : extinctionOf(opacity);
    return alphaOf(extinction, optics.extinctionScale * (smallestSize(volume) / unitDistance));
}

}  // namespace deltasplat
