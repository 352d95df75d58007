// SPDX-License-Identifier: Apache-2.0
// The whole input is one DICOM slice.
#include "fuzz/fuzz_target.h"
#include "unit/dicom_helpers.h"

namespace deltasplat::fuzz {

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    testing::DicomFile file;
    file.thickness = "3";
    inputs.push_back(file.bytes());
    file.slope = "0.5";
    file.intercept = "-1000";
    file.isSigned = true;
    inputs.push_back(file.bytes());
    file.columns = 40;
    file.rows = 30;
    file.pixels.assign(1200, 7);
    inputs.push_back(file.bytes());
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size > (std::size_t{1} << 20)) return 0;
    fuzz::readAndCheck(fuzz::fileWith(".dcm", data, size), {});
    return 0;
}
