// SPDX-License-Identifier: Apache-2.0
// Based on: VTK's documentation and behaviour of vtkPiecewiseFunction (midpoint and sharpness of an
// opacity point).
#include "optics/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/value_statistics.h"
#include "deltasplat/optics/default_ramp.h"
#include "deltasplat/optics/transfer_function.h"
#include "deltasplat/optics/transfer_function_names.h"
#include "optics/color_curve.h"
#include "optics/located_json.h"
#include "volume/code_counts.h"

namespace deltasplat {

namespace {

// Returns the first point beyond x. The point before it is thus the last one at or before x.
template <typename Point>
typename std::vector<Point>::const_iterator firstBeyond(const std::vector<Point>& points,
                                                        double x) {
    return std::upper_bound(points.begin(), points.end(), x,
                            [](double value, const Point& point) { return value < point.x; });
}

// Bends the way from one point to the next so that its middle is reached at `midpoint`.
double bendToMidpoint(double s, double midpoint) {
    const double m = std::clamp(midpoint, 1e-5, 1 - 1e-5);
    return s < m ? 0.5 * s / m : 0.5 + 0.5 * (s - m) / (1 - m);
}

// Blends with a cubic whose ends get flatter and whose middle gets steeper with sharpness.
double sharpBlend(double from, double to, double s, double sharpness) {
    const double power = 1 + 10 * sharpness;
    const double t =
        s < 0.5 ? 0.5 * portable::pow(2 * s, power) : 1 - 0.5 * portable::pow(2 * (1 - s), power);
    const double rise = t * t * (3 - 2 * t);
    const double slopes = t * (t - 1) * (2 * t - 1);
    const double value = from + (to - from) * (rise + (1 - sharpness) * slopes);
    return std::clamp(value, std::min(from, to), std::max(from, to));
}

// Frequency of each code in the uncut volume, counted once because a cut volume takes a walk.
using Counts = std::vector<std::uint64_t>;

// As bulkRange.
glm::dvec2 bulkOf(const Volume& volume, Counts counts) {
    for (std::size_t code = 0; code < counts.size(); ++code) {
        if (volume.codeBook().standsFor(Code(code), volume.background())) counts[code] = 0;
    }
    if (std::all_of(counts.begin(), counts.end(), [](std::uint64_t count) { return count == 0; }))
        return {volume.background(), volume.background() + 1};
    return {volume.codeBook().valueOf(percentileCode(counts, 1)),
            volume.codeBook().valueOf(percentileCode(counts, 99))};
}

// As rampRange.
glm::dvec2 rampOf(const Volume& volume, const Counts& counts) {
    glm::dvec2 range = bulkOf(volume, counts);
    if (isFog(volume) && volume.background() < range.y) range.x = volume.background();
    return range;
}

// Whether the fullest of 17 equal cells is the one with 0 in its middle.
bool mostAreNearZero(const Volume& volume, const glm::dvec2& ends, const Counts& counts) {
    constexpr int kCells = 8;
    const auto cellOf = [&](double value) {
        return kCells + int(std::round(kCells * (value / (ends.y - ends.x))));
    };
    std::vector<std::uint64_t> cells(2 * kCells + 1);
    for (std::size_t code = 0; code < counts.size(); ++code) {
        const double value = counts[code] == 0 ? ends.y : volume.codeBook().valueOf(Code(code));
        if (counts[code] != 0 && value >= ends.x && value <= ends.y)
            cells[cellOf(value)] += counts[code];
    }
    return std::max_element(cells.begin(), cells.end()) == cells.begin() + cellOf(0);
}

// Whether values lie on both sides of 0 and 0 means nothing, as in z maps or differences. A side
// below a tenth of the other does not count, because filters overshoot that far.
bool divergesFromZero(const Volume& volume, const glm::dvec2& bulk, const Counts& counts) {
    constexpr double kLeastSide = 0.1;
    const double least = kLeastSide * std::max(-bulk.x, bulk.y);
    if (!(-bulk.x >= least && bulk.y >= least && bulk.x < 0 && bulk.y > 0)) return false;
    const std::optional<double> background = guessBackground(volume);
    return background ? *background == 0 : mostAreNearZero(volume, bulk, counts);
}

// Clear at 0; the blue and red of the preset coolwarm at the end farther from 0, and its mirror.
TransferFunction divergingRamp(const glm::dvec2& range) {
    const double end = std::max(-range.x, range.y);
    TransferFunction ramp;
    ramp.name = "diverging ramp";
    ramp.colorSpace = ColorSpace::kDiverging;
    ramp.colors = {{-end, {0.230, 0.299, 0.754}}, {end, {0.706, 0.016, 0.150}}};
    ramp.opacities = {{-end, kRampOpacity, 0.5, 0}, {0, 0, 0.5, 0}, {end, kRampOpacity, 0.5, 0}};
    return ramp;
}

TransferFunction greyRamp(const glm::dvec2& range) {
    TransferFunction ramp;
    ramp.name = "grey ramp";
    ramp.linearColors = true;
    ramp.colors = {{range.x, glm::dvec3(0)}, {range.y, glm::dvec3(1)}};
    ramp.opacities = {{range.x, 0, 0.5, 0}, {range.y, kRampOpacity, 0.5, 0}};
    return ramp;
}

}  // namespace

glm::dvec3 TransferFunction::colorAt(double x) const {
    return ColorCurve(*this).at(x);
}

bool TransferFunction::colorsJump() const {
    if (categorical) return true;
    // Only the points of a "Step" jump are that close.
    constexpr double kShare = 0x1p-30;
    for (std::size_t i = 1; i < colors.size(); ++i) {
        const double apart = colors[i].x - colors[i - 1].x;
        const double range = colors.back().x - colors.front().x;
        if (apart > kShare * range || colors[i].rgb == colors[i - 1].rgb) continue;
        // Clear values have no colour.
        constexpr double kFar = std::numeric_limits<double>::max();
        if (opacityAt(std::nextafter(colors[i - 1].x, -kFar)) > 0 &&
            opacityAt(std::nextafter(colors[i].x, kFar)) > 0)
            return true;
    }
    return false;
}

double TransferFunction::opacityAt(double x) const {
    const auto right = firstBeyond(opacities, x);
    if (right == opacities.begin()) return opacities.front().opacity;
    if (right == opacities.end()) return opacities.back().opacity;

    // The left point's midpoint and sharpness shape the way to the right point. VTK treats the ends
    // of the sharpness range as a straight line and as a step.
    const OpacityPoint& left = right[-1];
    const double s = bendToMidpoint(wayBetween(left.x, right->x, x), left.midpoint);
    if (left.sharpness < 0.01) return std::lerp(left.opacity, right->opacity, s);
    if (left.sharpness > 0.99) return s < 0.5 ? left.opacity : right->opacity;
    return sharpBlend(left.opacity, right->opacity, s, left.sharpness);
}

bool isFog(const Volume& volume) {
    return volume.gridClass() == "fog volume" ||
           (volume.hasBackground() && volume.gridClass() == "unknown" && volume.space().empty() &&
            volume.name() == "density");
}

bool isHounsfield(const Volume& volume) {
    if (volume.space().empty() || volume.empty()) return false;
    const std::vector<std::uint64_t> counts = uncutHistogram(volume);
    const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
    const auto shareWithin = [&](double low, double high) {
        double count = 0;
        for (std::size_t code = 0; code < counts.size(); ++code) {
            if (counts[code] == 0) continue;
            const double value = volume.codeBook().valueOf(Code(code));
            if (value >= low && value <= high) count += double(counts[code]);
        }
        return count / all;
    };
    return shareWithin(-1100, -900) >= 0.01 && shareWithin(-200, 300) >= 0.02;
}

glm::dvec2 bulkRange(const Volume& volume) {
    return bulkOf(volume, uncutHistogram(volume));
}

glm::dvec2 rampRange(const Volume& volume) {
    return rampOf(volume, uncutHistogram(volume));
}

TransferFunction defaultRamp(const Volume& volume) {
    const DefaultFloats floats;
    const Counts counts = uncutHistogram(volume);
    const glm::dvec2 range = rampOf(volume, counts);
    if (!isFog(volume) && divergesFromZero(volume, range, counts)) return divergingRamp(range);
    return defaultRamp(volume, range);
}

TransferFunction defaultRamp(const Volume& volume, const glm::dvec2& range) {
    TransferFunction ramp = greyRamp(range);
    if (!isFog(volume)) return ramp;
    // Thin fog becomes more transparent, not darker.
    ramp.name = "white ramp";
    ramp.colors = {{range.x, glm::dvec3(1)}};
    return ramp;
}

TransferFunction wholeRamp(const Volume& volume) {
    const DefaultFloats floats;
    return wholeRamp(volume, {volume.valueMin(), volume.valueMax()});
}

TransferFunction wholeRamp(const Volume&, const glm::dvec2& range) {
    TransferFunction ramp = greyRamp(range);
    ramp.linearColors = false;
    return ramp;
}

glm::dvec2 defaultRange(const Volume& volume) {
    if (const auto all = rangeOfType(volume.type())) return *all;
    glm::dvec2 range(volume.valueMin(), volume.valueMax());
    if (volume.hasBackground()) {
        range = {std::min(range.x, volume.background()), std::max(range.y, volume.background())};
    }

    // With a single value, 0 should be clear and the value itself dense.
    if (range.x == range.y) range = {std::min(range.x, 0.0), std::max(range.y, 0.0)};
    return range.x < range.y ? range : glm::dvec2(0, 1);
}

bool hidesValues(const TransferFunction& function, bool hasRange) {
    using Point = TransferFunction::OpacityPoint;
    const std::vector<Point>& points = function.opacities;
    if (points.empty()) return false;
    // Opacity is constant beyond the first and the last point.
    const bool goesOn = hasRange || !function.normalized;
    const auto isClear = [](const Point& point) { return point.opacity == 0; };
    const Point& first = points.front();
    const Point& last = points.back();
    if (isClear(first) && (goesOn || first.x > 0)) return true;
    if (isClear(last) && (goesOn || last.x < 1)) return true;
    const auto clearBetween = [&](const Point& a, const Point& b) {
        return isClear(a) && isClear(b) && a.x < b.x;
    };
    return std::adjacent_find(points.begin(), points.end(), clearBetween) != points.end();
}

bool showsValue(const TransferFunction& function, const std::optional<glm::dvec2>& range,
                const std::string& type, double value) {
    if (!function.normalized) return function.opacityAt(value) > 0;
    const std::optional<glm::dvec2> ends = range ? range : rangeOfType(type);
    return ends && function.opacityAt((value - ends->x) / (ends->y - ends->x)) > 0;
}

double hiddenShare(const Volume& volume, const TransferFunction& function,
                   const std::optional<glm::dvec2>& range) {
    const std::optional<double> background = guessBackground(volume);
    std::uint64_t all = 0;
    std::uint64_t hidden = 0;
    for (std::size_t code = 0; code < volume.histogram().size(); ++code) {
        if (volume.histogram()[code] == 0) continue;
        if (background && volume.codeBook().standsFor(Code(code), *background)) continue;
        all += volume.histogram()[code];
        if (!showsValue(function, range, volume.type(), volume.codeBook().valueOf(Code(code))))
            hidden += volume.histogram()[code];
    }
    return all > 0 ? double(hidden) / double(all) : 0;
}

namespace {

using Kind = LocatedJson::Kind;

// One preset of a file and the checks of its members.
class PresetReader {
  public:
    PresetReader(const std::filesystem::path& file, const LocatedJson& preset)
        : file_(file), preset_(preset) {}

    std::string text(const char* name, const std::string& otherwise) const {
        const LocatedJson* member = preset_.find(name);
        if (!member) return otherwise;
        if (member->kind != Kind::kString) fail(*member, std::string("text in ") + name);
        return member->text;
    }

    bool flag(const char* name) const {
        const LocatedJson* member = preset_.find(name);
        if (!member) return false;
        if (member->kind != Kind::kBoolean) fail(*member, std::string("true or false in ") + name);
        return member->flag;
    }

    // ParaView also writes flags as numbers.
    bool flagOrNumber(const char* name) const {
        const LocatedJson* member = preset_.find(name);
        return member && member->kind == Kind::kNumber ? member->number != 0 : flag(name);
    }

    bool has(const char* name) const { return preset_.find(name) != nullptr; }

    // Calls add(x, three numbers) per point, a group of four numbers.
    // @param most  of the three: 1, or infinity
    template <typename Add>
    void points(const char* name, const char* meaning, double most, const Add& add) const {
        const LocatedJson& list = array(name, meaning);
        double last = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < list.members.size(); i += 4) {
            const double x = numberIn(list, i, name);
            if (x < last) {
                fail(list.members[i].value,
                     "x not below the " + numberText(last) + " before it in " + name);
            }
            last = x;
            const auto at = [&](std::size_t n) { return numberUpTo(most, list, i + n, name); };
            add(x, glm::dvec3(at(1), at(2), at(3)));
        }
    }

  private:
    [[noreturn]] void failAt(int line, const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, file_.string() + ":" + std::to_string(line), got, expected);
    }

    [[noreturn]] void fail(const LocatedJson& json, const std::string& expected) const {
        failAt(json.line, json.quoted(), expected);
    }

    const LocatedJson& array(const char* name, const char* meaning) const {
        const std::string expected =
            std::string(name) + " with groups of four numbers (" + meaning + ")";
        const LocatedJson* list = preset_.find(name);
        if (!list) failAt(preset_.line, std::string("no ") + name, expected);
        if (list->kind != Kind::kArray) fail(*list, expected);
        if (list->members.empty() || list->members.size() % 4 != 0) {
            failAt(list->line, std::to_string(list->members.size()) + " numbers", expected);
        }
        return *list;
    }

    double numberIn(const LocatedJson& list, std::size_t i, const char* name) const {
        const LocatedJson& element = list.members[i].value;
        if (element.kind != Kind::kNumber) fail(element, std::string("a number in ") + name);
        return element.number;
    }

    double numberUpTo(double most, const LocatedJson& list, std::size_t i, const char* name) const {
        const double number = numberIn(list, i, name);
        if (number >= 0 && number <= most) return number;
        const std::string range = most == 1 ? "a number within 0..1" : "a number >= 0";
        fail(list.members[i].value, range + " in " + name);
    }

    const std::filesystem::path& file_;
    const LocatedJson& preset_;
};

[[noreturn]] void refusePreset(const std::filesystem::path& file, const LocatedJson& json,
                               const std::string& got) {
    throw Error(ErrorCode::kInput, file.string() + ":" + std::to_string(json.line), got,
                "a transfer function, an object with RGBPoints");
}

std::vector<const LocatedJson*> presetsOf(const std::filesystem::path& file,
                                          const LocatedJson& root) {
    std::vector<const LocatedJson*> presets;
    if (root.kind == Kind::kArray) {
        for (const LocatedMember& member : root.members) presets.push_back(&member.value);
    } else {
        presets.push_back(&root);
    }
    if (presets.empty()) refusePreset(file, root, "an empty array");
    return presets;
}

// "" if the name is missing or malformed; only the preset that is read is checked.
std::string nameOf(const LocatedJson& preset) {
    const LocatedJson* name = preset.kind == Kind::kObject ? preset.find("Name") : nullptr;
    return name && name->kind == Kind::kString ? name->text : "";
}

// Returns where the interval behind `left` begins: just far enough that values at the point itself
// keep the point's colour despite rounding of a normalized range.
double justBehind(double left, double right) {
    constexpr double kShare = 0x1p-40;
    return std::max(left + (kShare * right - kShare * left), std::nextafter(left, right));
}

// Gives every interval the colour of its right end, and every point its own, as VTK does.
void makeSteps(std::vector<TransferFunction::ColorPoint>& colors) {
    std::vector<TransferFunction::ColorPoint> steps;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        steps.push_back(colors[i]);
        if (i + 1 < colors.size() && colors[i].x < colors[i + 1].x)
            steps.push_back({justBehind(colors[i].x, colors[i + 1].x), colors[i + 1].rgb});
    }
    colors = std::move(steps);
}

// Inserts the stops of the shortest CIEDE2000 way between colours, which are then mixed as L*a*b*.
void makePaths(std::vector<TransferFunction::ColorPoint>& colors) {
    ColorPaths paths;
    std::vector<TransferFunction::ColorPoint> all{colors.front()};
    for (std::size_t i = 1; i < colors.size(); ++i) {
        const TransferFunction::ColorPoint& left = colors[i - 1];
        const TransferFunction::ColorPoint& right = colors[i];
        if (left.x < right.x) {
            const auto stops = paths.between(left.rgb, right.rgb);
            for (std::size_t k = 1; k + 1 < stops.size(); ++k)
                all.push_back({std::lerp(left.x, right.x, stops[k].share), stops[k].rgb});
        }
        all.push_back(right);
    }
    colors = std::move(all);
}

void readColors(const std::filesystem::path& file, const PresetReader& preset,
                const Listener& listener, TransferFunction& function) {
    function.linearColors = preset.text("ColorSpaceOfPoints", "sRGB") == "linear";
    // Scene-linear light has no upper limit; sRGB has.
    const double most = function.linearColors ? std::numeric_limits<double>::infinity() : 1;
    preset.points("RGBPoints", "x, red, green, blue", most, [&](double x, const glm::dvec3& rgb) {
        function.colors.push_back({x, rgb});
    });
    const std::string space = preset.text("ColorSpace", "RGB");
    if (space == "Step") {
        makeSteps(function.colors);
    } else if (space == "HSV") {
        function.colorSpace =
            preset.flagOrNumber("HSVWrap") ? ColorSpace::kHsvShortest : ColorSpace::kHsv;
    } else if (space == "Lab" || space == "CIELAB") {
        function.colorSpace = ColorSpace::kLab;
    } else if (space == "Lab/CIEDE2000") {
        function.colorSpace = ColorSpace::kLab;
        // The ways lead through screen colours only.
        if (function.linearColors) {
            listener.warn(file.string() + ": ColorSpace " + space +
                          " with linear colours is interpolated as Lab");
        } else {
            makePaths(function.colors);
        }
    } else if (space == "Diverging") {
        function.colorSpace = ColorSpace::kDiverging;
    } else if (space != "RGB") {
        listener.warn(file.string() + ": ColorSpace " + space + " is interpolated as RGB");
    }
}

// ParaView's presets often lack opacities; its opacity editor then shows a straight ramp.
void readOpacities(const std::filesystem::path& file, const PresetReader& preset,
                   const Listener& listener, TransferFunction& function) {
    if (preset.has("Points")) {
        preset.points("Points", "x, opacity, midpoint, sharpness", 1,
                      [&](double x, const glm::dvec3& p) {
                          function.opacities.push_back({x, p.x, p.y, p.z});
                      });
        return;
    }
    const double low = function.colors.front().x;
    const double high = function.colors.back().x;
    function.opacities = {{low, 0, 0.5, 0}, {high, 1, 0.5, 0}};
    listener.warn(file.string() + ": no Points (opacities); opacity rises from 0 at " +
                  numberText(low) + " to 1 at " + numberText(high));
}

TransferFunction readPreset(const std::filesystem::path& file, const LocatedJson& json,
                            const Listener& listener) {
    if (json.kind != Kind::kObject) refusePreset(file, json, json.quoted());
    const PresetReader preset(file, json);
    TransferFunction function;
    function.name = preset.text("Name", file.stem().string());
    function.normalized = preset.flag("Normalized");
    readColors(file, preset, listener, function);
    readOpacities(file, preset, listener, function);
    return function;
}

}  // namespace

std::vector<std::string> transferFunctionNames(const std::filesystem::path& file) {
    const LocatedJson root = readLocatedJson(file);
    std::vector<std::string> names;
    for (const LocatedJson* preset : presetsOf(file, root)) names.push_back(nameOf(*preset));
    return names;
}

TransferFunction readTransferFunction(const std::filesystem::path& file, const Listener& listener) {
    const DefaultFloats floats;
    const LocatedJson root = readLocatedJson(file);
    return readPreset(file, *presetsOf(file, root).front(), listener);
}

TransferFunction readTransferFunction(const std::filesystem::path& file, const std::string& name,
                                      const Listener& listener) {
    const DefaultFloats floats;
    const LocatedJson root = readLocatedJson(file);
    std::string known;
    for (const LocatedJson* preset : presetsOf(file, root)) {
        const std::string here = nameOf(*preset);
        if (here == name) return readPreset(file, *preset, listener);
        if (!here.empty()) known += (known.empty() ? "" : ", ") + here;
    }
    throw Error(ErrorCode::kInput, file.string(), "no transfer function \"" + name + "\"",
                known.empty() ? "none, for those it has are without names"
                              : "one of those it has: " + known);
}

}  // namespace deltasplat
