// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>

#include "base/default_floats.h"
#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/hold_out.h"
#include "deltasplat/progress.h"
#include "files/file_name.h"
#include "modules/image_module.h"
#include "oiio/image_file.h"

namespace deltasplat {
namespace {

// What renderers write where there is nothing, and more.
constexpr float kNothing = 1e10f;

// The last part of a layer's name: "depth" of "ViewLayer.Depth.Z".
std::string layerOf(const std::string& channel) {
    const std::string layer = channel.substr(0, channel.rfind('.'));
    return layer.substr(layer.rfind('.') + 1);
}

int depthChannel(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
    const auto find = [&](const auto& suits) {
        for (int i = 0; i < spec.nchannels; ++i)
            if (suits(lowerCase(spec.channelnames[std::size_t(i)]))) return i;
        return -1;
    };
    int found = find([](const std::string& name) { return name == "z"; });
    if (found < 0) found = find([](const std::string& name) { return name == "depth"; });
    if (found < 0) {
        found = find([](const std::string& name) {
            return name.ends_with(".z") && layerOf(name).find("depth") != std::string::npos;
        });
    }
    if (found < 0 && spec.nchannels == 1) found = 0;
    if (found >= 0) return found;
    refuseFile(file, sizeText(spec), "a channel Z");
}

}  // namespace

DepthImage image_module::readDepthImage(const std::filesystem::path& file,
                                        const Listener& listener) {
    const DefaultFloats floats;
    if (lowerExtension(file) != ".exr")
        refuseFile(file, "another format", "an .exr with a channel Z");
    const ImagePages pages(file);
    ImageFile image(file, pages, 0);
    const OIIO::ImageSpec& spec = image.spec();
    requireSane(file, spec);
    const int channel = depthChannel(file, spec);
    DepthImage result{{spec.width, spec.height}, {}};
    const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    const auto channels = std::size_t(channel) + 1;
    requireClaimedMemory(file.string(), 4.0 * double(pixels) * double(channels + 1));
    std::vector<float> values(pixels * channels);
    image.read(int(channels), OIIO::TypeDesc::FLOAT, values.data());
    result.depths.resize(pixels);
    std::size_t odd = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        float& depth = result.depths[i];
        depth = values[i * channels + channels - 1];
        if (!(depth > 0)) ++odd;
        if (!(depth > 0) || depth >= kNothing) depth = std::numeric_limits<float>::infinity();
    }
    if (odd > 0) {
        listener.warn(file.string() + ": " +
                      countText(std::uint64_t(odd), "pixel whose depth is not above 0 stands",
                                "pixels whose depth is not above 0 stand") +
                      " for nothing there");
    }
    return result;
}

}  // namespace deltasplat
