// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deltasplat {

/// A value in USD's text format.
struct UsdValue {
    enum class Kind {
        kNone,    ///< None: there is no value
        kNumber,  ///< of tuples and lists of numbers see `items`
        kText,    ///< between quotes
        kWord,    ///< true, false or another bare word
        kAsset,   ///< @...@
        kPath,    ///< <...>
        kItems,   ///< (...) or [...]
        kSkipped  ///< what is never asked for, and not kept
    };
    Kind kind = Kind::kNone;
    int line = 1;
    double number = 0;
    std::string text;
    std::vector<UsdValue> items;

    /// Returns the value as an error quotes it.
    std::string quoted() const;
};

struct UsdSample {
    double time = 0;
    UsdValue value;
};

/// An attribute or a relationship.
struct UsdProperty {
    std::string name;
    int line = 1;
    std::optional<UsdValue> value;
    std::vector<UsdSample> samples;  ///< in ascending order of time
    std::vector<double> times;       ///< of the samples
};

/// What has names, in the file's order; of several of one name the first is found.
template <typename Named>
class UsdList {
  public:
    /// Adds `one`, and returns it.
    Named& add(Named one) {
        places_.emplace(one.name, all_.size());
        return all_.emplace_back(std::move(one));
    }
    const Named* find(std::string_view name) const {
        const auto place = places_.find(name);
        return place == places_.end() ? nullptr : &all_[place->second];
    }
    Named* find(std::string_view name) {
        return const_cast<Named*>(std::as_const(*this).find(name));
    }
    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }
    auto begin() { return all_.begin(); }
    auto end() { return all_.end(); }

  private:
    std::vector<Named> all_;
    std::map<std::string, std::size_t, std::less<>> places_;
};

struct UsdPrim {
    std::string type;  ///< empty: of none
    std::string name;
    int line = 1;
    bool isClass = false;               ///< or an `over`: shows nothing by itself
    std::vector<std::string> composed;  ///< of what is not followed: references, payload, ...
    std::map<std::string, UsdValue> metadata;
    UsdList<UsdProperty> properties;
    UsdList<UsdPrim> children;

    /// Returns null if there is none.
    const UsdProperty* find(std::string_view property) const { return properties.find(property); }
};

/// The most items of a list that are kept.
inline constexpr std::size_t kMostUsdItems = 1024;

/// One file in USD's text format (.usda): its prims as they stand there. Nothing is composed:
/// sublayers, references, payloads, inherited and specialized prims and variants are not followed.
/// Values of arrays other than token[] are passed over, and of these what is behind the first
/// kMostUsdItems.
struct UsdLayer {
    std::filesystem::path file;
    UsdPrim root;  ///< without a name, with the layer's metadata
};

/// @throw Error(kInput) `<file>:<line>: got X; expected Y` if it is no such file, longer than 16
///        MiB or nested deeper than 64 levels; Error(kFailed) if there is not enough memory for it
UsdLayer readUsdLayer(const std::filesystem::path& file);

}  // namespace deltasplat
