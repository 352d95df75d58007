// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_page_parts.h"

#include "deltasplat/image/write_image.h"
#include "page/page_parts.h"
#include "page/picture_data.h"

namespace deltasplat {

std::string shownPicture(Image picture, const Background& background) {
    if (background) compositeOver(picture, *background);
    compositeOver(picture, kPageDark);
    return pngDataUri(picture);
}

}  // namespace deltasplat
