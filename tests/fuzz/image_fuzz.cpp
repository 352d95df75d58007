// SPDX-License-Identifier: Apache-2.0
// Byte 0 chooses the kind of image, the rest is the file.
#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "fuzz/fuzz_target.h"

namespace deltasplat::fuzz {
namespace {

constexpr std::array<const char*, 6> kExtensions{".tif", ".png", ".jpg", ".bmp", ".pgm", ".exr"};

std::string imageBytes(const std::string& extension, int channels, OIIO::TypeDesc type, int pages,
                       const std::string& compression) {
    const std::string path = fileWith(".seed" + extension, nullptr, 0);
    // What fits into 1 KiB comes from a store of malloc's that ClearedMemory does not reach.
    const int width = extension == ".exr" ? 67 : 19;
    const int height = extension == ".exr" ? 41 : 11;
    OIIO::ImageSpec spec(width, height, channels, type);
    if (!compression.empty()) spec.attribute("compression", compression);
    spec.attribute("DateTime", "2000:01:01 00:00:00");  // not the time of day
    const std::vector<OIIO::ImageSpec> specs(std::size_t(pages), spec);
    auto out = OIIO::ImageOutput::create(path);
    out->open(path, pages, specs.data());
    std::vector<float> pixels(std::size_t(width * height * channels));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = float(i * i % 97) / 97;
    for (int page = 0; page < pages; ++page) {
        if (page > 0) out->open(path, spec, OIIO::ImageOutput::AppendSubimage);
        out->write_image(OIIO::TypeDesc::FLOAT, pixels.data());
    }
    out->close();
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    std::remove(path.c_str());
    return bytes.str();
}

}  // namespace

std::vector<std::string> seeds() {
    using OIIO::TypeDesc;
    std::vector<std::string> inputs;
    const auto add = [&](char kind, int channels, OIIO::TypeDesc type, int pages,
                         const std::string& compression) {
        inputs.push_back(
            kind + imageBytes(kExtensions[std::size_t(kind)], channels, type, pages, compression));
    };
    for (const char* compression : {"none", "lzw", "zip", "packbits"}) {
        add(0, 1, TypeDesc::UINT16, 3, compression);
        add(0, 3, TypeDesc::UINT8, 1, compression);
    }
    add(0, 1, TypeDesc::FLOAT, 2, "zip");
    add(1, 1, TypeDesc::UINT8, 1, "");
    add(1, 4, TypeDesc::UINT16, 1, "");
    add(2, 1, TypeDesc::UINT8, 1, "");
    add(2, 3, TypeDesc::UINT8, 1, "");
    add(3, 3, TypeDesc::UINT8, 1, "");
    add(4, 1, TypeDesc::UINT8, 1, "");
    for (const char* compression : {"none", "zip", "piz"}) {
        add(5, 1, TypeDesc::HALF, 1, compression);
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < 1 || size > (std::size_t{1} << 20)) return 0;
    ReadOptions options;
    options.nanValue = 1.5;
    const char* extension = fuzz::kExtensions[data[0] % fuzz::kExtensions.size()];
    fuzz::readAndCheck(fuzz::fileWith(extension, data + 1, size - 1), options);
    return 0;
}
