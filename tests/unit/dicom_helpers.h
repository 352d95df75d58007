// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "unit/ingest_helpers.h"

namespace deltasplat::testing {

/// One DICOM slice of our own making: explicit VR, little endian, packed if there are fragments. An
/// empty member is left out of the file.
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

    std::string bytes() const {
        std::string meta = element(2, 0x10, "UI", syntax);
        meta = element(2, 0x02, "UI", "1.2.840.10008.5.1.4.1.1.2") +
               element(2, 0x03, "UI", "1.2.3.4") + meta;
        meta = element(2, 0, "UL", bytesOf<std::uint32_t>({std::uint32_t(meta.size())})) + meta;
        return std::string(128, '\0') + "DICM" + meta +
               element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2") +
               element(8, 0x18, "UI", "1.2.3.4") + element(8, 0x60, "CS", "CT") +
               element(8, 0x103e, "LO", description) + element(0x18, 0x50, "DS", thickness) +
               element(0x20, 0x0e, "UI", series) + element(0x20, 0x32, "DS", position) +
               element(0x20, 0x37, "DS", orientation) + number(0x28, 0x02, samples) +
               element(0x28, 0x04, "CS", photometric) + element(0x28, 0x08, "IS", frames) +
               number(0x28, 0x10, rows) + number(0x28, 0x11, columns) +
               element(0x28, 0x30, "DS", pixelSpacing) + number(0x28, 0x100, bits) +
               number(0x28, 0x101, bits) + number(0x28, 0x102, bits - 1) +
               number(0x28, 0x103, isSigned ? 1 : 0) + element(0x28, 0x1052, "DS", intercept) +
               element(0x28, 0x1053, "DS", slope) + pixelData();
    }

  private:
    std::string pixelData() const {
        if (fragments.empty()) return element(0x7fe0, 0x10, "OW", bytesOf(pixels));
        std::string data = bytesOf<std::uint16_t>({0x7fe0, 0x10}) + "OB" + std::string(2, '\0') +
                           std::string(4, '\xff') + item(0xe000, "");
        for (const std::string& fragment : fragments) data += item(0xe000, fragment);
        return data + item(0xe0dd, "");
    }
    static std::string item(int tag, std::string value) {
        if (value.size() % 2 != 0) value += '\0';
        return bytesOf<std::uint16_t>({0xfffe, std::uint16_t(tag)}) +
               bytesOf<std::uint32_t>({std::uint32_t(value.size())}) + value;
    }
    static std::string number(int group, int tag, int value) {
        return element(group, tag, "US", bytesOf<std::uint16_t>({std::uint16_t(value)}));
    }
    static std::string element(int group, int tag, const std::string& kind, std::string value) {
        if (value.empty()) return "";
        if (value.size() % 2 != 0) value += kind == "UI" ? '\0' : ' ';
        const std::string head =
            bytesOf<std::uint16_t>({std::uint16_t(group), std::uint16_t(tag)}) + kind;
        const std::string size =
            kind == "OW"
                ? std::string(2, '\0') + bytesOf<std::uint32_t>({std::uint32_t(value.size())})
                : bytesOf<std::uint16_t>({std::uint16_t(value.size())});
        return head + size + value;
    }
};

}  // namespace deltasplat::testing
