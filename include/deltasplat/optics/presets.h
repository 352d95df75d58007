// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// A built-in transfer function.
struct Preset {
    /// What the x of points are.
    enum class Values {
        kRange,       ///< shares of a range of data values: a normalized function, see fitPreset
        kHounsfield,  ///< Hounsfield units of CT scanners: air is -1000, water 0
        kLabels       ///< whole numbers of labels; 0 is nothing
    };
    std::string name;
    Values values = Values::kRange;
    std::string summary;  ///< purpose, in a few words
};

/// Larger labels are clear under the preset `labels`.
inline constexpr int kLargestPresetLabel = 65535;

/// Returns all presets, grouped by the kind of data.
const std::vector<Preset>& presets();

/// The preset for a first look at CT scans.
inline constexpr const char* kScanPreset = "ct-soft-tissue";
/// Gives each label its own colour.
inline constexpr const char* kLabelPreset = "labels";

const Preset* findPreset(const std::string& name);

/// @throw Error(kUsage) naming all presets, for an unknown name
TransferFunction presetFunction(const std::string& name);

/// Returns the preset for a first look at a volume: kLabelPreset for labels, kScanPreset for
/// Hounsfield units (isHounsfield), else null: a ramp.
const Preset* defaultPreset(const Volume& volume);

/// Returns the program's default look of a volume: its default preset, with the file's label
/// colours, or else defaultRamp; level sets and scans are lit as surfaces.
Optics defaultOptics(const Volume& volume);

/// Sets `optics.range` for a preset of a range, unless it is given, to rampRange(volume): 1st to
/// 99th percentile, or for fog from the background on (default_ramp.h). If both ends are one value,
/// smaller values look as below the preset's range, others as at its end, as with defaultRamp.
/// Unfitted normalized functions use defaultRange. Presets of other values stay as they are.
void fitPreset(const Preset& preset, const Volume& volume, Optics& optics);

}  // namespace deltasplat
