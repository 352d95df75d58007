// SPDX-License-Identifier: Apache-2.0
// Gradients of linear fields, which central differences state exactly.
#include "words/block_looks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/make_volume.h"
#include "volume/code_blocks.h"

namespace deltasplat {
namespace {

constexpr glm::ivec3 kSlope{3, 5, -2};

Volume linearVolume(const IndexBox& box) {
    return test::makeVolume(box, [&](int x, int y, int z) {
        const glm::ivec3 p = glm::ivec3(x, y, z) - box.min;
        return 300 + kSlope.x * p.x + kSlope.y * p.y + kSlope.z * p.z;
    });
}

GradientScale asTheyAre() {
    GradientScale scale;
    for (int code = 0; code < kCodeCount; ++code) scale.ofCode.push_back(float(code));
    return scale;
}

// Also at the ends of a volume, and right behind them where what is divided lies.
TEST(BlockGradients, areExactOfLinearFields) {
    const IndexBox box{{-11, 2, 5}, {9, 21, 18}};
    const Volume volume = linearVolume(box);
    const GradientScale scale = asTheyAre();
    for (int axis = 0; axis < 3; ++axis) {
        for (const Subdivision& parts :
             {Subdivision{}, Subdivision{2, 2, {}}, Subdivision{3, 1, {}}, Subdivision{4, 2, {}}}) {
            GradientReader reader(*volume.codes(), axis, parts, scale);
            const BlockReader blocks(*volume.codes(), nullptr, axis, {});
            int checked = 0;
            for (const CodeBlock& block : blocks.blocks()) {
                const auto fields = reader.read(block);
                ASSERT_EQ(int(fields.size()), parts.voxels());
                for (int s = 0; s < 8 * parts.slices; ++s) {
                    for (int u = 0; u < 8 * parts.within; ++u) {
                        for (int v = 0; v < 8 * parts.within; ++v) {
                            const glm::ivec3 own(s / parts.slices, u / parts.within,
                                                 v / parts.within);
                            const glm::ivec3 index = fromSliceOrder(8 * block.position + own, axis);
                            if (glm::any(glm::lessThan(index, box.min)) ||
                                glm::any(glm::greaterThan(index, box.max)))
                                continue;
                            const int part = (u / 8 * parts.slices + s / 8) * parts.within + v / 8;
                            const int n = 64 * (s % 8) + 8 * (u % 8) + v % 8;
                            for (int c = 0; c < 3; ++c) {
                                ASSERT_EQ(fields[std::size_t(part)]
                                              .gradients[std::size_t(c)][std::size_t(n)],
                                          float(kSlope[c]));
                            }
                            ++checked;
                        }
                    }
                }
            }
            EXPECT_EQ(checked, box.voxels() * parts.voxels());
        }
    }
}

// What is not there is the background, where there is one, and else nothing.
TEST(BlockGradients, meetTheBackgroundWhereThereIsOne) {
    const Volume one = test::makeVolume({{0, 0, 0}, {20, 20, 20}}, [](int x, int y, int z) {
        return glm::ivec3(x, y, z) == glm::ivec3(8, 8, 8) ? 100 : test::kInactive;
    });
    GradientScale scale = asTheyAre();
    const auto at = [&](const glm::ivec3& index) {
        GradientReader reader(*one.codes(), 2, {}, scale);
        CodeBlock block;
        block.position = toSliceOrder(index, 2) / 8;
        const auto fields = reader.read(block);
        const glm::ivec3 place = toSliceOrder(index, 2) % 8;
        const int n = 64 * place.x + 8 * place.y + place.z;
        glm::vec3 gradient;
        for (int c = 0; c < 3; ++c)
            gradient[c] = fields.front().gradients[std::size_t(c)][std::size_t(n)];
        return gradient;
    };
    EXPECT_EQ(at({8, 8, 8}), glm::vec3(0));
    EXPECT_TRUE(std::isnan(at({9, 8, 8}).x));
    scale.background = 20.0f;
    EXPECT_EQ(at({8, 8, 8}), glm::vec3(0));
    EXPECT_EQ(at({9, 8, 8}), glm::vec3(-40, 0, 0));
    EXPECT_EQ(at({8, 7, 8}), glm::vec3(0, 40, 0));
}

}  // namespace
}  // namespace deltasplat
