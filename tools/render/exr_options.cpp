// SPDX-License-Identifier: Apache-2.0
#include "render/exr_options.h"

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "options/parse.h"
#include "render/render_modes.h"

namespace deltasplat {
namespace {

// Whole numbers, as many as a text has, each behind the signs that may stand before it.
bool readNumbers(const std::string& text, const std::vector<std::string>& signs,
                 std::vector<int>& numbers) {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (const std::string& sign : signs) {
        if (!sign.empty()) {
            if (at == end || sign.find(*at) == std::string::npos) return false;
            // A minus is the number's own.
            if (*at != '-') ++at;
        }
        int number = 0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc()) return false;
        numbers.push_back(number);
        at = next;
    }
    return at == end;
}

PixelBox parseRegion(const std::string& option, const std::string& text) {
    constexpr int kMost = 1 << 30;
    const auto isSane = [](const PixelBox& box) {
        for (int axis = 0; axis < 2; ++axis)
            if (std::abs(box.min[axis]) > kMost || std::abs(box.max[axis]) > kMost) return false;
        return !box.empty();
    };
    std::vector<int> n;
    if (readNumbers(text, {"", "x", "+-", "+-"}, n) && n[0] > 0 && n[1] > 0 && n[0] <= kMost &&
        n[1] <= kMost && std::abs(n[2]) <= kMost && std::abs(n[3]) <= kMost) {
        const PixelBox box{{n[2], n[3]}, {n[2] + n[0], n[3] + n[1]}};
        if (isSane(box)) return box;
    }
    n.clear();
    if (readNumbers(text, {"", ",", ",", ","}, n) && n[2] < kMost && n[3] < kMost) {
        const PixelBox box{{n[0], n[1]}, {n[2] + 1, n[3] + 1}};
        if (isSane(box)) return box;
    }
    throw Error(ErrorCode::kUsage, option, text,
                "WxH+X+Y or XMIN,YMIN,XMAX,YMAX, pixels of the picture, as oiiotool "
                "has it");
}

OverscanChoice parseOverscan(const std::string& option, const std::string& text) {
    OverscanChoice choice;
    try {
        if (!text.empty() && text.back() == '%') {
            choice.percent = number(0, 1000)(option, text.substr(0, text.size() - 1));
            return choice;
        }
        const std::vector<std::string> parts = splitAt(text, ',');
        if (parts.size() <= 2) {
            const auto pixels = wholeNumber(0, kMostOverscan);
            choice.pixels.x = int(pixels(option, parts.front()));
            choice.pixels.y = int(pixels(option, parts.back()));
            return choice;
        }
    } catch (const Error&) {
    }
    throw Error(ErrorCode::kUsage, option, text,
                "N pixels, X,Y or P%, each at most " + std::to_string(kMostOverscan) + " (1000 %)");
}

// A level only where one is given.
void parseCompression(const std::string& option, const std::string& text, ExrOptions& exr) {
    const std::vector<std::string> parts = splitAt(text, ':');
    exr.compression = choice(exrCompressions())(option, parts[0]);
    exr.level.reset();
    if (parts.size() > 2) {
        throw Error(ErrorCode::kUsage, option, text,
                    "a name, or a name, : and a level, as in dwaa:45");
    }
    if (parts.size() == 2) exr.level = number()(option, parts[1]);
}

}  // namespace

void addExrOptions(CLI::App& app, RenderCommand& command) {
    addExrFileOptions(app, command);
    OptionGroup group(app, "Output");
    group.addFlag("--multipart", command.image.exr.multipart,
                  "Store layers of --aov in parts of an .exr of their own, as many\n"
                  "programs read faster, not in one part with the picture");
    group.addValue("--overscan", "N|X,Y|P%", command.overscan,
                   Parser<OverscanChoice>(parseOverscan),
                   "Pixels beyond each side of the display window of an .exr, or a share\n"
                   "of its width and height");
}

void addExrFileOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Output");
    ExrOptions& exr = command.image.exr;
    const Parser<std::string> compression = [&exr](const std::string& option,
                                                   const std::string& text) {
        parseCompression(option, text, exr);
        return exr.compression;
    };
    group.addValue("--compression", "NAME[:LEVEL]", exr.compression, compression,
                   "How an .exr is packed: none, rle, zips, zip, piz, and with loss\n"
                   "pxr24, b44, b44a, dwaa, dwab; zip and zips have levels 1 to 9\n"
                   "(default 4), dwaa and dwab from 0 on (default 45: hardly to be seen);\n"
                   "a deep picture: zips (default: zip, of a deep one zips)");
    group.addFlag("--autocrop", exr.autocrop,
                  "Store of an .exr what is not clear, in a data window within the\n"
                  "display window of --size");
    group.addValue("--region", "WxH+X+Y", command.region, Parser<PixelBox>(parseRegion),
                   "Only these pixels, or those from XMIN,YMIN to XMAX,YMAX, counted from\n"
                   "the upper left: as they are in the whole picture, bit for bit. Of\n"
                   "an .exr its data window, of others all of the file");
}

void applyOverscan(RenderCommand& command) {
    if (!command.overscan.asked()) return;
    if (!isExr(command) && !command.slabs && !command.output.empty()) {
        throw Error(ErrorCode::kUsage, "--overscan", command.output.string(), "an .exr file");
    }
    CameraOptions& camera = command.picture.render.camera;
    camera.overscanPixels = command.overscan.of(camera.sizePixels);
}

void checkExr(const RenderCommand& command) {
    if (isExr(command)) checkExrOptions(command.image.exr, command.deep);
    if (!command.region) return;
    const CameraOptions& camera = command.picture.render.camera;
    const glm::ivec2 min = -camera.overscanPixels;
    const glm::ivec2 max = camera.sizePixels + camera.overscanPixels;
    const PixelBox& region = *command.region;
    const bool isWithin = region.min.x >= min.x && region.min.y >= min.y && region.max.x <= max.x &&
                          region.max.y <= max.y;
    if (isWithin) return;
    const auto text = [](glm::ivec2 place) {
        return std::to_string(place.x) + "," + std::to_string(place.y);
    };
    throw Error(ErrorCode::kUsage, "--region",
                "pixels " + text(region.min) + " to " + text(region.max - 1),
                "all of them among the picture's, " + text(min) + " to " + text(max - 1));
}

void warnOfUnusedExrOptions(const CLI::App& app, const RenderCommand& command,
                            ProgressDisplay& display) {
    if (command.image.exr.multipart && !command.channels.asked())
        display.warn("--multipart: has no effect without --aov");
    if (isExr(command)) return;
    for (const char* option : {"--autocrop", "--compression"})
        if (isGiven(app, option))
            display.warn(std::string(option) + ": has no effect but in an .exr");
}

void setExr(const RenderCommand& command, const Camera& camera, ImageFileOptions& file) {
    const glm::ivec2 overscan = camera.overscanPixels;
    file.exr.dataMin = -overscan;
    file.exr.displaySize = camera.sizePixels - 2 * overscan;
    // Values have no colours.
    if (storesValues(command)) file.exr.chromaticities.reset();
    if (command.region)
        file.region = PixelBox{command.region->min + overscan, command.region->max + overscan};
}

}  // namespace deltasplat
