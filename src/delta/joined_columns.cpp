// SPDX-License-Identifier: Apache-2.0
#include "delta/joined_columns.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "run_begins.h"

namespace deltasplat {
namespace {

glm::ivec2 placeOf(const CodeBlock& block) {
    return {block.position.y, block.position.z};
}

bool isBefore(const glm::ivec2& a, const glm::ivec2& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

// Finds the blocks of one column after the other, which come in order.
class ColumnCursor {
  public:
    // @param begins  of columns, and the number of all blocks
    ColumnCursor(const std::vector<CodeBlock>& blocks, const std::vector<std::size_t>& begins)
        : blocks_(&blocks), begins_(&begins) {}

    std::span<const CodeBlock> at(const glm::ivec2& place) {
        const std::vector<std::size_t>& begins = *begins_;
        const auto here = [&] { return placeOf((*blocks_)[begins[column_]]); };
        while (column_ + 1 < begins.size() && isBefore(here(), place)) ++column_;
        if (column_ + 1 == begins.size() || here() != place) return {};
        return std::span(*blocks_).subspan(begins[column_], begins[column_ + 1] - begins[column_]);
    }

  private:
    const std::vector<CodeBlock>* blocks_;
    const std::vector<std::size_t>* begins_;
    std::size_t column_ = 0;
};

}  // namespace

std::size_t JoinedColumn::mostBlocks(int firstPlace, int lastPlace) const {
    std::size_t count = 0;
    int first = lastPlace + 1;
    int last = firstPlace - 1;
    for (const auto& source : sources) {
        for (const CodeBlock& block : source) {
            const int at = block.position.x >> 1;
            if (at < firstPlace || at > lastPlace) continue;
            ++count;
            first = std::min(first, at);
            last = std::max(last, at);
        }
    }
    return count == 0 ? 0 : std::min(count, std::size_t(last - first + 1));
}

std::vector<JoinedColumn> joinColumns(const std::vector<CodeBlock>& blocks,
                                      const glm::ivec2& slant) {
    const std::vector<std::size_t> begins = runBegins(blocks, shareColumn);
    const bool both = slant.x != 0 && slant.y != 0;
    const std::array<glm::ivec2, 4> steps = {
        glm::ivec2(0), {slant.x, 0}, {0, slant.y}, both ? slant : glm::ivec2(0)};
    const auto isThere = [&](std::size_t i) { return i == 0 || steps[i] != glm::ivec2(0); };
    std::vector<glm::ivec2> places;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!isThere(i)) continue;
        std::vector<glm::ivec2> moved;
        for (std::size_t c = 0; c + 1 < begins.size(); ++c)
            moved.push_back(placeOf(blocks[begins[c]]) + steps[i]);
        std::vector<glm::ivec2> all;
        std::set_union(places.begin(), places.end(), moved.begin(), moved.end(),
                       std::back_inserter(all), isBefore);
        places = std::move(all);
    }
    std::vector<ColumnCursor> cursors(steps.size(), ColumnCursor(blocks, begins));
    std::vector<JoinedColumn> columns;
    columns.reserve(places.size());
    for (const glm::ivec2& place : places) {
        JoinedColumn& column = columns.emplace_back(JoinedColumn{place, {}});
        for (std::size_t i = 0; i < steps.size(); ++i)
            if (isThere(i)) column.sources[i] = cursors[i].at(place - steps[i]);
    }
    return columns;
}

}  // namespace deltasplat
