// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "deltasplat/image/exr_options.h"
#include "deltasplat/image/image.h"

namespace deltasplat {

/// How OpenColorIO converts light to a file's colours.
struct ColorOptions {
    /// OpenColorIO's configuration; empty: environment variable OCIO's, or OpenImageIO's small one.
    std::filesystem::path config;
    /// The configuration's name for a picture's own colours, linear Rec. 709; empty: one of the
    /// usual names, else the role scene_linear.
    std::string workingSpace;
    std::string colorSpace;      ///< of stored light; empty: linear Rec. 709
    std::string display;         ///< for shown light; empty: the default display
    std::string displayView;     ///< empty: the display's default view
    std::filesystem::path look;  ///< table (.cube and others) for display values

    /// Whether light is shown by another curve than sRGB's.
    bool isShown() const { return !display.empty() || !displayView.empty() || !look.empty(); }
};

/// Transforms colours in floats by OpenColorIO: equal results with equal versions. Colours are
/// divided by alpha before and multiplied after.
class ColorTransform {
  public:
    /// @throw Error(kUsage) naming an option not in the configuration; Error(kInput) for bad files
    explicit ColorTransform(const ColorOptions& options);
    ~ColorTransform();
    ColorTransform(ColorTransform&&) noexcept;

    /// Turns light into ColorOptions::colorSpace, for storage.
    void convert(Image& image) const;
    /// Turns light into shown colours: linear sRGB, 0 to 1 as on a screen.
    void show(Image& image) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Returns the primaries of ACES colour spaces and linear Rec. 709 by name; empty for others.
std::optional<Chromaticities> chromaticitiesOf(const std::string& colorSpace);

}  // namespace deltasplat
