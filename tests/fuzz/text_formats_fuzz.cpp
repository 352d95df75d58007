// SPDX-License-Identifier: Apache-2.0
// Byte 0 chooses NRRD or MetaImage, the rest is the file.
#include "fuzz/fuzz_target.h"
#include "unit/format_helpers.h"

namespace deltasplat::fuzz {
namespace {

const std::string& values() {
    static const std::string kValues = testing::bytesOf(testing::ramp<std::uint16_t>(9 * 5 * 11));
    return kValues;
}

std::string numbers() {
    std::string text;
    for (int i = 0; i < 9 * 5 * 11; ++i) text += std::to_string(i) + "\n";
    return text;
}

void addNrrd(std::vector<std::string>& inputs) {
    const auto add = [&](const std::string& fields, const std::string& data) {
        inputs.push_back('\0' + std::string("NRRD0004\ntype: ushort\n") + fields + "\n" + data);
    };
    const std::string sizes = "dimension: 3\nsizes: 9 5 11\nendian: little\n";
    const std::string space =
        "space: right-anterior-superior\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n"
        "space origin: (10,20,30)\n";
    add(sizes + space + "encoding: raw\n", values());
    add(sizes + space + "encoding: gzip\n", gzipped(values()));
    add(sizes + "spacings: 1 2 3\naxis mins: 1 2 3\ncenters: cell cell node\nencoding: raw\n",
        values());
    // Lines of others, and fields that are spelled otherwise.
    add(sizes + "encoding: raw\n# x\rdata file: -\r\nkey:=x\rlabels: \"a\"\nData  File: x\n",
        values());
    add(sizes + "encoding: ascii\n", numbers());
    add(sizes + "encoding: hex\n", std::string(9 * 5 * 11 * 4, 'a'));
    add("dimension: 4\nsizes: 1 9 5 11\nkinds: scalar space space space\nendian: big\n"
        "thicknesses: NaN 1 2 3\nlabels: \"a\" \"b\" \"c\" \"d\"\nunits: \"\" \"mm\" \"mm\" "
        "\"mm\"\n"
        "content: values\nsample units: \"x\"\nold min: 1\nmeasurement frame: (1,0,0) (0,1,0) "
        "(0,0,1)\nspace: 3D-right-handed\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\n"
        "encoding: raw\nkey:=value\nbyte skip: 3\nline skip: 0\n",
        "abc" + values());
}

void addMeta(std::vector<std::string>& inputs) {
    const auto add = [&](const std::string& fields, const std::string& data) {
        inputs.push_back('\1' + std::string("ObjectType = Image\nNDims = 3\n") + fields +
                         "ElementDataFile = LOCAL\n" + data);
    };
    const std::string sizes = "DimSize = 9 5 11\nElementType = MET_USHORT\n";
    const std::string place =
        "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 10 20 30\nCenterOfRotation = 0 0 0\n"
        "AnatomicalOrientation = RAI\nElementSpacing = 2 3 4\n";
    add("BinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n" + place +
            sizes,
        values());
    add("BinaryData = True\nElementByteOrderMSB = True\nElementSize = 1 1 1\nHeaderSize = -1\n"
        "Modality = MET_MOD_CT\nElementMin = 0\nElementMax = 5\nElementNumberOfChannels = 1\n"
        "Comment = c\nName = n\nID = 1\nParentID = 1\nColor = 1 0 0 1\nSequenceID = 1 2 3\n"
        "AcquisitionDate = 2000\nDistanceUnits = mm\nOrigin = 1 2 3\n" +
            sizes,
        values());
    // Fields that are spelled otherwise.
    add("elementdatafile = LOCAL\nndims = -1\nElement Data File: x\nComment = x\rNDims = 9\n" +
            sizes,
        values());
    add("BinaryData = False\n" + sizes, numbers());
    const std::string packed = gzipped(values());
    add("BinaryData = True\nCompressedData = True\nCompressedDataSize = " +
            std::to_string(packed.size()) + "\n" + place + sizes,
        packed);
}

}  // namespace

std::vector<std::string> seeds() {
    std::vector<std::string> inputs;
    addNrrd(inputs);
    addMeta(inputs);
    return inputs;
}

}  // namespace deltasplat::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deltasplat;
    if (size < 1 || size > (std::size_t{1} << 20)) return 0;
    ReadOptions options;
    if ((data[0] & 2) != 0) options.nanValue = 1.5;
    const std::string extension = (data[0] & 1) != 0 ? ".mha" : ".nrrd";
    fuzz::readAndCheck(fuzz::fileWith(extension, data + 1, size - 1), options);
    return 0;
}
