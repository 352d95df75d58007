// SPDX-License-Identifier: Apache-2.0
#include "image/encode_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/atomic_file.h"
#include "files/descriptor.h"
#include "image/exr_header.h"
#include "image/exr_pixels.h"
#include "image/exr_stream.h"
#include "image/seen_box.h"

namespace deltasplat {

namespace {

// Channels that lie in a part of their own, if there are several.
struct Part {
    std::string name;
    Imf::Header header;
    Imf::FrameBuffer pixels;
};

// What channels beside the picture's own have in the box.
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

// A layer is what stands before the dot.
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
        // Ends the file.
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
    Imath::V2i next_{0, 0};  // of the pixels to come, the first
};

}  // namespace

std::unique_ptr<ExrRowsFile> openExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels,
                                         const PixelBox& box, const ImageFileOptions& options) {
    return std::make_unique<RowsFile>(file, sizePixels, box, options);
}

}  // namespace deltasplat
