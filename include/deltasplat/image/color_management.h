// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "deltasplat/image/exr_options.h"
#include "deltasplat/image/image.h"

namespace deltasplat {

/// How colours of light become those of a file, by OpenColorIO.
struct ColorOptions {
    /// OpenColorIO's configuration; empty: that of the environment variable OCIO, or OpenImageIO's
    /// own, which knows little.
    std::filesystem::path config;
    /// The configuration's name of a picture's own colours, linear ones of Rec. 709; empty: found
    /// by its usual names, else the role scene_linear.
    std::string workingSpace;
    std::string colorSpace;      ///< that light is stored in; empty: its own
    std::string display;         ///< that light is shown on; empty: the default one
    std::string displayView;     ///< by which; empty: the display's default one
    std::filesystem::path look;  ///< table (.cube and others) that display values go through

    /// Whether light is shown otherwise than by the curve of sRGB.
    bool isShown() const { return !display.empty() || !displayView.empty() || !look.empty(); }
};

/// Transforms colours as OpenColorIO does, in floats: the same wherever it is the same version.
/// Colours are divided by alpha before and multiplied after.
class ColorTransform {
  public:
    /// @throw Error(kUsage) naming the option for what the configuration does not have;
    ///        Error(kInput) for files that cannot be read
    explicit ColorTransform(const ColorOptions& options);
    ~ColorTransform();
    ColorTransform(ColorTransform&&) noexcept;

    /// Makes of light what is stored of it in ColorOptions::colorSpace.
    void convert(Image& image) const;
    /// Makes of light what is shown of it, in linear colours of sRGB, 0 to 1 as a screen has them.
    void show(Image& image) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Returns the primaries of colour spaces that are known by name: those of ACES, and linear Rec.
/// 709; empty for others.
std::optional<Chromaticities> chromaticitiesOf(const std::string& colorSpace);

}  // namespace deltasplat
