// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "unit/ingest_helpers.h"

namespace deltasplat::testing {

/// One DICOM element: the type of its value, and the value. An empty type is that of sequences.
struct DicomElement {
    std::string kind;
    std::string value;
};

/// Elements by group << 16 | element.
using DicomTags = std::map<std::uint32_t, DicomElement>;

inline DicomElement decimalText(const std::string& text) {
    return {"DS", text};
}
inline DicomElement wordsOf(const std::vector<std::uint16_t>& values) {
    return {"US", bytesOf(values)};
}
inline DicomElement doublesOf(const std::vector<double>& values) {
    return {"FD", bytesOf(values)};
}

/// The bytes of an element, with its type or without; of empty values none.
inline std::string dicomElement(std::uint32_t tag, const DicomElement& element,
                                bool explicitTypes = true) {
    std::string value = element.value;
    if (value.empty()) return "";
    if (value.size() % 2 != 0) value += element.kind == "UI" ? '\0' : ' ';
    const std::string place =
        bytesOf<std::uint16_t>({std::uint16_t(tag >> 16), std::uint16_t(tag)});
    const std::string size = bytesOf<std::uint32_t>({std::uint32_t(value.size())});
    if (!explicitTypes) return place + size + value;
    const bool isLong = element.kind == "OW" || element.kind == "OB" || element.kind == "SQ";
    return place + element.kind + (isLong ? std::string(2, '\0') + size : size.substr(0, 2)) +
           value;
}

/// A sequence of items.
inline DicomElement sequenceOf(const std::vector<DicomTags>& items, bool explicitTypes = true) {
    std::string bytes;
    for (const DicomTags& tags : items) {
        std::string item;
        for (const auto& [tag, element] : tags) item += dicomElement(tag, element, explicitTypes);
        bytes += bytesOf<std::uint16_t>({0xfffe, 0xe000}) +
                 bytesOf<std::uint32_t>({std::uint32_t(item.size())}) + item;
    }
    return {"SQ", bytes};
}

/// One DICOM slice of our own making: little endian, packed if there are fragments. An empty member
/// is left out of the file.
struct DicomFile {
    int columns = 3;
    int rows = 2;
    std::string position = "10\\20\\30";
    std::string orientation = "1\\0\\0\\0\\1\\0";
    std::string pixelSpacing = "0.5\\0.25";  // from row to row, from column to column
    std::string series = "1.2.3";
    std::string description;
    std::string slope = "1";
    std::string intercept = "0";
    std::string frames;
    std::string thickness;
    std::string photometric = "MONOCHROME2";
    int samples = 1;
    bool isSigned = false;
    int bits = 16;
    std::string syntax = "1.2.840.10008.1.2.1";
    std::vector<std::string> fragments;
    std::vector<std::uint16_t> pixels{0, 1, 2, 3, 4, 5};
    DicomTags more;             // besides these, or in their place
    bool explicitTypes = true;  // of the data set

    std::string bytes() const { return header() + dataSet(); }

    std::string header() const {
        const std::string meta = dicomElement(0x00020002, {"UI", "1.2.840.10008.5.1.4.1.1.2"}) +
                                 dicomElement(0x00020003, {"UI", "1.2.3.4"}) +
                                 dicomElement(0x00020010, {"UI", syntax});
        const DicomElement size{"UL", bytesOf<std::uint32_t>({std::uint32_t(meta.size())})};
        return std::string(128, '\0') + "DICM" + dicomElement(0x00020000, size) + meta;
    }

    std::string dataSet() const {
        DicomTags tags = more;
        const DicomTags usual{{0x00080016, {"UI", "1.2.840.10008.5.1.4.1.1.2"}},
                              {0x00080018, {"UI", "1.2.3.4"}},
                              {0x00080060, {"CS", "CT"}},
                              {0x0008103e, {"LO", description}},
                              {0x00180050, {"DS", thickness}},
                              {0x0020000e, {"UI", series}},
                              {0x00200032, {"DS", position}},
                              {0x00200037, {"DS", orientation}},
                              {0x00280002, number(samples)},
                              {0x00280004, {"CS", photometric}},
                              {0x00280008, {"IS", frames}},
                              {0x00280010, number(rows)},
                              {0x00280011, number(columns)},
                              {0x00280030, {"DS", pixelSpacing}},
                              {0x00280100, number(bits)},
                              {0x00280101, number(bits)},
                              {0x00280102, number(bits - 1)},
                              {0x00280103, number(isSigned ? 1 : 0)},
                              {0x00281052, {"DS", intercept}},
                              {0x00281053, {"DS", slope}}};
        tags.insert(usual.begin(), usual.end());
        if (fragments.empty()) tags.insert({0x7fe00010, {"OW", bytesOf(pixels)}});
        std::string bytes;
        for (const auto& [tag, element] : tags) bytes += dicomElement(tag, element, explicitTypes);
        return fragments.empty() ? bytes : bytes + packedPixels(fragments);
    }

    /// Pixels as a list of pieces, with an empty table of offsets.
    static std::string packedPixels(const std::vector<std::string>& fragments) {
        std::string data = bytesOf<std::uint16_t>({0x7fe0, 0x10}) + "OB" + std::string(2, '\0') +
                           std::string(4, '\xff') + item(0xe000, "");
        for (const std::string& fragment : fragments) data += item(0xe000, fragment);
        return data + item(0xe0dd, "");
    }

  private:
    static std::string item(int tag, std::string value) {
        if (value.size() % 2 != 0) value += '\0';
        return bytesOf<std::uint16_t>({0xfffe, std::uint16_t(tag)}) +
               bytesOf<std::uint32_t>({std::uint32_t(value.size())}) + value;
    }
    static DicomElement number(int value) { return wordsOf({std::uint16_t(value)}); }
};

}  // namespace deltasplat::testing
