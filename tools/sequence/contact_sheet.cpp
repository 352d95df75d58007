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
    const auto count = std::size_t(cells.x) * std::size_t(cells.y);
    for (std::size_t i = 0; i < count; ++i) put(i, empty);
}

// No two frames share a cell.
void ContactSheet::put(std::size_t i, const Image& image) {
    const auto columns = std::size_t(cells_.x);
    const glm::ivec2 first = glm::ivec2(int(i % columns), int(i / columns)) * image.size;
    for (int y = 0; y < image.size.y; ++y)
        std::copy_n(image.pixel(0, y), 4 * image.size.x, sheet_.pixel(first.x, first.y + y));
}

void ContactSheet::finish() {
    writeImage(file_, sheet_, options_);
}

}  // namespace deltasplat
