// SPDX-License-Identifier: Apache-2.0
// Bytes 0..5 choose the options, the rest is the file, plain or gzip.
#include "fuzz/fuzz_target.h"

namespace deltasplat::fuzz {
namespace {

constexpr const char* kTypes[] = {"uint8",  "int8",  "uint16",  "int16",
                                  "uint32", "int32", "float32", "float64"};
constexpr std::size_t kHeader = 6;

}  // namespace

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    for (int type = 0; type < 8; ++type) {
        const int valueBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
        std::string voxels(std::size_t(9 * 8 * 17 * valueBytes[type]), '\0');
        for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = char(i * i * 31 >> 6 & 63);
        for (const char flags : {0, 1, 2, 3, 5}) {
            const std::string header{char(type), flags, 9, 8, 17, 0};
            inputs.push_back(header + ((flags & 1) != 0 ? gzipped(voxels) : voxels));
        }
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < fuzz::kHeader || size > (std::size_t{1} << 20)) return 0;
    const bool gzip = (data[1] & 1) != 0;
    ReadOptions options;
    options.raw.type = fuzz::kTypes[data[0] % 8];
    options.raw.bigEndian = (data[1] & 2) != 0;
    if ((data[1] & 4) != 0) options.nanValue = 1.5;
    options.raw.dims = {data[2], data[3], data[4]};
    options.raw.skipBytes = data[5];
    const std::string file =
        fuzz::fileWith(gzip ? ".raw.gz" : ".raw", data + fuzz::kHeader, size - fuzz::kHeader);
    fuzz::readAndCheck(file, options);
    return 0;
}
