// SPDX-License-Identifier: Apache-2.0
// Based on: Pixar, "Universal Scene Description", UsdVolVolume and UsdVolOpenVDBAsset.
#include "formats/usd/usd_volume.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/input_files.h"
#include "formats/usd/usd_scene.h"
#include "volume/placement.h"

namespace deltasplat {
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

    // A volume is where it stands itself, wherever its fields are.
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
        // Paths that do not begin at the root begin at the volume.
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
        // USD takes names apart by their text, whatever folders are links; what is looked at is
        // what is opened.
        const std::filesystem::path file = (layer_.file.parent_path() / given).lexically_normal();
        requireConfined(layer_.file, file);
        return file;
    }

    UsdLayer layer_;
    UsdChain volume_;  // into layer_, as asset_; empty: the asset alone was named
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
