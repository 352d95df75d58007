// SPDX-License-Identifier: Apache-2.0
// Based on: numpy.lib.format, "NPY format" (numpy.org/doc), version 1.0.
#include "formats/npy/read_npy.h"

namespace deltasplat {
namespace {

// NumPy's letters for the kinds of numbers, and their bytes.
std::string typeText(RawType type) {
    const int bytes = rawTypeBytes(type);
    const std::string name = rawTypeName(type);
    const std::string order = bytes == 1 ? "|" : "<";
    return order + name.substr(0, 1) + std::to_string(bytes);
}

}  // namespace

// An array a[z][y][x]: the last index counts fastest.
std::string npyHeader(const DenseLayout& layout, const std::string&) {
    constexpr std::size_t kUnit = 64, kStart = 10;
    std::string text = "{'descr': '" + typeText(layout.type) +
                       "', 'fortran_order': False, 'shape': (" + std::to_string(layout.dims.z) +
                       ", " + std::to_string(layout.dims.y) + ", " + std::to_string(layout.dims.x) +
                       "), }";
    const std::size_t whole = (kStart + text.size() + 1 + kUnit - 1) / kUnit * kUnit;
    text.resize(whole - kStart - 1, ' ');
    text += '\n';
    return std::string("\x93NUMPY\x01\x00", 8) + char(text.size() & 0xff) + char(text.size() >> 8) +
           text;
}

}  // namespace deltasplat
