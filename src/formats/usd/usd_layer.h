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

struct UsdValue {
    enum class Kind {
        kNone,    ///< None: no value
        kNumber,  ///< a single number; tuples and lists have `items`
        kText,    ///< between quotes
        kWord,    ///< true, false or another bare word
        kAsset,   ///< @...@
        kPath,    ///< <...>
        kItems,   ///< (...) or [...]
        kSkipped  ///< not kept, because nobody asks for it
    };
    Kind kind = Kind::kNone;
    int line = 1;
    double number = 0;
    std::string text;
    std::vector<UsdValue> items;

    /// Returns the value as error messages quote it.
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

/// Named entries in file order. find() returns the first with a name.
template <typename Named>
class UsdList {
  public:
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
    std::string type;  ///< empty: untyped
    std::string name;
    int line = 1;
    bool isClass = false;               ///< or an `over`: not shown by itself
    std::vector<std::string> composed;  ///< arcs that are not followed: references, payload, ...
    std::map<std::string, UsdValue> metadata;
    UsdList<UsdProperty> properties;
    UsdList<UsdPrim> children;

    const UsdProperty* find(std::string_view property) const { return properties.find(property); }
};

/// Longest list that is kept.
inline constexpr std::size_t kMostUsdItems = 1024;

/// One .usda file, its prims as written. Nothing is composed: no sublayers, references, payloads,
/// inherits, specializes or variants. Arrays are skipped, except token[] up to kMostUsdItems.
struct UsdLayer {
    std::filesystem::path file;
    UsdPrim root;  ///< without a name, with the layer's metadata
};

/// @throw Error(kInput) `<file>:<line>: got X; expected Y` if the file is no .usda, longer than 16
///        MiB or nested deeper than 64 levels; Error(kFailed) if memory is short
UsdLayer readUsdLayer(const std::filesystem::path& file);

}  // namespace deltasplat
