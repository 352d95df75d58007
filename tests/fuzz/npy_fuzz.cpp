// SPDX-License-Identifier: Apache-2.0
// Byte 0 chooses the second of several volumes, the rest is a .npy file.
#include "fuzz/fuzz_target.h"
#include "unit/format_helpers.h"

namespace deltasplat::fuzz {

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    for (const std::string type : {"|u1", "<u2", ">f2", "<f4", "<i8", ">f8"}) {
        for (const std::string shape : {"(5, 11, 9)", "(495,)", "(2, 5, 11, 9)"}) {
            const bool several = shape[1] == '2';
            std::string text =
                "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape;
            text.resize(117, ' ');
            text += "}\n";
            const std::size_t bytes = std::size_t(type[2] - '0') * 495 * (several ? 2 : 1);
            inputs.push_back((several ? '\1' : '\0') + std::string("\x93NUMPY\1\0", 8) +
                             char(text.size()) + '\0' + text +
                             testing::bytesOf(testing::ramp<std::uint8_t>(bytes, 0, 0.1)));
        }
    }
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < 1 || size > (std::size_t{1} << 20)) return 0;
    ReadOptions options;
    options.nanValue = 1.5;
    if ((data[0] & 1) != 0) options.volume = 1;
    fuzz::readAndCheck(fuzz::fileWith(".npy", data + 1, size - 1), options);
    return 0;
}
