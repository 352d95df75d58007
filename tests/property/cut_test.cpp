// SPDX-License-Identifier: Apache-2.0
// Pictures of what is left of a volume are those of a volume that never had more.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "deltasplat/cut/cut_volume.h"
#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/render.h"
#include "support/make_volume.h"

namespace deltasplat::test {
namespace {

const IndexBox kCrop{{3, 5, 2}, {19, 17, 20}};
constexpr glm::i64vec3 kDims(24, 22, 26);

std::uint8_t valueAt(int x, int y, int z) {
    return std::uint8_t((x * x + 3 * y * z + 5 * z) % 23 < 9 ? 0 : 40 + (x * 7 + y * 5 + z) % 200);
}

Volume dense(const IndexBox& box) {
    std::vector<std::uint8_t> values;
    for (int z = box.min.z; z <= box.max.z; ++z) {
        for (int y = box.min.y; y <= box.max.y; ++y) {
            for (int x = box.min.x; x <= box.max.x; ++x) values.push_back(valueAt(x, y, z));
        }
    }
    MemoryLayout layout;
    layout.dims = box.dims();
    layout.worldFromIndex[2][2] = 1.5;
    layout.worldFromIndex[3] = {box.min.x, box.min.y, 1.5 * box.min.z, 1};
    return makeVolume(std::span<const std::uint8_t>(values), layout);
}

Volume sparse(const IndexBox& box) {
    Volume volume = makeVolume(box, [](int x, int y, int z) {
        const int value = valueAt(x, y, z);
        return value == 0 ? kInactive : value;
    });
    test::changed(volume)->hasBackground = true;
    return volume;
}

RenderOptions someOptions(Mode mode) {
    RenderOptions options;
    options.mode = mode;
    options.camera.view = "iso";
    options.camera.sizePixels = {70, 60};
    options.optics.transferFunction.colors = {{0, {1, 0, 0}}, {255, {0, 1, 0.5}}};
    options.optics.transferFunction.opacities = {{0, 0, 0.5, 0}, {255, 0.5, 0.5, 0}};
    return options;
}

void expectSamePictures(const Volume& a, const Volume& b) {
    ASSERT_EQ(a.activeCount(), b.activeCount());
    for (const Mode mode : {Mode::kComposite, Mode::kXray, Mode::kMip}) {
        SCOPED_TRACE(modeName(mode));
        const Image one = render(a, someOptions(mode)).image;
        EXPECT_EQ(one.rgba, render(b, someOptions(mode)).image.rgba);
        EXPECT_NE(one.rgba, Image(one.size).rgba) << "a picture of nothing";
    }
}

// By whole blocks: composited pictures of voxels that are counted otherwise are not the same bits.
TEST(CutPicture, isThatOfASmallerDenseVolume) {
    Cut cut;
    cut.cropIndex = IndexBox{{8, 0, 8}, {19, 17, 20}};
    expectSamePictures(cutVolume(dense({glm::ivec3(0), glm::ivec3(kDims) - 1}), cut),
                       dense(*cut.cropIndex));
}

TEST(CutPicture, isThatOfASmallerSparseVolume) {
    Cut cut;
    cut.cropIndex = kCrop;
    Volume smaller = sparse(kCrop);
    const Volume left = cutVolume(sparse({glm::ivec3(0), glm::ivec3(kDims) - 1}), cut);
    ASSERT_EQ(left.box(), smaller.box());
    expectSamePictures(left, smaller);
}

// A clipped volume is in the picture where the whole one was.
TEST(CutPicture, isThatOfClearedVoxels) {
    const IndexBox box{glm::ivec3(0), glm::ivec3(kDims) - 1};
    Cut cut;
    cut.clipPlanes = {{{9.5, 10.5, 12.5}, {1, 2, -1}}};
    const Volume cleared = makeVolume(box, [](int x, int y, int z) {
        const bool kept = (x - 9.5) + 2 * (y - 10.5) - (z - 12.5) >= 0;
        return kept && valueAt(x, y, z) > 0 ? valueAt(x, y, z) : kInactive;
    });
    expectSamePictures(cutVolume(sparse(box), cut), cleared);
}

}  // namespace
}  // namespace deltasplat::test
