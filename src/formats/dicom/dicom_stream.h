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

}  // namespace deltasplat
