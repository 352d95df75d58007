// SPDX-License-Identifier: Apache-2.0
#include "sequence/contact_sheet.h"

#include <algorithm>
#include <utility>

namespace deltasplat {

ContactSheet::ContactSheet(std::filesystem::path file, glm::ivec2 cells, glm::ivec2 cellSize,
                           ImageFileOptions options, const Image& empty)
    : file_(std::move(file)),
      cells_(cells),
      options_(std::move(options)),
      sheet_(cells * cellSize) {
    for (int i = 0; i < cells.x * cells.y; ++i) put(std::size_t(i), empty);
}

// No two frames share a cell.
void ContactSheet::put(std::size_t i, const Image& image) {
    const glm::ivec2 first = glm::ivec2(int(i) % cells_.x, int(i) / cells_.x) * image.size;
    for (int y = 0; y < image.size.y; ++y)
        std::copy_n(image.pixel(0, y), 4 * image.size.x, sheet_.pixel(first.x, first.y + y));
}

void ContactSheet::finish() {
    writeImage(file_, sheet_, options_);
}

}  // namespace deltasplat
