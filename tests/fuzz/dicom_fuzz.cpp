// SPDX-License-Identifier: Apache-2.0
// The whole input is one DICOM slice.
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "fuzz/fuzz_target.h"
#include "unit/dicom_helpers.h"

namespace deltasplat::fuzz {
namespace {

std::string imageBytes(const std::string& extension, const OIIO::ImageSpec& spec) {
    const std::string path = fileWith(".seed" + extension, nullptr, 0);
    std::vector<float> pixels(std::size_t(spec.width) * std::size_t(spec.height));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = float(i * i % 97) / 97;
    auto out = OIIO::ImageOutput::create(path);
    if (!out || !out->open(path, spec)) return "";
    out->write_image(OIIO::TypeDesc::FLOAT, pixels.data());
    out->close();
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    std::remove(path.c_str());
    return bytes.str();
}

// Pixels as JPEG and JPEG 2000.
void addPacked(testing::DicomFile file, std::vector<std::string>& inputs) {
    file.bits = 8;
    file.syntax = "1.2.840.10008.1.2.4.50";
    const OIIO::ImageSpec small(file.columns, file.rows, 1, OIIO::TypeDesc::UINT8);
    file.fragments = {imageBytes(".jpg", small)};
    inputs.push_back(file.bytes());
    file.bits = 16;
    file.syntax = "1.2.840.10008.1.2.4.90";
    const OIIO::ImageSpec deep(file.columns, file.rows, 1, OIIO::TypeDesc::UINT16);
    file.fragments = {imageBytes(".j2k", deep)};
    if (!file.fragments[0].empty()) inputs.push_back(file.bytes());
}

}  // namespace

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
    addPacked(file, inputs);
    file.syntax = "1.2.840.10008.1.2.5";
    // One segment a byte of a pixel, of runs of 100 equal ones.
    std::string runs;
    for (int i = 0; i < 12; ++i) runs += std::string(1, char(-99)) + char(i);
    const std::uint32_t size = std::uint32_t(runs.size());
    std::vector<std::uint32_t> table(16, 0);
    table[0] = 2;
    table[1] = 64;
    table[2] = 64 + size;
    file.fragments = {testing::bytesOf(table) + runs + runs};
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
