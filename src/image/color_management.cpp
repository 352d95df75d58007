// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/color_management.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <vector>

#include "default_floats.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "image/memory_file.h"
#include "lower_case.h"
#include "parallel.h"
#include "printable.h"
#include "srgb.h"

namespace deltasplat {
namespace {

// As configurations of ACES, Blender and studios call them.
constexpr std::array<std::string_view, 10> kLinearRec709{"linear rec.709 (srgb)",
                                                         "lin_rec709_srgb",
                                                         "lin_srgb",
                                                         "lin_rec709",
                                                         "linear rec.709",
                                                         "linear_srgb",
                                                         "linear rec709",
                                                         "srgb - linear",
                                                         "utility - linear - srgb",
                                                         "utility - linear - rec.709"};

constexpr const char* kNoConfig =
    "ocio_profile_version: 2\n"
    "search_path: .\n"
    "roles: {default: raw, scene_linear: lin}\n"
    "displays:\n"
    "  sRGB:\n"
    "    - !<View> {name: Raw, colorspace: raw}\n"
    "active_displays: [sRGB]\n"
    "active_views: [Raw]\n"
    "colorspaces:\n"
    "  - !<ColorSpace>\n"
    "    name: lin\n"
    "  - !<ColorSpace>\n"
    "    name: raw\n"
    "    isdata: true\n";

std::string listOf(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 12;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
        text += (i == 0 ? "" : ", ") + printable(names[i]);
    if (names.size() > kMost) text += ", ...";
    return text.empty() ? "a configuration that has some" : "one of " + text;
}

[[noreturn]] void refuse(const char* option, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected(option, got, expected));
}

void requireOneOf(const char* option, const std::string& name,
                  const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), name) == names.end())
        refuse(option, printable(name), listOf(names));
}

void requireFile(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!file.empty() && !std::filesystem::is_regular_file(file, ignored)) {
        throw Error(ErrorCode::kInput,
                    gotExpected(file.string(), "no such file", "a readable file"));
    }
}

std::string workingSpaceOf(const OIIO::ColorConfig& config, const ColorOptions& options) {
    const std::vector<std::string> names = config.getColorSpaceNames();
    if (!options.workingSpace.empty()) {
        requireOneOf("`workingSpace`", options.workingSpace, names);
        return options.workingSpace;
    }
    for (const std::string_view known : kLinearRec709) {
        for (const std::string& name : names)
            if (lowerCase(name) == known) return name;
    }
    const char* role = config.getColorSpaceNameByRole("scene_linear");
    return role ? role : "linear";
}

}  // namespace

struct ColorTransform::Impl {
    explicit Impl(const ColorOptions& ofColors)
        : options(ofColors), config((requireFile(ofColors.config), ofColors.config.string())) {
        requireFile(options.look);
        // Without one there is OpenImageIO's own.
        const bool isNone = options.config.empty() && !std::getenv("OCIO");
        if (isNone) config.geterror();
        if (config.has_error()) {
            throw Error(
                ErrorCode::kInput,
                gotExpected(options.config.empty() ? "$OCIO" : options.config.string(),
                            printable(config.geterror()), "a configuration of OpenColorIO"));
        }
        working = workingSpaceOf(config, options);
        if (!options.colorSpace.empty()) {
            requireOneOf("`colorSpace`", options.colorSpace, config.getColorSpaceNames());
            stored = config.createColorProcessor(working, options.colorSpace);
            requireMade(stored, config, "`colorSpace`", options.colorSpace);
        }
        if (!options.display.empty() || !options.displayView.empty()) findDisplay();
        if (!options.look.empty()) {
            // OpenColorIO reads no table without a configuration, and then needs nothing of it.
            const MemoryFile nothing;
            if (isNone) std::ofstream(nothing.name()) << kNoConfig;
            OIIO::ColorConfig none(isNone ? nothing.name() : std::string());
            OIIO::ColorConfig& known = isNone ? none : config;
            look = known.createFileTransform(std::filesystem::absolute(options.look).string());
            requireMade(look, known, "`look`", options.look.string());
        }
    }

    void findDisplay() {
        if (options.display.empty()) {
            const char* name = config.getDefaultDisplayName();
            options.display = name ? name : "";
        }
        requireOneOf("`display`", options.display, config.getDisplayNames());
        if (options.displayView.empty()) {
            const char* name = config.getDefaultViewName(options.display);
            options.displayView = name ? name : "";
        }
        requireOneOf("`displayView`", options.displayView, config.getViewNames(options.display));
        shown = config.createDisplayTransform(options.display, options.displayView, working);
        requireMade(shown, config, "`display`", options.display);
    }

    static void requireMade(const OIIO::ColorProcessorHandle& made, OIIO::ColorConfig& config,
                            const char* option, const std::string& name) {
        if (made) return;
        throw Error(ErrorCode::kInput,
                    gotExpected(option, printable(name + ": " + config.geterror()),
                                "what OpenColorIO can make a transform of"));
    }

    void apply(const OIIO::ColorProcessorHandle& processor, Image& image) const {
        OIIO::ImageSpec spec(image.size.x, image.size.y, 4, OIIO::TypeFloat);
        spec.alpha_channel = 3;
        OIIO::ImageBuf buffer(spec, image.rgba.data());
        if (OIIO::ImageBufAlgo::colorconvert(buffer, buffer, processor.get(), true, {},
                                             threadCount()))
            return;
        throw Error(ErrorCode::kFailed, "OpenColorIO: " + printable(buffer.geterror()));
    }

    // Changes colours, divided by alpha, each by itself.
    template <typename Change>
    static void eachColor(Image& image, const Change& change) {
        parallelFor(std::size_t(image.size.y), [&](std::size_t y) {
            for (int x = 0; x < image.size.x; ++x) {
                float* rgba = image.pixel(x, int(y));
                for (int c = 0; c < 3; ++c) {
                    if (rgba[3] > 0) rgba[c] = float(change(double(rgba[c]) / rgba[3]) * rgba[3]);
                }
            }
        });
    }

    ColorOptions options;
    OIIO::ColorConfig config;
    std::string working;
    OIIO::ColorProcessorHandle stored;
    OIIO::ColorProcessorHandle shown;
    OIIO::ColorProcessorHandle look;
};

ColorTransform::ColorTransform(const ColorOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
ColorTransform::~ColorTransform() = default;
ColorTransform::ColorTransform(ColorTransform&&) noexcept = default;

void ColorTransform::convert(Image& image) const {
    if (impl_->stored) impl_->apply(impl_->stored, image);
}

void ColorTransform::show(Image& image) const {
    const DefaultFloats floats;
    if (impl_->shown) {
        impl_->apply(impl_->shown, image);
    } else {
        Impl::eachColor(image, [](double v) { return srgbFromLinear(std::clamp(v, 0.0, 1.0)); });
    }
    if (impl_->look) impl_->apply(impl_->look, image);
    Impl::eachColor(image, [](double v) { return linearFromSrgb(std::clamp(v, 0.0, 1.0)); });
}

// Based on: SMPTE ST 2065-1:2021 (ACES2065-1), Academy S-2014-004 (ACEScg).
std::optional<Chromaticities> chromaticitiesOf(const std::string& colorSpace) {
    const std::string name = lowerCase(colorSpace);
    if (name == "acescg" || name == "aces - acescg" || name == "lin_ap1")
        return Chromaticities{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    if (name == "aces2065-1" || name == "aces - aces2065-1" || name == "lin_ap0")
        return Chromaticities{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
    const bool isRec709 =
        std::find(kLinearRec709.begin(), kLinearRec709.end(), name) != kLinearRec709.end();
    return isRec709 ? std::optional<Chromaticities>(kRec709) : std::nullopt;
}

}  // namespace deltasplat
