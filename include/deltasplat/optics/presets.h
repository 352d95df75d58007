// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deltasplat/optics/class_table.h"
#include "deltasplat/optics/transfer_function.h"

namespace deltasplat {

/// A transfer function that need not be read from a file.
struct Preset {
    /// What its points' x are.
    enum class Values {
        kRange,       ///< shares of a range of data values, see fitPreset: it is normalized
        kHounsfield,  ///< Hounsfield units, as CT scanners give them: air is -1000, water 0
        kLabels       ///< whole numbers that name what a voxel belongs to; 0 is nothing
    };
    std::string name;
    Values values = Values::kRange;
    std::string summary;  ///< what it is for, in a few words
};

/// What is more is clear under the preset `labels`.
inline constexpr int kLargestPresetLabel = 65535;

/// Returns all there are, those for the same kind of data together.
const std::vector<Preset>& presets();

/// Shows what a first look at a CT scan is for.
inline constexpr const char* kScanPreset = "ct-soft-tissue";
/// Gives each label a colour of its own.
inline constexpr const char* kLabelPreset = "labels";

/// Returns the preset of that name, or null.
const Preset* findPreset(const std::string& name);

/// Returns a preset's transfer function.
/// @throw Error(kUsage) naming all presets, if there is none of that name
TransferFunction presetFunction(const std::string& name);

/// Returns the preset of a first look at a volume: kLabelPreset of labels, kScanPreset of
/// Hounsfield units (isHounsfield); null: none, but a ramp.
const Preset* defaultPreset(const Volume& volume);

/// Returns what a volume is first shown by, as by the program: its default preset, with the colours
/// that a file gives labels, or else defaultRamp; level sets and scans are lit as surfaces.
Optics defaultOptics(const Volume& volume);

/// Lets a preset of a range show where most values of the volume lie: unless `optics.range` is
/// given, it becomes rampRange(volume), the 1st to the 99th percentile, or of fog from the
/// background on (default_ramp.h). Where both are the same value, the preset is as below its range
/// below that value, and as at the range's end from there on, as defaultRamp is. Without this a
/// normalized function's range is defaultRange. Presets of other values are left alone.
void fitPreset(const Preset& preset, const Volume& volume, Optics& optics);

}  // namespace deltasplat
