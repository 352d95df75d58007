// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "image/encode_image.h"
#include "image/quantize.h"
#include "image/seen_box.h"
#include "modules/image_module.h"

namespace deltasplat {
namespace {

// The most bytes of an image description that fit into a segment of a .jpg, besides all else.
constexpr std::size_t kMaxJpegText = 30000;
constexpr const char* kJpegCompression = "jpeg:95";

// @param size  of the picture
PixelBox regionOf(const ImageFileOptions& options, glm::ivec2 size) {
    return options.region.value_or(PixelBox{{0, 0}, size});
}

// For formats that have no names of one's own.
std::string description(const ImageFileOptions& options) {
    std::string lines;
    for (const auto& [name, text] : options.metadata) {
        if (!lines.empty()) lines += '\n';
        lines.append("deltasplat:").append(name).append(": ").append(text);
    }
    return lines;
}

// OpenImageIO does not live through an empty one.
void addDescription(const std::string& text, OIIO::ImageSpec& spec) {
    if (!text.empty()) spec.attribute("ImageDescription", text);
}

// Encodes some of a picture's pixels, as many as `spec` says.
// @param values  of all, `[height][width][spec.nchannels]`
template <typename Value>
std::string encode(const std::filesystem::path& file, const char* formatName,
                   const OIIO::ImageSpec& spec, const std::vector<Value>& values, int width,
                   glm::ivec2 first) {
    const auto channels = std::size_t(spec.nchannels);
    const std::size_t pixel = std::size_t(first.y) * std::size_t(width) + std::size_t(first.x);
    const auto stride = OIIO::stride_t(channels * sizeof(Value));
    return encodeInMemory(file, formatName, spec, [&](OIIO::ImageOutput& output) {
        return output.write_image(OIIO::BaseTypeFromC<Value>::value, &values[channels * pixel],
                                  stride, stride * width);
    });
}

void addChannels(const std::vector<ImageChannel>& channels, OIIO::ImageSpec& spec) {
    spec.channelformats.assign(4, spec.format);
    for (const ImageChannel& channel : channels) {
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(OIIO::TypeFloat);
        if (channel.name == "Z") spec.z_channel = spec.nchannels;
        ++spec.nchannels;
    }
}

// Returns all channels of each pixel after the other.
std::vector<float> besideChannels(const std::vector<float>& rgba,
                                  const std::vector<ImageChannel>& channels) {
    const std::size_t pixels = rgba.size() / 4;
    std::vector<float> all;
    all.reserve(pixels * (4 + channels.size()));
    for (std::size_t i = 0; i < pixels; ++i) {
        all.insert(all.end(), &rgba[4 * i], &rgba[4 * i] + 4);
        for (const ImageChannel& channel : channels) all.push_back(finiteValue(channel.values[i]));
    }
    return all;
}

// Channels of one name before the dot.
struct ExrLayer {
    std::string name;
    std::vector<const ImageChannel*> channels;
};

std::vector<ExrLayer> layersOf(const std::vector<ImageChannel>& channels) {
    std::vector<ExrLayer> layers;
    for (const ImageChannel& channel : channels) {
        const std::string name =
            channel.name == "Z" ? "depth" : channel.name.substr(0, channel.name.find('.'));
        if (layers.empty() || layers.back().name != name) layers.push_back({name, {}});
        layers.back().channels.push_back(&channel);
    }
    return layers;
}

// Values of channels, pixel by pixel of a part.
std::vector<float> valuesIn(const PixelBox& box, int width, const ExrLayer& layer) {
    std::vector<float> values;
    for (int y = box.min.y; y < box.max.y; ++y) {
        for (int x = box.min.x; x < box.max.x; ++x) {
            const auto i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            for (const ImageChannel* channel : layer.channels)
                values.push_back(finiteValue(channel->values[i]));
        }
    }
    return values;
}

// The picture in one part, and its layers in others.
std::string encodeMultipart(const std::filesystem::path& file, const Image& image,
                            const PixelBox& box, OIIO::ImageSpec spec,
                            const ImageFileOptions& options) {
    spec.attribute("oiio:subimagename", "rgba");
    std::vector<OIIO::ImageSpec> specs{spec};
    const std::vector<ExrLayer> layers = layersOf(options.channels);
    for (const ExrLayer& layer : layers) {
        OIIO::ImageSpec& part = specs.emplace_back(spec);
        part.attribute("oiio:subimagename", layer.name);
        part.set_format(OIIO::TypeFloat);
        part.nchannels = int(layer.channels.size());
        part.alpha_channel = -1;
        part.channelnames.clear();
        for (const ImageChannel* channel : layer.channels)
            part.channelnames.push_back(channel->name);
        if (layer.channels[0]->name == "Z") part.z_channel = 0;
    }
    return encodeParts(file, specs, [&](OIIO::ImageOutput& output, std::size_t i) {
        if (i > 0) {
            const std::vector<float> values = valuesIn(box, image.size.x, layers[i - 1]);
            return output.write_image(OIIO::TypeFloat, values.data());
        }
        const std::vector<float> values = finiteValues(image, options.floatExr);
        const OIIO::stride_t stride = 4 * sizeof(float);
        const auto first =
            std::size_t(box.min.y) * std::size_t(image.size.x) + std::size_t(box.min.x);
        return output.write_image(OIIO::TypeFloat, &values[4 * first], stride,
                                  stride * image.size.x);
    });
}

std::string encodeExr(const std::filesystem::path& file, const Image& image,
                      const ImageFileOptions& options) {
    const PixelBox box = storedBox(options, image.size, [&](const PixelBox& part) {
        return seenBox(image, part, options.channels);
    });
    OIIO::ImageSpec spec = exrSpec(box.size(), options);
    setWindows(options.exr, image.size, box.min, spec);
    if (options.exr.multipart && !options.channels.empty())
        return encodeMultipart(file, image, box, spec, options);
    std::vector<float> values = finiteValues(image, options.floatExr);
    if (!options.channels.empty()) {
        addChannels(options.channels, spec);
        values = besideChannels(values, options.channels);
    }
    return encode(file, "openexr", spec, values, image.size.x, box.min);
}

template <typename Sample>
std::string encodeStraight(const std::filesystem::path& file, const char* formatName,
                           const Image& image, OIIO::ImageSpec spec,
                           const ImageFileOptions& options) {
    // The samples are final: OpenImageIO must not divide them by alpha once more.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return encode(file, formatName, spec,
                  straightSrgb<Sample>(image, options.dither && sizeof(Sample) == 1), image.size.x,
                  regionOf(options, image.size).min);
}

std::string encodeStraight(const std::filesystem::path& file, const char* formatName,
                           const Image& image, const OIIO::ImageSpec& spec,
                           const ImageFileOptions& options) {
    return options.bits == 16
               ? encodeStraight<std::uint16_t>(file, formatName, image, spec, options)
               : encodeStraight<std::uint8_t>(file, formatName, image, spec, options);
}

OIIO::TypeDesc sampleType(const ImageFileOptions& options) {
    return options.bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8;
}

std::string encodeTiff(const std::filesystem::path& file, const Image& image,
                       const ImageFileOptions& options) {
    OIIO::ImageSpec spec = rgbaSpec(regionOf(options, image.size).size(), sampleType(options));
    spec.attribute("compression", "zip");
    addDescription(description(options), spec);
    // Without a date OpenImageIO stores the clock time. A colour space it would put into a second
    // directory, whose place OpenImageIO 2.4 stores as the first one's: sRGB is what is assumed.
    spec.attribute("DateTime", "");
    return encodeStraight(file, "tiff", image, spec, options);
}

std::string encodeJpeg(const std::filesystem::path& file, const Image& image,
                       const ImageFileOptions& options) {
    const PixelBox part = regionOf(options, image.size);
    OIIO::ImageSpec spec(part.size().x, part.size().y, 3, OIIO::TypeUInt8);
    spec.attribute("compression", kJpegCompression);
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("oiio:ColorSpace", "sRGB");
    addDescription(description(options).substr(0, kMaxJpegText), spec);
    return encode(file, "jpeg", spec, opaqueSrgb(image, options.dither), image.size.x, part.min);
}

}  // namespace

std::string image_module::encodeImage(const std::filesystem::path& file, const Image& image,
                                      const ImageFileOptions& options) {
    const ImageFormat format = imageFormatOf(file);
    if (format == ImageFormat::kExr) return encodeExr(file, image, options);
    return format == ImageFormat::kTiff ? encodeTiff(file, image, options)
                                        : encodeJpeg(file, image, options);
}

}  // namespace deltasplat
