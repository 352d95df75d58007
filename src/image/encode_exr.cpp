// SPDX-License-Identifier: Apache-2.0
#include "image/encode_exr.h"

#include <Imath/ImathVec.h>
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/image/exr_rows.h"
#include "deltasplat/image/image.h"
#include "deltasplat/image/pixel_box.h"
#include "files/file_bytes.h"
#include "image/exr_header.h"
#include "image/quantize.h"

namespace deltasplat {

namespace {

void addRgba(bool asFloat, Imf::Header& header);

/// Pixels in .exr form: finite halves or floats.
class ExrRgba {
  public:
    /// Multi-threaded.
    ExrRgba(const Image& image, const PixelBox& box, bool asFloat);

    /// Returns the layout for OpenEXR, valid while this object lives.
    /// @param first  the first pixel's place in the file's data window
    Imf::FrameBuffer at(const Imath::V2i& first) const;

  private:
    glm::ivec2 size_;
    std::vector<half> halves_;   // [height][width][4], or none
    std::vector<float> floats_;  // the same
};

/// Returns a box of a channel's values, made finite.
/// @param width  of the whole channel
std::vector<float> exrPlane(const std::vector<float>& values, const PixelBox& box, int width);

namespace {

constexpr std::size_t kChannels = 4;
constexpr const char* kNames[kChannels]{"R", "G", "B", "A"};

// Whether all channels are +0.
bool isClear(const float* pixel) {
    std::uint64_t bits[2];
    std::memcpy(bits, pixel, sizeof bits);
    return (bits[0] | bits[1]) == 0;
}

template <typename Value>
std::vector<Value> finite(const Image& image, const PixelBox& box, float largest) {
    const std::size_t rowValues = kChannels * std::size_t(box.size().x);
    std::vector<Value> values(rowValues * std::size_t(box.size().y));
    parallelFor(std::size_t(box.size().y), [&](std::size_t y) {
        const float* const from = image.pixel(box.min.x, box.min.y + int(y));
        Value* const to = &values[rowValues * y];
        for (std::size_t i = 0; i < rowValues; i += kChannels) {
            // Most pixels of most pictures are clear, as `values` is initially.
            if (isClear(from + i)) continue;
            for (std::size_t c = i; c < i + kChannels; ++c)
                to[c] = Value(finiteValue(from[c], largest));
        }
    });
    return values;
}

}  // namespace

void addRgba(bool asFloat, Imf::Header& header) {
    for (const char* name : kNames)
        header.channels().insert(name, Imf::Channel(asFloat ? Imf::FLOAT : Imf::HALF));
}

ExrRgba::ExrRgba(const Image& image, const PixelBox& box, bool asFloat) : size_(box.size()) {
    if (asFloat) {
        floats_ = finite<float>(image, box, std::numeric_limits<float>::max());
    } else {
        halves_ = finite<half>(image, box, kLargestHalf);
    }
}

Imf::FrameBuffer ExrRgba::at(const Imath::V2i& first) const {
    Imf::FrameBuffer pixels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto insert = [&](Imf::PixelType type, const auto& values) {
            const std::size_t stride = kChannels * sizeof values[0];
            pixels.insert(kNames[c], Imf::Slice::Make(type, &values[c], first, size_.x, size_.y,
                                                      stride, stride * std::size_t(size_.x)));
        };
        halves_.empty() ? insert(Imf::FLOAT, floats_) : insert(Imf::HALF, halves_);
    }
    return pixels;
}

std::vector<float> exrPlane(const std::vector<float>& values, const PixelBox& box, int width) {
    const auto columns = std::size_t(box.size().x);
    std::vector<float> plane(columns * std::size_t(box.size().y));
    parallelFor(std::size_t(box.size().y), [&](std::size_t y) {
        const float* const from =
            &values[(std::size_t(box.min.y) + y) * std::size_t(width) + std::size_t(box.min.x)];
        for (std::size_t x = 0; x < columns; ++x) plane[columns * y + x] = finiteValue(from[x]);
    });
    return plane;
}

// One part of the file, with some of the channels.
struct Part {
    std::string name;
    Imf::Header header;
    Imf::FrameBuffer pixels;
};

class ChannelPlanes {
  public:
    ChannelPlanes(const std::vector<ImageChannel>& channels, const PixelBox& box, int width) {
        for (const ImageChannel& channel : channels)
            planes_.push_back(exrPlane(channel.values, box, width));
    }

    void add(std::size_t i, const std::string& name, Part& part) const {
        part.header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        part.pixels.insert(
            name, Imf::Slice::Make(Imf::FLOAT, planes_[i].data(), part.header.dataWindow()));
    }

  private:
    std::vector<std::vector<float>> planes_;
};

// The layer is the name before the dot.
std::string layerOf(const ImageChannel& channel) {
    return channel.name == "Z" ? "depth" : channel.name.substr(0, channel.name.find('.'));
}

void writeOnePart(const Part& part, int rows, Imf::OStream& to) {
    Imf::OutputFile file(to, part.header);
    file.setFrameBuffer(part.pixels);
    file.writePixels(rows);
}

void writeParts(std::vector<Part>& parts, int rows, Imf::OStream& to) {
    std::vector<Imf::Header> headers;
    for (Part& part : parts) {
        part.header.setName(part.name);
        part.header.setType(Imf::SCANLINEIMAGE);
        headers.push_back(part.header);
    }
    Imf::MultiPartOutputFile file(to, headers.data(), int(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Imf::OutputPart output(file, int(i));
        output.setFrameBuffer(parts[i].pixels);
        output.writePixels(rows);
    }
}

}  // namespace

std::string encodeExr(const std::filesystem::path& file, const Image& image,
                      const ImageFileOptions& options) {
    const PixelBox box = storedBox(options, image.size, [&](const PixelBox& part) {
        return seenBox(image, part, options.channels);
    });
    const ExrRgba rgba(image, box, options.floatExr);
    const ChannelPlanes planes(options.channels, box, image.size.x);
    ExrMemoryStream memory(file);
    writeExr(file, [&] {
        const Imf::Header header = exrHeader(options, image.size, box, "zip");
        std::vector<Part> parts{{"rgba", header, rgba.at(header.dataWindow().min)}};
        addRgba(options.floatExr, parts[0].header);
        for (std::size_t i = 0; i < options.channels.size(); ++i) {
            const ImageChannel& channel = options.channels[i];
            if (options.exr.multipart && parts.back().name != layerOf(channel))
                parts.push_back({layerOf(channel), header, {}});
            planes.add(i, channel.name, parts.back());
        }
        const int rows = box.size().y;
        parts.size() == 1 ? writeOnePart(parts[0], rows, memory) : writeParts(parts, rows, memory);
    });
    return memory.takeBytes();
}

namespace {

class RowsFile : public ExrRowsFile {
  public:
    RowsFile(const std::filesystem::path& path, glm::ivec2 sizePixels, const PixelBox& box,
             const ImageFileOptions& options)
        : file_(path), asFloat_(options.floatExr), stream_(path, file_.descriptor()) {
        if (file_.isDevice()) {
            throw Error(ErrorCode::kOutput, path.string(), "a device",
                        "a file, for a picture in parts");
        }
        writeExr(path, [&] {
            Imf::Header header = exrHeader(options, sizePixels, box, "zip");
            addRgba(asFloat_, header);
            next_ = header.dataWindow().min;
            output_.emplace(stream_, header);
        });
    }

    void write(const Image& rows) override {
        const ExrRgba pixels(rows, {{0, 0}, rows.size}, asFloat_);
        writeExr(file_.finalPath(), [&] {
            output_->setFrameBuffer(pixels.at(next_));
            output_->writePixels(rows.size.y);
        });
        check();
        next_.y += rows.size.y;
    }

    void finish() override {
        // Writes the end of the file.
        output_.reset();
        check();
        file_.commit();
    }

  private:
    void check() const {
        if (stream_.problem() != 0) throwCannotWrite(file_.finalPath(), stream_.problem());
    }

    AtomicFile file_;
    bool asFloat_;
    ExrFileStream stream_;
    std::optional<Imf::OutputFile> output_;
    Imath::V2i next_{0, 0};  // the next row's first pixel
};

}  // namespace

std::unique_ptr<ExrRowsFile> openExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels,
                                         const PixelBox& box, const ImageFileOptions& options) {
    return std::make_unique<RowsFile>(file, sizePixels, box, options);
}

struct ExrRows::Impl {
    PixelBox box;
    std::unique_ptr<ExrRowsFile> file;
    int done = 0;  // rows
};

ExrRows::ExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels, const PixelBox& box,
                 const ImageFileOptions& options) {
    const DefaultFloats floats;
    const auto refuse = [&](const std::string& got, const std::string& expected) {
        throw Error(ErrorCode::kUsage, file.string(), got, expected);
    };
    if (imageFormatOf(file) != ImageFormat::kExr) refuse("a picture in parts", "an .exr file");
    if (!options.channels.empty()) refuse("other channels besides", "a picture alone");
    ImageFileOptions stored = options;
    stored.region = box;
    checkImageFile(file, sizePixels, stored);
    impl_ = std::make_unique<Impl>();
    impl_->box = box;
    impl_->file = openExrRows(file, sizePixels, box, stored);
}
ExrRows::~ExrRows() = default;

void ExrRows::write(const Image& rows) {
    const DefaultFloats floats;
    const glm::ivec2 left(impl_->box.size().x, impl_->box.size().y - impl_->done);
    if (rows.size.x != left.x || rows.size.y > left.y || rows.size.y < 1) {
        throw Error(ErrorCode::kUsage, "rows of a picture", dimsText(rows.size),
                    "some of " + dimsText(left));
    }
    impl_->file->write(rows);
    impl_->done += rows.size.y;
}

void ExrRows::finish() {
    if (impl_->done != impl_->box.size().y) {
        throw Error(ErrorCode::kUsage, "rows of a picture", std::to_string(impl_->done),
                    std::to_string(impl_->box.size().y));
    }
    impl_->file->finish();
}

}  // namespace deltasplat
