// SPDX-License-Identifier: Apache-2.0
#include "formats/choose_volume.h"

#include "deltasplat/error.h"

namespace deltasplat {

std::int64_t chooseVolume(const std::string& where, const std::string& axes, std::int64_t count,
                          const std::optional<std::int64_t>& chosen) {
    const std::string which =
        count == 1 ? "`volume` 0" : "`volume` 0 to " + std::to_string(count - 1);
    const std::string held =
        std::to_string(count) + (count == 1 ? " volume (" : " volumes (") + axes + ")";
    if (!chosen && count > 1) {
        throw Error(ErrorCode::kInput, where, held, "one, chosen by " + which);
    }
    const std::int64_t volume = chosen.value_or(0);
    if (volume >= 0 && volume < count) return volume;
    throw Error(ErrorCode::kInput, where, "no volume " + std::to_string(volume) + " among " + held,
                which);
}

}  // namespace deltasplat
