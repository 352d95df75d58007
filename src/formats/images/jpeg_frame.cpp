// SPDX-License-Identifier: Apache-2.0
// Based on: ITU-T T.81 (JPEG), annex B: frame headers; T.87 (JPEG-LS), annex C.
#include "formats/images/jpeg_frame.h"

namespace deltasplat {
namespace {

bool isFrame(int marker) {
    constexpr int kTables = 0xc4, kOther = 0xc8, kArithmetic = 0xcc, kLosslessFrame = 0xf7;
    return marker == kLosslessFrame || (marker >= 0xc0 && marker <= 0xcf && marker != kTables &&
                                        marker != kOther && marker != kArithmetic);
}

// Markers that no length follows.
bool isAlone(int marker) {
    return marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8);
}

}  // namespace

std::optional<JpegFrame> findJpegFrame(const std::function<int()>& next) {
    constexpr int kEnd = 0xd9, kScan = 0xda;
    const auto word = [&] {
        const int high = next();
        return high << 8 | next();  // -1 behind the last byte
    };
    for (int byte = next(); byte >= 0; byte = next()) {
        if (byte != 0xff) continue;
        int marker = 0xff;
        while (marker == 0xff) marker = next();
        if (isAlone(marker)) continue;
        if (marker == kEnd || marker == kScan) return {};
        const int bytes = word();
        if (isFrame(marker)) {
            JpegFrame frame{marker, next()};
            frame.rows = word();
            frame.columns = word();
            frame.components = next();
            if (frame.components < 0) return {};
            return frame;
        }
        for (int i = 2; i < bytes; ++i) next();
    }
    return {};
}

}  // namespace deltasplat
