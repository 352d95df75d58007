// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenEXR project, "Standard Attributes" (worldToCamera, worldToNDC). Renderers
// deviate: camera space is left-handed (z forward) or right-handed, and NDC y runs down from 0 to 1
// or up from -1 to 1. The matrices reveal which.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <string>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/hold_out.h"
#include "deltasplat/progress.h"
#include "files/file_name.h"
#include "formats/cameras/motion.h"
#include "modules/image_module.h"
#include "oiio/image_file.h"
#include "view/camera_axes.h"

namespace deltasplat {

namespace {

// Relative rounding error after multiplying a float matrix by another's inverse.
constexpr double kRounding = 1e-4;

glm::dmat4 readMatrix(const std::filesystem::path& file, const OIIO::ImageSpec& spec,
                      const char* name) {
    std::array<double, 16> v{};
    const OIIO::ParamValue* attribute = spec.find_attribute(name);
    const OIIO::TypeDesc type = attribute ? attribute->type() : OIIO::TypeDesc();
    const bool isDouble = type.basetype == OIIO::TypeDesc::DOUBLE;
    const std::size_t bytes = 16 * (isDouble ? sizeof(double) : sizeof(float));
    if (!(isDouble || type.basetype == OIIO::TypeDesc::FLOAT) || type.size() != bytes)
        refuseFile(file, std::string("no matrix ") + name,
                   "worldToCamera and worldToNDC among its metadata");
    for (std::size_t i = 0; i < 16; ++i)
        v[i] = isDouble ? static_cast<const double*>(attribute->data())[i]
                        : double(static_cast<const float*>(attribute->data())[i]);
    if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }))
        refuseFile(file, std::string(name) + " with a number that is not finite", "finite ones");
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = v[std::size_t(i)];
    return matrix;
}

glm::dmat4 inverseOf(const std::filesystem::path& file, const glm::dmat4& matrix) {
    glm::dmat4 inverse = glm::inverse(matrix);
    // Rounding must not turn an affine matrix into a projection.
    const bool isAffine =
        matrix[0].w == 0 && matrix[1].w == 0 && matrix[2].w == 0 && matrix[3].w == 1;
    for (int i = 0; isAffine && i < 4; ++i) inverse[i].w = matrix[i].w;
    if (std::isfinite(glm::determinant(inverse)) && glm::determinant(inverse) != 0) return inverse;
    refuseFile(file, "a worldToCamera that is singular", "one that can be inverted");
}

// Maps a point (x, y) of camera space, at depth 1 or for a parallel picture at any depth, to
// picture coordinates: `scale` * point + `middle`.
struct PictureMap {
    bool isParallel = false;
    glm::dvec2 scale{1};
    glm::dvec2 middle{0};
};

// @param ndcFromDepth  NDC from (right, up, ahead)
PictureMap pictureMap(const std::filesystem::path& file, const glm::dmat4& ndcFromDepth) {
    const glm::dmat4& m = ndcFromDepth;
    const double largest = std::max({std::abs(m[0][0]), std::abs(m[1][1]), kRounding});
    const auto isNothing = [&](double x) { return std::abs(x) <= kRounding * largest; };
    PictureMap map;
    map.isParallel = std::abs(m[3][3]) > std::abs(m[2][3]);
    const int along = map.isParallel ? 3 : 2;
    const bool isStraight = isNothing(m[0][1]) && isNothing(m[1][0]) && isNothing(m[0][3]) &&
                            isNothing(m[1][3]) && m[0][0] != 0 && m[1][1] != 0;
    if (!isStraight || m[along][3] == 0)
        refuseFile(file, "a worldToNDC that is no picture of what worldToCamera sees",
                   "both of the same camera");
    map.scale = glm::dvec2(m[0][0], m[1][1]) / m[along][3];
    map.middle = glm::dvec2(m[along]) / m[along][3];
    if (map.scale.x < 0) refuseFile(file, "a worldToNDC that is mirrored", "x to the right");
    return map;
}

}  // namespace

CameraMotion image_module::readExrCamera(const std::filesystem::path& file,
                                         const Listener& listener) {
    const ImageFile image(file, ImagePages(file), 0);
    const OIIO::ImageSpec& spec = image.spec();
    glm::dmat4 cameraFromWorld = readMatrix(file, spec, "worldToCamera");
    const glm::dmat4 ndcFromWorld = readMatrix(file, spec, "worldToNDC");
    if (glm::determinant(glm::dmat3(cameraFromWorld)) < 0) {
        // Left-handed: z points forward.
        for (int i = 0; i < 4; ++i) cameraFromWorld[i].z = -cameraFromWorld[i].z;
    }
    FilmCamera camera;
    camera.worldFromCamera = inverseOf(file, cameraFromWorld);
    cameraAxes(camera.worldFromCamera, file.string() + ": worldToCamera", ErrorCode::kInput);
    glm::dmat4 cameraFromDepth(1);
    cameraFromDepth[2][2] = -1;
    const PictureMap map =
        pictureMap(file, ndcFromWorld * (camera.worldFromCamera * cameraFromDepth));

    // NDC y runs from 0 to 1 downwards, or from -1 to 1 upwards.
    const bool goesUp = map.scale.y > 0;
    if (goesUp)
        listener.warn(file.string() + ": worldToNDC goes up, not down, and is read as -1 to 1");
    const double range = goesUp ? 2 : 1;
    const double middle = goesUp ? 0 : 0.5;
    const glm::dvec2 frame = range / glm::abs(map.scale);
    const glm::dvec2 size(spec.full_width, spec.full_height);
    if (!(size.x >= 1 && size.y >= 1)) refuseFile(file, "no display window", "one");
    camera.sizePixels = glm::ivec2(size);
    camera.pixelAspect = frame.x / size.x / (frame.y / size.y);
    // Removes rounding from square pixels.
    if (std::abs(camera.pixelAspect - 1) < kRounding) camera.pixelAspect = 1;
    if (!(camera.pixelAspect >= kLeastPixelAspect && camera.pixelAspect <= kMostPixelAspect))
        refuseFile(file, "pixels " + numberText(camera.pixelAspect) + " times as wide as high",
                   "0.01 to 100 times");
    camera.apertureMm = {kDefaultApertureMm, 0};
    const glm::dvec2 share((middle - map.middle.x) / range,
                           (goesUp ? middle - map.middle.y : map.middle.y - middle) / range);
    const double height = kDefaultApertureMm / camera.pixelAspect * size.y / size.x;
    camera.offsetMm = share * glm::dvec2(kDefaultApertureMm, height);
    if (map.isParallel) {
        camera.projection = Projection::kOrtho;
        camera.frameWidthWorld = frame.x;
    } else {
        camera.focalMm = kDefaultApertureMm / frame.x;
    }
    return {{}, [camera](double) { return camera; }, {}};
}

namespace {

// Renderers write this depth, or more, for empty pixels.
constexpr float kNothing = 1e10f;

// Returns the last part of a layer's name: "depth" of "ViewLayer.Depth.Z".
std::string layerOf(const std::string& channel) {
    const std::string layer = channel.substr(0, channel.rfind('.'));
    return layer.substr(layer.rfind('.') + 1);
}

int depthChannel(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
    const auto find = [&](const auto& suits) {
        for (int i = 0; i < spec.nchannels; ++i)
            if (suits(lowerCase(spec.channelnames[std::size_t(i)]))) return i;
        return -1;
    };
    int found = find([](const std::string& name) { return name == "z"; });
    if (found < 0) found = find([](const std::string& name) { return name == "depth"; });
    if (found < 0) {
        found = find([](const std::string& name) {
            return name.ends_with(".z") && layerOf(name).find("depth") != std::string::npos;
        });
    }
    if (found < 0 && spec.nchannels == 1) found = 0;
    if (found >= 0) return found;
    refuseFile(file, sizeText(spec), "a channel Z");
}

}  // namespace

DepthImage image_module::readDepthImage(const std::filesystem::path& file,
                                        const Listener& listener) {
    const DefaultFloats floats;
    if (lowerExtension(file) != ".exr")
        refuseFile(file, "another format", "an .exr with a channel Z");
    const ImagePages pages(file);
    ImageFile image(file, pages, 0);
    const OIIO::ImageSpec& spec = image.spec();
    requireSane(file, spec);
    const int channel = depthChannel(file, spec);
    DepthImage result{{spec.width, spec.height}, {}};
    const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
    const auto channels = std::size_t(channel) + 1;
    requireClaimedMemory(file.string(), 4.0 * double(pixels) * double(channels + 1));
    std::vector<float> values(pixels * channels);
    image.read(int(channels), OIIO::TypeDesc::FLOAT, values.data());
    result.depths.resize(pixels);
    std::size_t odd = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        float& depth = result.depths[i];
        depth = values[i * channels + channels - 1];
        if (!(depth > 0)) ++odd;
        if (!(depth > 0) || depth >= kNothing) depth = std::numeric_limits<float>::infinity();
    }
    if (odd > 0) {
        listener.warn(file.string() + ": " +
                      countText(std::uint64_t(odd), "pixel whose depth is not above 0 stands",
                                "pixels whose depth is not above 0 stand") +
                      " for nothing there");
    }
    return result;
}

}  // namespace deltasplat
