// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/default_floats.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/transfer_function.h"
#include "deltasplat/optics/transfer_function_names.h"
#include "optics/color_path.h"
#include "optics/located_json.h"

namespace deltasplat {
namespace {

using Kind = LocatedJson::Kind;

// One preset of a file, with everything that turns its members into checked values.
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

    // ParaView writes a switch as a number, too.
    bool flagOrNumber(const char* name) const {
        const LocatedJson* member = preset_.find(name);
        return member && member->kind == Kind::kNumber ? member->number != 0 : flag(name);
    }

    bool has(const char* name) const { return preset_.find(name) != nullptr; }

    // Calls add(x, three numbers) for each of the points, groups of four numbers.
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

// All of a file's transfer functions: one, or an array.
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

// "" for one without a name, and for one that is malformed: that is said of the one that is read.
std::string nameOf(const LocatedJson& preset) {
    const LocatedJson* name = preset.kind == Kind::kObject ? preset.find("Name") : nullptr;
    return name && name->kind == Kind::kString ? name->text : "";
}

// Where the interval behind `left` begins: so little behind it that what lies at the point itself,
// give or take the rounding of a normalized range, has the point's own colour.
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

// Puts the stops of the shortest way between two colours, as CIEDE2000 measures it, between them;
// from stop to stop colours are mixed as L*a*b*.
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
    // Light knows no largest value, a share of what a screen shows does.
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
        // The ways lead through the colours of a screen, and beyond there are more.
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

// A colour map without opacities is common among ParaView's presets, whose opacity editor then
// shows a straight ramp over the colours' range.
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
