// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace deltasplat {

/// What a compressed picture says of itself.
struct DicomStream {
    std::uint64_t columns = 0;
    std::uint64_t rows = 0;
    int components = 1;
    int bits = 0;           ///< of a number
    bool isSigned = false;  ///< only JPEG 2000 can say so
    bool saysSign = false;  ///< whether it is JPEG 2000
};

/// Returns what the header of a JPEG, JPEG-LS or JPEG 2000 picture says; nothing if there is none.
std::optional<DicomStream> readStreamHeader(std::string_view bytes);

/// Whether bytes begin as such a picture does.
bool beginsPicture(std::string_view bytes);

/// What the helper is to unpack: the beginning of a request, before a DICOM file of these pixels.
struct DicomUnpacking {
    std::uint64_t bytes = 0;  ///< of the unpacked picture
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    std::int32_t allocated = 16;  ///< bits of a cell
    std::int32_t stored = 16;     ///< bits of a number
    std::uint64_t isSigned = 0;
};

}  // namespace deltasplat
