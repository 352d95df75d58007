// SPDX-License-Identifier: Apache-2.0
// Based on: Pixar, "Universal Scene Description", UsdGeomXformable, UsdTimeCode (interpolation).
#include "formats/usd/usd_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/cameras/motion.h"
#include "formats/input_files.h"
#include "volume/placement.h"

namespace deltasplat {

namespace {

using Kind = UsdValue::Kind;

constexpr std::string_view kOps = "xformOp:";
constexpr std::string_view kInvert = "!invert!";
constexpr std::string_view kReset = "!resetXformStack!";
constexpr std::size_t kMostNamed = 8;

[[noreturn]] void fail(const UsdLayer& layer, int line, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, layer.file.string() + ":" + std::to_string(line), got, expected);
}

bool isInactive(const UsdPrim& prim) {
    const auto active = prim.metadata.find("active");
    if (active == prim.metadata.end()) return false;
    const UsdValue& value = active->second;
    return value.text == "false" || (value.kind == Kind::kNumber && value.number == 0);
}

void collect(const UsdPrim& prim, std::string_view type, UsdChain& chain,
             std::vector<UsdChain>& found) {
    for (const UsdPrim& child : prim.children) {
        if (child.isClass || isInactive(child)) continue;
        chain.push_back(&child);
        if (child.type == type) found.push_back(chain);
        collect(child, type, chain, found);
        chain.pop_back();
    }
}

// Appends a value's numbers in order; false if it holds anything else.
bool flatten(const UsdValue& value, std::vector<double>& numbers) {
    if (value.kind == Kind::kNumber) numbers.push_back(value.number);
    if (value.kind != Kind::kItems) return value.kind == Kind::kNumber;
    return std::all_of(value.items.begin(), value.items.end(),
                       [&](const UsdValue& item) { return flatten(item, numbers); });
}

UsdValue mixedValues(const UsdValue& a, const UsdValue& b, double share) {
    if (a.kind != b.kind || a.items.size() != b.items.size()) return a;
    UsdValue value = a;
    if (a.kind == Kind::kNumber) value.number = a.number + share * (b.number - a.number);
    for (std::size_t i = 0; i < a.items.size(); ++i)
        value.items[i] = mixedValues(a.items[i], b.items[i], share);
    return value;
}

glm::dmat4 matrixOf(const std::vector<double>& v) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = v[std::size_t(i)];
    return matrix;
}

glm::dmat4 translation(const std::vector<double>& v) {
    glm::dmat4 matrix(1);
    matrix[3] = glm::dvec4(v[0], v[1], v[2], 1);
    return matrix;
}

glm::dmat4 scaling(const std::vector<double>& v) {
    glm::dmat4 matrix(1);
    for (int i = 0; i < 3; ++i) matrix[i][i] = v[std::size_t(i)];
    return matrix;
}

// From a quaternion w, x, y, z of any length.
glm::dmat4 orientation(const std::vector<double>& v) {
    const double squares = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
    if (!(squares > 0)) return glm::dmat4(1);
    const double s = 2 / squares;
    const double w = v[0], x = v[1], y = v[2], z = v[3];
    return {{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w), 0},
            {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w), 0},
            {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y), 0},
            {0, 0, 0, 1}};
}

// "xformOp:rotateXYZ:tilt" is of the kind rotateXYZ.
std::string kindOf(std::string_view op) {
    op.remove_prefix(kOps.size());
    return std::string(op.substr(0, op.find(':')));
}

// Interpolates matrices of rotation, uniform scale and translation by parts: element-wise
// interpolation would shrink rotating objects.
glm::dmat4 transformAt(const UsdLayer& layer, const UsdProperty& op, double time) {
    const std::vector<double>& times = op.times;
    const KeyPlace place = keyPlace(times, time);
    if (!times.empty() && place.share > 0) {
        const glm::dmat4 a = matrixOf(numbersAt(layer, op, times[place.first], 16));
        const glm::dmat4 b = matrixOf(numbersAt(layer, op, times[place.first + 1], 16));
        try {
            return mixed(a, b, place.share);
        } catch (const Error&) {
            // Sheared or unevenly scaled matrices are interpolated element-wise.
        }
    }
    return matrixOf(numbersAt(layer, op, time, 16));
}

glm::dmat4 opAt(const UsdLayer& layer, const UsdProperty& op, const std::string& kind,
                double time) {
    const auto three = [&] { return numbersAt(layer, op, time, 3); };
    if (kind == "transform") return transformAt(layer, op, time);
    if (kind == "translate") return translation(three());
    if (kind == "scale") return scaling(three());
    if (kind == "orient") return orientation(numbersAt(layer, op, time, 4));
    if (kind.starts_with("rotate")) {
        std::string order = kind.substr(6);
        std::transform(order.begin(), order.end(), order.begin(),
                       [](char c) { return char(c | 0x20); });
        glm::dvec3 degrees(0);
        const bool isOne = order == "x" || order == "y" || order == "z";
        if (!isOne && !isRotationOrder(order)) fail(layer, op.line, op.name, "a known xformOp");
        const std::vector<double> v = isOne ? numbersAt(layer, op, time, 1) : three();
        for (int i = 0; i < 3; ++i) degrees[i] = isOne ? 0 : v[std::size_t(i)];
        if (isOne) degrees[order[0] - 'x'] = v[0];
        for (int i = 0; i < 3; ++i) {
            if (!(std::abs(degrees[i]) <= 1e6))
                fail(layer, op.line, numberText(degrees), "at most 1e6 degrees");
        }
        return rotation(degrees, order);
    }
    fail(layer, op.line, op.name, "a known xformOp");
}

// A prim's placement, and whether it ignores its ancestors'.
struct LocalPlace {
    glm::dmat4 parentFromPrim{1};
    bool resets = false;
};

LocalPlace localPlace(const UsdLayer& layer, const UsdPrim& prim, double time) {
    LocalPlace place;
    const UsdProperty* order = prim.find("xformOpOrder");
    if (!order || !order->value) return place;
    constexpr std::size_t kMostOps = 256;
    if (order->value->items.size() > kMostOps)
        fail(layer, order->line, "an xformOpOrder of more than 256 ops", "at most 256");
    for (const UsdValue& item : order->value->items) {
        std::string_view name = item.text;
        if (name == kReset) {
            place = {glm::dmat4(1), true};
            continue;
        }
        const bool isInverse = name.starts_with(kInvert);
        if (isInverse) name.remove_prefix(kInvert.size());
        if (item.kind != Kind::kText || !name.starts_with(kOps))
            fail(layer, order->line, item.quoted(), "the name of an xformOp");
        const UsdProperty* op = prim.find(name);
        if (!op)
            fail(layer, order->line,
                 "xformOpOrder with " + std::string(name) + ", which is not there",
                 "it in the same prim");
        const bool isBlocked = valueAt(*op, time).kind == Kind::kNone;
        const glm::dmat4 one = isBlocked ? glm::dmat4(1) : opAt(layer, *op, kindOf(name), time);
        if (isInverse && !(std::abs(glm::determinant(one)) > 0))
            fail(layer, op->line, "a singular matrix", "one that can be inverted");
        place.parentFromPrim = place.parentFromPrim * (isInverse ? glm::inverse(one) : one);
    }
    return place;
}

}  // namespace

std::string pathOf(const UsdChain& chain) {
    std::string path;
    for (const UsdPrim* prim : chain) path += "/" + prim->name;
    return path;
}

std::vector<UsdChain> primsOfType(const UsdLayer& layer, std::string_view type) {
    std::vector<UsdChain> found;
    UsdChain chain;
    collect(layer.root, type, chain, found);
    return found;
}

UsdChain primAt(const UsdLayer& layer, std::string_view path) {
    UsdChain chain;
    const UsdPrim* parent = &layer.root;
    while (!path.empty() && path.front() == '/') {
        path.remove_prefix(1);
        const std::string_view name = path.substr(0, path.find('/'));
        path.remove_prefix(name.size());
        parent = parent->children.find(name);
        if (!parent) return {};
        chain.push_back(parent);
    }
    return path.empty() ? chain : UsdChain{};
}

UsdChain choosePrim(const UsdLayer& layer, std::string_view type, const std::string& path) {
    const std::vector<UsdChain> all = primsOfType(layer, type);
    std::vector<const UsdChain*> meant;
    for (const UsdChain& chain : all) {
        const std::string one = pathOf(chain);
        if (one == path) return chain;
        if (path.empty() || one.starts_with(path + "/")) meant.push_back(&chain);
    }
    if (meant.size() == 1) return *meant.front();
    const std::string kind(type);
    std::string names;
    for (std::size_t i = 0; i < std::min(all.size(), kMostNamed); ++i)
        names += (i > 0 ? ", " : "") + pathOf(all[i]);
    if (all.size() > kMostNamed) names += ", ...";
    const std::string got = !meant.empty() ? std::to_string(meant.size()) + " prims of type " + kind
                            : path.empty() ? "no prim of type " + kind
                                           : "no prim of type " + kind + " at " + path;
    throw Error(ErrorCode::kInput, layer.file.string(), got,
                all.empty()    ? "at least one"
                : path.empty() ? "the path of one behind a colon: " + names
                               : "one of " + names);
}

UsdValue valueAt(const UsdProperty& property, double time, bool mixes) {
    if (property.samples.empty()) return property.value.value_or(UsdValue());
    const KeyPlace place = keyPlace(property.times, time);
    const UsdValue& first = property.samples[place.first].value;
    if (!mixes || place.share == 0) return first;
    return mixedValues(first, property.samples[place.first + 1].value, place.share);
}

std::vector<double> numbersAt(const UsdLayer& layer, const UsdProperty& property, double time,
                              std::size_t count) {
    const UsdValue value = valueAt(property, time);
    std::vector<double> numbers;
    const std::string expected =
        count == 1 ? "a finite number" : std::to_string(count) + " finite numbers";
    if (!flatten(value, numbers) || numbers.size() != count)
        fail(layer, value.line, value.quoted() + " for " + property.name, expected);
    for (const double number : numbers) {
        if (!std::isfinite(number))
            fail(layer, value.line, numberText(number) + " for " + property.name, expected);
    }
    return numbers;
}

glm::dmat4 worldFromPrim(const UsdLayer& layer, const UsdChain& chain, double time) {
    glm::dmat4 world(1);
    for (const UsdPrim* prim : chain) {
        const LocalPlace place = localPlace(layer, *prim, time);
        world = place.resets ? place.parentFromPrim : world * place.parentFromPrim;
    }
    return world;
}

void addTimes(const UsdPrim& prim, std::string_view property, std::vector<double>& times) {
    const UsdProperty* found = prim.find(property);
    if (!found) return;
    times.insert(times.end(), found->times.begin(), found->times.end());
}

void addTimes(const UsdChain& chain, std::vector<double>& times) {
    for (const UsdPrim* prim : chain) {
        for (const UsdProperty& property : prim->properties) {
            if (!property.name.starts_with(kOps)) continue;
            times.insert(times.end(), property.times.begin(), property.times.end());
        }
    }
}

void warnOfUsd(const UsdLayer& layer, const UsdChain& chain, const Listener& listener) {
    std::vector<const UsdPrim*> prims{&layer.root};
    prims.insert(prims.end(), chain.begin(), chain.end());
    std::string path;
    for (const UsdPrim* prim : prims) {
        if (prim != &layer.root) path += "/" + prim->name;
        const std::string where = layer.file.string() + ": " + (path.empty() ? "/" : path) + ": ";
        std::vector<std::string> composed = prim->composed;
        std::sort(composed.begin(), composed.end());
        composed.erase(std::unique(composed.begin(), composed.end()), composed.end());
        for (const std::string& what : composed) listener.warn(where + what + " are not followed");
        const bool isMoved =
            std::any_of(prim->properties.begin(), prim->properties.end(),
                        [](const UsdProperty& one) { return one.name.starts_with(kOps); });
        if (isMoved && !prim->find("xformOpOrder"))
            listener.warn(where + "xformOps without xformOpOrder, which move nothing");
    }
}

// Based on: Pixar, "Universal Scene Description", UsdVolVolume and UsdVolOpenVDBAsset.
namespace {

using Kind = UsdValue::Kind;

constexpr std::string_view kField = "field:";
constexpr const char* kVolume = "Volume";
constexpr const char* kAsset = "OpenVDBAsset";

class UsdVolumeReader {
  public:
    UsdVolumeReader(UsdLayer layer, const std::string& name) : layer_(std::move(layer)) {
        const UsdChain named = primAt(layer_, name);
        const bool isAsset = !named.empty() && named.back()->type == kAsset;
        if (isAsset || (name.empty() && primsOfType(layer_, kVolume).empty())) {
            asset_ = isAsset ? named : choosePrim(layer_, kAsset, name);
            return;
        }
        volume_ = choosePrim(layer_, kVolume, name);
        asset_ = assetOf(fieldOf(*volume_.back()));
    }

    const UsdLayer& layer() const { return layer_; }
    const UsdChain& asset() const { return asset_; }

    std::vector<double> times() const {
        std::vector<double> times;
        addTimes(place(), times);
        addTimes(*asset_.back(), "filePath", times);
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
        return times;
    }

    UsdVolume at(double time) const {
        UsdVolume volume;
        volume.file = fileAt(time);
        const UsdProperty* field = asset_.back()->find("fieldName");
        if (field) volume.grid = valueAt(*field, time, false).text;
        volume.worldFromVolume = worldFromPrim(layer_, place(), time);
        requirePlacement(layer_.file.string() + ": " + pathOf(place()), "a transform",
                         volume.worldFromVolume);
        return volume;
    }

    void warn(const Listener& listener) const {
        warnOfUsd(layer_, place(), listener);
        const std::string where = layer_.file.string() + ": " + pathOf(asset_);
        if (asset_.back()->find("fieldIndex"))
            listener.warn(where + ": fieldIndex is not followed");
        if (volume_.empty()) return;
        if (asset_.back()->find("xformOpOrder"))
            listener.warn(where + ": its xformOps are left out, for a Volume's place is its own");
        for (const UsdProperty& property : volume_.back()->properties) {
            if (!property.name.starts_with(kField)) continue;
            const UsdChain other = primAt(layer_, targetOf(property));
            if (!other.empty() && !isSameFile(*other.back()))
                listener.warn(layer_.file.string() + ": " + pathOf(other) +
                              " of another file is left out");
        }
    }

  private:
    [[noreturn]] void fail(int line, const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, layer_.file.string() + ":" + std::to_string(line), got,
                    expected);
    }

    // A Volume's own placement counts, not its fields'.
    const UsdChain& place() const { return volume_.empty() ? asset_ : volume_; }

    static std::string targetOf(const UsdProperty& relationship) {
        if (!relationship.value) return "";
        const UsdValue& value = *relationship.value;
        return value.items.size() == 1 ? value.items.front().text : value.text;
    }

    const UsdProperty& fieldOf(const UsdPrim& volume) const {
        const UsdProperty* first = volume.find("field:density");
        for (const UsdProperty& property : volume.properties)
            if (!first && property.name.starts_with(kField)) first = &property;
        if (first) return *first;
        fail(volume.line, "a Volume without fields", "rel field:density, or another one");
    }

    UsdChain assetOf(const UsdProperty& field) const {
        const std::string path = targetOf(field);
        // Relative paths start at the volume.
        const std::string whole = path.starts_with("/") ? path : pathOf(volume_) + "/" + path;
        const UsdChain asset = primAt(layer_, whole);
        if (asset.empty()) fail(field.line, "<" + path + ">, which is not there", "a prim");
        if (asset.back()->type == kAsset) return asset;
        fail(asset.back()->line,
             asset.back()->type.empty() ? "a prim without a type" : "a " + asset.back()->type,
             "an OpenVDBAsset");
    }

    bool isSameFile(const UsdPrim& other) const {
        const UsdProperty* mine = asset_.back()->find("filePath");
        const UsdProperty* its = other.find("filePath");
        const auto textOf = [](const UsdProperty* property) {
            return property ? valueAt(*property, 0, false).text : "";
        };
        return textOf(mine) == textOf(its);
    }

    std::filesystem::path fileAt(double time) const {
        const UsdPrim& prim = *asset_.back();
        const UsdProperty* property = prim.find("filePath");
        const UsdValue value = property ? valueAt(*property, time, false) : UsdValue();
        if (value.kind == Kind::kNone) return {};
        const int line = value.line;
        if (value.kind != Kind::kAsset || value.text.empty())
            fail(line, value.quoted() + " for filePath", "@FILE.vdb@");
        const std::filesystem::path given = value.text;
        if (given.extension() != ".vdb") fail(line, value.quoted() + " for filePath", "a .vdb");
        // USD resolves names as text, ignoring links; the resulting name is checked and opened.
        const std::filesystem::path file = (layer_.file.parent_path() / given).lexically_normal();
        requireConfined(layer_.file, file);
        return file;
    }

    UsdLayer layer_;
    UsdChain volume_;  // into layer_, like asset_; empty: only the asset was named
    UsdChain asset_;
};

std::optional<glm::dvec3> upOf(const UsdLayer& layer) {
    const auto axis = layer.root.metadata.find("upAxis");
    if (axis == layer.root.metadata.end()) return {};
    return axis->second.text == "Z" ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
}

}  // namespace

UsdVolumeMotion readUsdVolume(const std::filesystem::path& file, const std::string& name,
                              const Listener& listener) {
    const auto volume = std::make_shared<const UsdVolumeReader>(readUsdLayer(file), name);
    volume->warn(listener);
    UsdVolumeMotion motion;
    motion.frames = volume->times();
    motion.upWorld = upOf(volume->layer());
    motion.at = [volume](double frame) { return volume->at(frame); };
    return motion;
}

}  // namespace deltasplat
