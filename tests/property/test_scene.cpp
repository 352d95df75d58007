// SPDX-License-Identifier: Apache-2.0
#include "property/test_scene.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "deltasplat/ingest/read_volume.h"

namespace deltasplat::test {
namespace {

// A file in the temporary folder that is gone with this object.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::string& extension)
        : path_(std::filesystem::temp_directory_path() /
                ("deltasplat_test_" + std::to_string(getpid()) + extension)) {}
    ~TemporaryFile() { std::filesystem::remove(path_); }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

reference::Vector plain(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

TestVolume::TestVolume(const glm::ivec3& firstIndex, const glm::ivec3& size)
    : first(firstIndex), dims(size), values(std::size_t(size.x) * size.y * size.z) {}

float& TestVolume::at(const glm::ivec3& index) {
    const glm::ivec3 p = index - first;
    return values[(std::size_t(p.z) * dims.y + p.y) * dims.x + p.x];
}

glm::dvec3 TestVolume::world(const glm::dvec3& index) const {
    return glm::dvec3(worldFromIndex * glm::dvec4(index, 1));
}

glm::dmat4 spaced(const glm::dvec3& spacing, const glm::dvec3& origin) {
    glm::dmat4 matrix(1);
    for (int k = 0; k < 3; ++k) matrix[k][k] = spacing[k];
    matrix[3] = glm::dvec4(origin, 1);
    return matrix;
}

Volume throughVdb(const TestVolume& volume) {
    openvdb::initialize();
    openvdb::math::Mat4d rows;  // OpenVDB multiplies row vectors from the left
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            rows[row][column] = volume.worldFromIndex[row][column];
        }
    }
    const auto grid = openvdb::FloatGrid::create();
    grid->setTransform(openvdb::math::Transform::createLinearTransform(rows));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto accessor = grid->getAccessor();
    const float* value = volume.values.data();
    for (int z = 0; z < volume.dims.z; ++z) {
        for (int y = 0; y < volume.dims.y; ++y) {
            for (int x = 0; x < volume.dims.x; ++x, ++value) {
                const glm::ivec3 index = volume.first + glm::ivec3(x, y, z);
                if (*value != 0) accessor.setValue({index.x, index.y, index.z}, *value);
            }
        }
    }
    const TemporaryFile file(".vdb");
    openvdb::io::File(file.path().string()).write({grid});
    return readVolume(file.path());
}

Volume throughRaw(const TestVolume& volume, const glm::dvec3& spacing) {
    EXPECT_EQ(volume.first, glm::ivec3(0));
    EXPECT_EQ(volume.worldFromIndex, spaced(spacing));
    const TemporaryFile file(".raw");
    std::ofstream out(file.path(), std::ios::binary);
    for (const float value : volume.values) out.put(char(static_cast<unsigned char>(value)));
    out.close();
    ReadOptions options;
    options.raw.dims = volume.dims;
    options.raw.type = "uint8";
    options.raw.spacing = spacing;
    return readVolume(file.path(), options);
}

TransferFunction testTransferFunction(double opacity) {
    TransferFunction function;
    function.linearColors = true;
    function.colors = {{0, {0, 1, 0.25}}, {255, {1, 0, 0.25}}};
    function.opacities = {{0, 0, 0.5, 0}, {255, opacity, 0.5, 0}};
    return function;
}

reference::Volume referenceVolume(const TestVolume& volume, double opacity, double unitDistance) {
    reference::Volume result;
    for (int k = 0; k < 3; ++k) {
        result.first[k] = volume.first[k];
        result.dims[k] = volume.dims[k];
        result.axes[k] = plain(glm::dvec3(volume.worldFromIndex[k]));
    }
    result.origin = plain(glm::dvec3(volume.worldFromIndex[3]));
    for (const float value : volume.values) {
        const double share = value / 255.0;
        result.voxels.push_back(
            {-std::log(1 - opacity * share) / unitDistance, {share, 1 - share, 0.25}});
    }
    return result;
}

CameraOptions TestView::options() const {
    CameraOptions options;
    options.direction = direction;
    options.up = up;
    options.targetWorld = target;
    options.frameWidthWorld = pixelWorld * size.x;
    options.sizePixels = size;
    return options;
}

reference::View TestView::view() const {
    const glm::dvec3 along = glm::normalize(direction);
    const glm::dvec3 right = glm::normalize(glm::cross(along, up));
    reference::View view;
    view.direction = plain(along);
    view.right = plain(right);
    view.up = plain(glm::cross(right, along));
    view.target = plain(target);
    view.pixelWorld = pixelWorld;
    view.width = size.x;
    view.height = size.y;
    return view;
}

double psnr(const Image& image, const reference::Picture& picture) {
    EXPECT_EQ(image.rgba.size(), 4 * picture.size());
    double squares = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        for (int c = 0; c < 4; ++c) {
            squares += std::pow(image.rgba[4 * i + c] - picture[i][c], 2);
        }
    }
    return -10 * std::log10(squares / double(4 * picture.size()) + 1e-300);
}

}  // namespace deltasplat::test
