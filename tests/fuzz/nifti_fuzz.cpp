// SPDX-License-Identifier: Apache-2.0
// Byte 0 chooses plain or gzip, what NaN becomes, and the second of several volumes; the rest is
// the file.
#include "fuzz/fuzz_target.h"
#include "unit/format_helpers.h"

namespace deltasplat::fuzz {

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    for (const int version : {1, 2}) {
        for (const bool bigEndian : {false, true}) {
            for (const int type : {2, 4, 16, 1024}) {
                testing::NiftiFile file;
                file.version = version;
                file.bigEndian = bigEndian;
                file.dims = {9, 5, 11};
                file.dataType = type;
                file.slope = type == 4 ? 0.5 : 0;
                file.qformCode = type == 2 ? 1 : 0;
                file.data = testing::bytesOf(testing::ramp<double>(495), bigEndian);
                inputs.push_back('\0' + file.bytes());
                if (type == 4) inputs.push_back('\1' + gzipped(file.bytes()));
                file.dims = {9, 5, 1, 11};
                inputs.push_back('\4' + file.bytes());
                if (type == 16) inputs.push_back('\5' + gzipped(file.bytes()));
            }
        }
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < 1 || size > (std::size_t{1} << 20)) return 0;
    ReadOptions options;
    if ((data[0] & 2) != 0) options.nanValue = 1.5;
    if ((data[0] & 4) != 0) options.volume = 1;
    const std::string extension = (data[0] & 1) != 0 ? ".nii.gz" : ".nii";
    fuzz::readAndCheck(fuzz::fileWith(extension, data + 1, size - 1), options);
    return 0;
}
