// SPDX-License-Identifier: Apache-2.0
// A whole picture in a file of its slabs' layers. Checksums and the header's length are made right
// before it is read, for else nothing behind them would be.
#include <zlib.h>

#include <cstring>
#include <filesystem>

#include "deltasplat/slabs.h"
#include "fuzz/fuzz_target.h"
#include "support/some_scene.h"
#include "unit/temp_folder.h"

namespace deltasplat::fuzz {
namespace {

constexpr std::size_t kLine = 19;  // "deltasplat slabs 4\n"

std::uint32_t numberAt(const std::string& bytes, std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, &bytes[at], sizeof number);
    return number;
}

void setNumber(std::string& bytes, std::size_t at, std::uint32_t number) {
    std::memcpy(&bytes[at], &number, sizeof number);
}

std::uint32_t checksum(const std::string& bytes, std::size_t at, std::size_t size) {
    return std::uint32_t(::crc32(0, reinterpret_cast<const Bytef*>(&bytes[at]), uInt(size)));
}

// The header ends where a brace does that bytes other than text follow.
std::string repaired(std::string bytes) {
    const std::size_t text = kLine + 8;
    if (bytes.size() <= text) return bytes;
    std::size_t end = text;
    while (end < bytes.size() && bytes[end] >= ' ' && bytes[end] < 127) ++end;
    end = std::max(text, bytes.rfind('}', end - 1) + 1);
    setNumber(bytes, kLine, std::uint32_t(end - text));
    setNumber(bytes, kLine + 4, checksum(bytes, text, end - text));
    for (std::size_t at = end; at + 12 <= bytes.size();) {
        const std::size_t size = numberAt(bytes, at + 4);
        if (size > bytes.size() - at - 12) break;
        setNumber(bytes, at + 8, checksum(bytes, at + 12, size));
        at += 12 + size;
    }
    return bytes;
}

void foldAndShow(const std::string& file) {
    const std::filesystem::path parts[] = {file};
    Picture folded = SlabFiles(parts).fold();
    const glm::ivec2 size = folded.camera().sizePixels;
    if (size.x > 64 || size.y > 64) return;
    Image image(size);
    folded.show({{0, 0}, size}, image);
}

}  // namespace

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    const test::TempFolder folder;
    std::vector<CameraOptions> cameras = test::someCameras();
    for (const test::Colors colors : {test::Colors::kOne, test::Colors::kSeveral}) {
        const PreparedScene scene({test::someVolume(), test::someOptics(colors)}, SplatOptions());
        for (const std::size_t i : {1, 5, 8}) {
            cameras[i].sizePixels = {16, 8};
            writeSlabs(SlabPicture(scene, test::cameraOf(*scene.scene().volume, cameras[i])), {},
                       {}, folder / "seed");
            inputs.push_back(test::readBytes(folder / "seed"));
        }
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size > (std::size_t{1} << 18)) return 0;
    const std::string bytes = fuzz::repaired({reinterpret_cast<const char*>(data), size});
    const std::string file =
        fuzz::fileWith(".slabs", reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    fuzz::expectErrorsOfOneLine([&] { fuzz::foldAndShow(file); });
    std::filesystem::remove(file);
    return 0;
}
