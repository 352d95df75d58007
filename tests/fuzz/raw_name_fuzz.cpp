// SPDX-License-Identifier: Apache-2.0
// Lines: the name of a .raw file, then the texts of --dims, --type, --skip-bytes, --spacing and
// --origin, each empty where it is not given.
#include <limits>
#include <optional>
#include <sstream>

#include "../tools/options/parse.h"
#include "formats/raw/raw_format.h"
#include "fuzz/fuzz_target.h"

namespace deltasplat::fuzz {
namespace {

// Takes a line; leaves `value` alone if it is empty.
template <typename T, typename Value>
void take(std::istream& lines, const char* option, const Parser<T>& parser, Value& value) {
    std::string text;
    if (std::getline(lines, text) && !text.empty()) value = parser(option, text);
}

void check(const RawLayout& layout) {
    for (int axis = 0; axis < 3; ++axis) {
        require(layout.dims[axis] >= 1 && layout.dims[axis] <= std::int64_t{1} << 30,
                "dims within 1..2^30");
    }
    const double bytes = double(layout.dims.x) * double(layout.dims.y) * double(layout.dims.z) *
                         rawTypeBytes(layout.type);
    require(bytes <= 0x1p63 && double(layout.dataBytes()) == bytes, "bytes fit into 63 bits");
    constexpr auto kMost = std::uint64_t(std::numeric_limits<std::int64_t>::max());
    require(layout.skipBytes <= kMost - layout.dataBytes(), "the end fits into 63 bits");
}

void resolve(const std::string& input) {
    std::istringstream lines(input);
    std::string name;
    std::getline(lines, name);
    RawFormat format;
    take(lines, "--dims", dimensions(), format.dims);
    take(lines, "--type", anyText(), format.type);
    take(lines, "--skip-bytes", wholeNumber(), format.skipBytes);
    take(lines, "--spacing", voxelSpacing(), format.spacing);
    take(lines, "--origin", vector3(), format.origin);
    requireGeometry(format);
    check(resolveRawLayout(name, format));
}

}  // namespace

std::vector<std::string> seeds() {
    return {"engine_256x256x128_uint8.raw.gz",
            "dir/tooth_103x94x161_uint16be.raw\n\n\n352\n1,1,2.5\n-1,0,1e3",
            "a.raw\n1024x1024x1024\nfloat64\n0\n0.1,0.2,0.3",
            "b_1073741824x1073741824x4_uint16le.raw",
            "c_7x8x9_int8be.raw\n12x13x14\nint32\n9223372036854775807",
            "_1x1x1_float32_2x3x4_uint8.raw\n\nuint8"};
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size > (std::size_t{1} << 20)) return 0;
    std::string input(reinterpret_cast<const char*>(data), size);
    std::erase(input, '\0');  // the arguments of a program have none
    fuzz::expectErrorsOfOneLine([&] { fuzz::resolve(input); });
    return 0;
}
