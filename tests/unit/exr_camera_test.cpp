// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <array>
#include <functional>
#include <glm/matrix.hpp>

#include "deltasplat/image/write_image.h"
#include "unit/camera_helpers.h"

namespace deltasplat::test {
namespace {

constexpr glm::ivec2 kSize(60, 40);

FilmCamera film(Projection projection) {
    FilmCamera camera;
    camera.projection = projection;
    camera.worldFromCamera = {{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {12, 2, 3, 1}};
    camera.focalMm = 40;
    camera.frameWidthWorld = 7;
    camera.offsetMm = {4, -3};
    camera.pixelAspect = 1.5;
    return camera;
}

struct Matrices {
    glm::dmat4 cameraFromWorld, ndcFromWorld;
};

Matrices matricesOf(const Camera& camera) {
    return {camera.cameraFromWorld(), camera.ndcFromWorld()};
}

void write(const std::filesystem::path& file, const Matrices& matrices) {
    ImageFileOptions options;
    options.cameraFromWorld = matrices.cameraFromWorld;
    options.ndcFromWorld = matrices.ndcFromWorld;
    writeImage(file, Image(kSize), options);
}

std::string complaintOf(const std::function<void(Matrices&)>& spoil) {
    const TempFolder folder;
    Matrices matrices = matricesOf(cameraFor(film(Projection::kPerspective), kSize));
    spoil(matrices);
    write(folder / "a.exr", matrices);
    try {
        readCamera(folder / "a.exr");
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
        return error.what();
    }
    return "";
}

// Renderers whose matrices differ from ours see the same pixels.
TEST(ExrCamera, APictureTellsItsCamera) {
    const auto ours = [](Matrices&) {};
    const auto rightHanded = [](Matrices& m) {
        glm::dmat4 flip(1);
        flip[2][2] = -1;
        m.cameraFromWorld = flip * m.cameraFromWorld;
    };
    const auto upwards = [&](Matrices& m) {
        rightHanded(m);
        const glm::dmat4 screen({2, 0, 0, 0}, {0, -2, 0, 0}, {0, 0, 1, 0}, {-1, 1, 0, 1});
        m.ndcFromWorld = screen * m.ndcFromWorld;
    };
    const TempFolder folder;
    for (const Projection projection : {Projection::kOrtho, Projection::kPerspective}) {
        const Camera camera = cameraFor(film(projection), kSize);
        for (const std::function<void(Matrices&)>& other :
             {std::function<void(Matrices&)>(ours), std::function<void(Matrices&)>(rightHanded),
              std::function<void(Matrices&)>(upwards)}) {
            Matrices matrices = matricesOf(camera);
            other(matrices);
            write(folder / "a.exr", matrices);
            const FilmCamera found = readCamera(folder / "a.exr").at(0);
            EXPECT_EQ(found.sizePixels, kSize);
            const Camera again = cameraFor(found, kSize);
            EXPECT_LE(glm::distance(again.eyeWorld(), glm::dvec3(12, 2, 3)), 1e-5);
            for (const glm::dvec3& world :
                 {glm::dvec3(1, 2, 3), glm::dvec3(-4, 0, 1), glm::dvec3(2, 4, 7)})
                expectPixel(again, world, camera.pixelFromWorld(world), 1e-4);
        }
    }
}

TEST(ExrCamera, OtherPicturesAreRefused) {
    const TempFolder folder;
    writeImage(folder / "a.exr", Image(kSize), {});
    EXPECT_THROW(readCamera(folder / "a.exr"), Error);
    EXPECT_THROW(readCamera(folder / "none.exr"), Error);
    EXPECT_NE(complaintOf([](Matrices& m) { m.cameraFromWorld[0] = glm::dvec4(0); }), "");
    EXPECT_NE(complaintOf([](Matrices& m) { m.cameraFromWorld[0] *= 2; }), "");
    EXPECT_NE(complaintOf([](Matrices& m) { m.ndcFromWorld[1][1] = NAN; }), "");
    EXPECT_NE(complaintOf([](Matrices& m) { m.ndcFromWorld = glm::dmat4(1); }), "");
    EXPECT_NE(complaintOf([](Matrices& m) { m.ndcFromWorld = glm::dmat4(0); }), "");
    EXPECT_EQ(complaintOf([](Matrices&) {}), "");
}

}  // namespace
}  // namespace deltasplat::test
