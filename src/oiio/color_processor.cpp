// SPDX-License-Identifier: Apache-2.0
#include "oiio/color_processor.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <mutex>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/in_child.h"
#include "base/parallel.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/image/color_management.h"
#include "deltasplat/image/image.h"
#include "deltasplat/threads.h"
#include "image/srgb.h"
#include "modules/image_module.h"

namespace deltasplat {

namespace {

[[noreturn]] void fail() {
    throw Error(ErrorCode::kFailed, std::string("a file in memory: ") + std::strerror(errno));
}

}  // namespace

MemoryFile::MemoryFile() : file_(::memfd_create("deltasplat", MFD_CLOEXEC)) {
    if (!file_) fail();
}

std::string MemoryFile::bytes() const {
    struct stat status {};
    if (::fstat(file_.get(), &status) != 0) fail();
    std::string bytes(std::size_t(status.st_size), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count =
            ::pread(file_.get(), bytes.data() + done, bytes.size() - done, off_t(done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail();
        done += std::size_t(count);
    }
    return bytes;
}

namespace {

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

// What a library complains of, on one line.
std::string complaint(const std::string& text) {
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return printable(line);
}

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

class Processor : public ColorProcessor {
  public:
    explicit Processor(const ColorOptions& ofColors)
        : options_(ofColors), config_((requireFile(ofColors.config), ofColors.config.string())) {
        requireFile(options_.look);
        // Without one there is OpenImageIO's own.
        const bool isNone = options_.config.empty() && !std::getenv("OCIO");
        if (isNone) config_.geterror();
        if (config_.has_error()) {
            throw Error(ErrorCode::kInput,
                        options_.config.empty() ? "$OCIO" : options_.config.string(),
                        complaint(config_.geterror()), "a configuration of OpenColorIO");
        }
        working_ = workingSpaceOf(config_, options_);
        if (!options_.colorSpace.empty()) {
            requireOneOf("`colorSpace`", options_.colorSpace, config_.getColorSpaceNames());
            stored_ = make(config_, "`colorSpace`", options_.colorSpace, [&] {
                return config_.createColorProcessor(working_, options_.colorSpace);
            });
        }
        if (!options_.display.empty() || !options_.displayView.empty()) findDisplay();
        if (!options_.look.empty()) {
            // OpenColorIO reads no table without a configuration, and then needs nothing of it.
            const MemoryFile nothing;
            if (isNone) std::ofstream(nothing.name()) << kNoConfig;
            OIIO::ColorConfig none(isNone ? nothing.name() : std::string());
            OIIO::ColorConfig& known = isNone ? none : config_;
            look_ = make(known, "`look`", options_.look.string(), [&] {
                return known.createFileTransform(std::filesystem::absolute(options_.look).string());
            });
        }
    }

    void convert(Image& image) const override {
        if (stored_) apply(stored_, image);
    }

    void show(Image& image) const override {
        if (shown_) {
            apply(shown_, image);
        } else {
            eachColor(image, [](double v) { return srgbFromLinear(std::clamp(v, 0.0, 1.0)); });
        }
        if (look_) apply(look_, image);
        eachColor(image, [](double v) { return linearFromSrgb(std::clamp(v, 0.0, 1.0)); });
    }

  private:
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
        shown_ = make(config_, "`display`", options_.display, [&] {
            return config_.createDisplayTransform(options_.display, options_.displayView, working_);
        });
    }

    // OpenImageIO takes what OpenColorIO complains of, with names and lines of files in it, for the
    // format of its own message, and ends the process where braces make it none. So what is to be
    // made is made in another process before, which ends instead and keeps the complaint. One at a
    // time, for another thread's lock would stay locked there.
    static OIIO::ColorProcessorHandle make(
        OIIO::ColorConfig& config, const char* option, const std::string& name,
        const std::function<OIIO::ColorProcessorHandle()>& create) {
        static std::mutex making;
        const std::lock_guard lock(making);
        std::string reason;
        std::byte nothing{};
        const auto createThere = [&](std::byte*) {
            create();
            return true;
        };
        if (inChild(1, createThere, &nothing, &reason)) {
            if (OIIO::ColorProcessorHandle made = create()) return made;
            reason = config.geterror();
        }
        throw Error(ErrorCode::kInput, option, printable(name) + ": " + complaint(reason),
                    "what OpenColorIO can make a transform of");
    }

    void apply(const OIIO::ColorProcessorHandle& processor, Image& image) const {
        OIIO::ImageSpec spec(image.size.x, image.size.y, 4, OIIO::TypeFloat);
        spec.alpha_channel = 3;
        OIIO::ImageBuf buffer(spec, image.rgba.data());
        if (OIIO::ImageBufAlgo::colorconvert(buffer, buffer, processor.get(), true, {},
                                             threadCount()))
            return;
        throw Error(ErrorCode::kFailed, "OpenColorIO: " + complaint(buffer.geterror()));
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

    ColorOptions options_;
    OIIO::ColorConfig config_;
    std::string working_;
    OIIO::ColorProcessorHandle stored_;
    OIIO::ColorProcessorHandle shown_;
    OIIO::ColorProcessorHandle look_;
};

}  // namespace

std::unique_ptr<ColorProcessor> image_module::makeColorProcessor(const ColorOptions& options) {
    return std::make_unique<Processor>(options);
}

}  // namespace deltasplat
