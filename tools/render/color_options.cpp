// SPDX-License-Identifier: Apache-2.0
#include "render/color_options.h"

#include <mutex>
#include <string>

#include "deltasplat/error.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

bool endsWith(const std::string& text, const char* end) {
    const std::string tail = end;
    return text.size() >= tail.size() &&
           text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

// Whether three channels from one on are light.
bool isLight(const std::vector<ImageChannel>& channels, std::size_t first) {
    if (first + 3 > channels.size()) return false;
    const std::string& name = channels[first].name;
    return endsWith(name, ".R") && name != "shadow.R" && endsWith(channels[first + 1].name, ".G") &&
           endsWith(channels[first + 2].name, ".B");
}

// Parts of light are divided by no alpha of their own.
void convertLight(const ColorTransform& transform, glm::ivec2 size, ImageChannel* rgb) {
    Image image(size);
    for (std::size_t i = 0; i < rgb->values.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * i + c] = rgb[c].values[i];
        image.rgba[4 * i + 3] = 1;
    }
    transform.convert(image);
    for (std::size_t i = 0; i < rgb->values.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) rgb[c].values[i] = image.rgba[4 * i + c];
}

}  // namespace

void addColorOptions(CLI::App& app, ColorOptions& options) {
    OptionGroup group(app, "Output");
    const auto addName = [&](const char* flag, std::string& name, const char* help) {
        group.addValue(flag, "NAME", name, anyText(), help);
    };
    group.addValue("--ocio", "FILE", options.config, anyText(),
                   "Configuration of OpenColorIO (default: that of $OCIO)");
    addName("--working-space", options.workingSpace,
            "Its name of linear Rec. 709, in which all is reckoned (default: found\n"
            "by its usual names, else the role scene_linear)");
    addName("--colorspace", options.colorSpace,
            "Colour space to store an .exr in, as ACEScg (default: linear Rec. 709)");
    addName("--display", options.display,
            "Display that a .png, .tif or .jpg shows light on (default, with\n"
            "--display-view: the configuration's default)");
    addName("--display-view", options.displayView,
            "View of the display (default, with --display: its default)");
    group.addValue("--look", "FILE", options.look, anyText(),
                   "Look of a .png, .tif or .jpg: a .cube, or another table that\n"
                   "OpenColorIO reads, from and to what is displayed, 0 to 1");
}

const ColorTransform& colorsOf(const RenderCommand& command) {
    KeptColors& kept = *command.keptColors;
    std::call_once(kept.once, [&] { kept.transform.emplace(command.color); });
    return *kept.transform;
}

void checkColors(const RenderCommand& command) {
    const ColorOptions& color = command.color;
    const auto refuse = [](const std::string& option, const std::string& got,
                           const std::string& expected) {
        throw Error(ErrorCode::kUsage, option, got, expected);
    };
    if (color.colorSpace.empty() && !color.isShown()) return;
    const std::string option = !color.colorSpace.empty()    ? "--colorspace"
                               : !color.display.empty()     ? "--display"
                               : !color.displayView.empty() ? "--display-view"
                                                            : "--look";
    const Mode mode = command.picture.render.mode;
    if (mode != Mode::kComposite) refuse(option, "--mode " + modeName(mode), "--mode composite");
    if (command.deep) refuse(option, "--deep besides", "a flat picture, or --deep alone");
    if (!color.colorSpace.empty() && !isExr(command))
        refuse(option, command.output.string(), "an .exr file (others: --display)");
    if (color.isShown() && isExr(command)) {
        refuse(color.colorSpace.empty() ? option : "--display", command.output.string(),
               "a .png, .tif or .jpg file (an .exr: --colorspace)");
    }
    if (color.isShown() && command.tone.tone != Tone::kStandard)
        refuse("--tone", toneName(command.tone.tone) + " with " + option, "one of the two");
    colorsOf(command);
}

void warnOfUnusedColorOptions(const CLI::App& app, const RenderCommand& command,
                              ProgressDisplay& display) {
    if (!command.color.colorSpace.empty() || command.color.isShown()) return;
    for (const char* option : {"--ocio", "--working-space"})
        if (isGiven(app, option))
            display.warn(std::string(option) +
                         ": has no effect without --colorspace, --display or --look");
}

void convertColors(const RenderCommand& command, Image& image, ImageFileOptions& file) {
    if (command.color.colorSpace.empty()) return;
    const ColorTransform& transform = colorsOf(command);
    transform.convert(image);
    for (std::size_t i = 0; i < file.channels.size(); ++i)
        if (isLight(file.channels, i)) convertLight(transform, image.size, &file.channels[i]);
}

void setColors(const RenderCommand& command, ImageFileOptions& file) {
    const std::string& space = command.color.colorSpace;
    if (space.empty()) return;
    file.exr.chromaticities = chromaticitiesOf(space);
    file.metadata.emplace_back("colorSpace", space);
}

}  // namespace deltasplat
