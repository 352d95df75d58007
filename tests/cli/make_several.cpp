// SPDX-License-Identifier: Apache-2.0
#include "make_several.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

void writeBytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

template <typename T>
std::string bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// Volumes of 4x3x2, of which the n-th holds 100 n, 100 n + 1, ...
std::string volumes(int first, int count) {
    std::vector<std::int16_t> values;
    for (int n = first; n < first + count; ++n) {
        for (int i = 0; i < 24; ++i) values.push_back(std::int16_t(100 * n + i));
    }
    return bytesOf(values);
}

std::string nifti(const std::vector<std::int16_t>& dims, const std::string& data) {
    std::string header(352, '\0');
    const auto put = [&](std::size_t place, const std::string& bytes) {
        header.replace(place, bytes.size(), bytes);
    };
    put(0, bytesOf<std::int32_t>({348}));
    put(40, bytesOf(dims));
    put(70, bytesOf<std::int16_t>({4, 16}));
    put(76, bytesOf<float>({1, 1, 1, 1, 2, 0, 0, 0}));
    put(108, bytesOf<float>({352}));
    put(254, bytesOf<std::int16_t>({1}));
    put(280, bytesOf<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
    put(344, "n+1");
    return header + data;
}

std::string npy(const std::string& shape, const std::string& data) {
    std::string text = "{'descr': '<i2', 'fortran_order': False, 'shape': " + shape + ", }";
    text.resize(117, ' ');
    text += '\n';
    return std::string("\x93NUMPY\1\0v\0", 10) + text + data;
}

std::string element(std::uint16_t group, std::uint16_t tag, const std::string& kind,
                    std::string value) {
    if (value.size() % 2 != 0) value += kind == "UI" ? '\0' : ' ';
    const std::string head = bytesOf<std::uint16_t>({group, tag}) + kind;
    if (kind == "OW")
        return head + std::string(2, '\0') + bytesOf<std::uint32_t>({std::uint32_t(value.size())}) +
               value;
    return head + bytesOf<std::uint16_t>({std::uint16_t(value.size())}) + value;
}

std::string number(std::uint16_t tag, std::uint16_t value) {
    return element(0x28, tag, "US", bytesOf<std::uint16_t>({value}));
}

std::string dicomHead(const std::string& series, const std::string& kind,
                      const std::string& description) {
    const std::string meta = element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
    return std::string(128, '\0') + "DICM" +
           element(2, 0, "UL", bytesOf<std::uint32_t>({std::uint32_t(meta.size())})) + meta +
           element(8, 0x60, "CS", kind) + element(8, 0x103e, "LO", description) +
           element(0x20, 0x0e, "UI", series);
}

// A slice of columns x 2, z apart from the first one.
std::string slice(const std::string& series, const std::string& description, int columns, int z) {
    std::vector<std::uint16_t> pixels;
    for (int i = 0; i < 2 * columns; ++i) pixels.push_back(std::uint16_t(10 * z + i));
    return dicomHead(series, "CT", description) +
           element(0x20, 0x32, "DS", "0\\0\\" + std::to_string(z)) +
           element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0") + number(2, 1) +
           element(0x28, 4, "CS", "MONOCHROME2") + number(0x10, 2) +
           number(0x11, std::uint16_t(columns)) + element(0x28, 0x30, "DS", "1\\1") +
           number(0x100, 16) + number(0x101, 16) + number(0x102, 15) + number(0x103, 0) +
           element(0x7fe0, 0x10, "OW", bytesOf(pixels));
}

// Slices without extension in folders of a folder that holds a logo alone.
void writeStudy() {
    for (const std::string name : {"head", "legs"}) {
        std::filesystem::create_directories("study/" + name);
        const std::string series = name == "head" ? "1.2.8" : "1.2.9";
        for (int z = 0; z < 2; ++z)
            writeBytes("study/" + name + "/IM" + std::to_string(z), slice(series, name, 3, z));
    }
    writeBytes("study/logo.png", "a logo");
}

}  // namespace

void writeSeveral() {
    writeBytes("several.nii", nifti({4, 4, 3, 2, 5, 1, 1, 1}, volumes(0, 5)));
    writeBytes("several.npy", npy("(5, 2, 3, 4)", volumes(0, 5)));
    writeBytes("fourth.nii", nifti({3, 4, 3, 2, 1, 1, 1, 1}, volumes(3, 1)));
    writeBytes("less.nii", nifti({4, 4, 3, 2, 6, 1, 1, 1}, volumes(0, 5)));
    writeBytes("negative.nii", nifti({4, 4, 3, 2, -5, 1, 1, 1}, volumes(0, 5)));
    writeBytes("endless.nii", nifti({7, 4, 3, 2, 32767, 32767, 32767, 32767}, volumes(0, 5)));
    std::filesystem::create_directories("series");
    std::filesystem::create_directories("thorax");
    for (int z = 0; z < 4; ++z) {
        writeBytes("series/a" + std::to_string(z), slice("1.2.1", "Thorax 1.5 mm", 3, z));
        writeBytes("thorax/" + std::to_string(z), slice("1.2.7", "Copy", 3, z));
        writeBytes("series/b" + std::to_string(z), slice("1.2.2", "Scout", 5, 2 * z));
    }
    writeBytes("series/c", dicomHead("1.2.3", "SR", "Dose report"));
    writeStudy();
}
