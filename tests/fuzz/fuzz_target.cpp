// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "deltasplat/error.h"
#include "deltasplat/render.h"
#include "volume/code_tree.h"

namespace deltasplat::fuzz {
namespace {

void check(const Volume& volume) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : volume.histogram()) sum += count;
    require(volume.histogram().size() == std::size_t(kCodeCount), "histogram has 65536 places");
    require(sum == volume.activeCount(), "histogram adds up to activeCount");
    require(volume.codes()->tree().activeVoxelCount() == volume.activeCount(),
            "tree has activeCount");
    require(volume.valueMin() <= volume.valueMax(), "valueMin <= valueMax");
    require(volume.empty() || std::uint64_t(volume.box().voxels()) >= volume.activeCount(),
            "box holds all active voxels");
}

std::uint64_t& digestSum() {
    static std::uint64_t sum = 0;
    return sum;
}

// Based on: FNV-1a (Fowler, Noll, Vo), 64 bits.
template <typename T>
void digest(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) digestSum() = (digestSum() ^ byte) * 0x100000001b3;
}

void digest(const Volume& volume) {
    digest(volume.box().dims());
    digest(volume.worldFromIndex());
    for (auto voxel = volume.codes()->tree().cbeginValueOn(); voxel; ++voxel) {
        digest(voxel.getCoord().asVec3i());
        digest(volume.codeBook().valueOf(voxel.getValue()));
    }
}

// Renders what is small enough to be done in a moment.
void renderSmall(const Volume& volume) {
    const glm::ivec3 dims = volume.box().dims();
    const int longest = std::max({dims.x, dims.y, dims.z});
    if (volume.activeCount() >= 1'000'000 || longest >= 256) return;
    RenderOptions options;
    options.camera.sizePixels = {8, 8};
    options.optics.transferFunction = defaultRamp(volume);
    const RenderResult result = render(volume, options);
    for (const float value : result.image.rgba) {
        require(std::isfinite(value), "finite pixels");
        digest(value);
    }
}

}  // namespace

void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

void expectErrorsOfOneLine(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        const std::string line = error.what();
        const bool one = !line.empty() && line.find('\n') == std::string::npos;
        if (!one) std::fprintf(stderr, "got: %s\n", line.c_str());
        require(one, "errors are one line");
    } catch (const std::exception& error) {
        require(false, error.what());
    }
}

std::string gzipped(const std::string& bytes) {
    std::string out(bytes.size() + 200, '\0');
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

std::string fileWith(const std::string& extension, const std::uint8_t* data, std::size_t size) {
    const std::string path = (std::filesystem::temp_directory_path() /
                              ("deltasplat_fuzz_" + std::to_string(getpid()) + extension))
                                 .string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), std::streamsize(size));
    return path;
}

std::uint64_t takeDigest() {
    return std::exchange(digestSum(), 0);
}

void readAndCheck(const std::string& file, const ReadOptions& options) {
    expectErrorsOfOneLine([&] {
        for (const Volume& volume : readAllVolumes(file, options)) {
            check(volume);
            digest(volume);
            renderSmall(volume);
        }
    });
    std::filesystem::remove(file);
}

}  // namespace deltasplat::fuzz
