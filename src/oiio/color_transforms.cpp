// SPDX-License-Identifier: Apache-2.0
#include "oiio/color_transforms.h"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "image/srgb.h"
#include "modules/image_module.h"

namespace deltasplat {
namespace {

// A file that is in memory only, for readers that read nothing but files with names.
class MemoryFile {
  public:
    MemoryFile() : file_(::memfd_create("deltasplat", MFD_CLOEXEC)) {
        if (!file_)
            throw Error(ErrorCode::kFailed,
                        std::string("a file in memory: ") + std::strerror(errno));
    }
    // The name under which this process can open the file, as long as this object lives.
    std::string name() const { return "/proc/self/fd/" + std::to_string(file_.get()); }

  private:
    Descriptor file_;
};

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

void requireOneOf(const char* option, const std::string& name,
                  const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), name) == names.end())
        refuseUsage(option, printable(name), listOf(names));
}

void requireFile(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!file.empty() && !std::filesystem::is_regular_file(file, ignored)) {
        throw Error(ErrorCode::kInput, file.string(), "no such file", "a readable file");
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

// Makes one transform after the other.
class TransformMaker {
  public:
    TransformMaker(ColorOptions options, const BeforeTransform& before)
        : options_((requireFile(options.config), std::move(options))),
          before_(before),
          config_(options_.config.string()) {
        requireFile(options_.look);
        if (hasNoConfig()) config_.geterror();
        if (config_.has_error()) {
            throw Error(ErrorCode::kInput,
                        options_.config.empty() ? "$OCIO" : options_.config.string(),
                        lineOf(config_.geterror()), "a configuration of OpenColorIO");
        }
        working_ = workingSpaceOf(config_, options_);
    }

    OIIO::ColorProcessorHandle makeStored() {
        if (options_.colorSpace.empty()) return {};
        requireOneOf("`colorSpace`", options_.colorSpace, config_.getColorSpaceNames());
        return make(config_, "`colorSpace`", options_.colorSpace,
                    [&] { return config_.createColorProcessor(working_, options_.colorSpace); });
    }

    OIIO::ColorProcessorHandle makeShown() {
        if (options_.display.empty() && options_.displayView.empty()) return {};
        findDisplay();
        return make(config_, "`display`", options_.display, [&] {
            return config_.createDisplayTransform(options_.display, options_.displayView, working_);
        });
    }

    OIIO::ColorProcessorHandle makeLook() {
        if (options_.look.empty()) return {};
        // OpenColorIO reads no table without a configuration, and then needs nothing of it.
        const MemoryFile nothing;
        if (hasNoConfig()) std::ofstream(nothing.name()) << kNoConfig;
        OIIO::ColorConfig none(hasNoConfig() ? nothing.name() : std::string());
        OIIO::ColorConfig& known = hasNoConfig() ? none : config_;
        return make(known, "`look`", options_.look.string(), [&] {
            return known.createFileTransform(std::filesystem::absolute(options_.look).string());
        });
    }

  private:
    // Without one there is OpenImageIO's own.
    bool hasNoConfig() const { return options_.config.empty() && !std::getenv("OCIO"); }

    void findDisplay() {
        if (options_.display.empty()) {
            const char* name = config_.getDefaultDisplayName();
            options_.display = name ? name : "";
        }
        requireOneOf("`display`", options_.display, config_.getDisplayNames());
        if (options_.displayView.empty()) {
            const char* name = config_.getDefaultViewName(options_.display);
            options_.displayView = name ? name : "";
        }
        requireOneOf("`displayView`", options_.displayView, config_.getViewNames(options_.display));
    }

    OIIO::ColorProcessorHandle make(OIIO::ColorConfig& config, const char* option,
                                    const std::string& name,
                                    const std::function<OIIO::ColorProcessorHandle()>& create) {
        before_(option, name);
        if (OIIO::ColorProcessorHandle made = create()) return made;
        refuseTransform(option, name, config.geterror());
    }

    ColorOptions options_;
    const BeforeTransform& before_;
    OIIO::ColorConfig config_;
    std::string working_;
};

}  // namespace

ColorTransforms makeColorTransforms(ColorOptions options, const BeforeTransform& before) {
    TransformMaker maker(std::move(options), before);
    ColorTransforms transforms;
    transforms.stored = maker.makeStored();
    transforms.shown = maker.makeShown();
    transforms.look = maker.makeLook();
    return transforms;
}

void refuseTransform(const char* option, const std::string& name, const std::string& complaint) {
    throw Error(ErrorCode::kInput, option, printable(name) + ": " + lineOf(complaint),
                "what OpenColorIO can make a transform of");
}

ColorOptions colorOptionsOf(const std::string& text) {
    std::istringstream in(text);
    const auto next = [&] {
        std::string field;
        std::getline(in, field, '\0');
        return field;
    };
    // In textOf's order.
    return {next(), next(), next(), next(), next(), next()};
}

std::string lineOf(const std::string& complaint) {
    std::istringstream words(complaint);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return printable(line);
}

}  // namespace deltasplat
