// SPDX-License-Identifier: Apache-2.0
#include "volume/vdb_transform.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>
#include <openvdb/io/Archive.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

using namespace openvdb::math;

std::vector<MapBase::Ptr> oneOfEach() {
    openvdb::initialize();
    const Vec3d scale(2, 0.5, -3), move(1, -20, 300);
    Mat4d affine = Mat4d::identity();
    affine.preRotate(X_AXIS, 0.3);
    affine.preScale(Vec3d(1, 2, 3));
    affine.preTranslate(move);
    const auto slanted = std::make_shared<AffineMap>(affine);
    return {slanted,
            std::make_shared<ScaleMap>(scale),
            std::make_shared<ScaleTranslateMap>(scale, move),
            std::make_shared<TranslationMap>(move),
            std::make_shared<UniformScaleMap>(0.1),
            std::make_shared<UniformScaleTranslateMap>(0.1, move),
            std::make_shared<UnitaryMap>(Vec3d(0, 0, 1), 0.5),
            std::make_shared<NonlinearFrustumMap>(openvdb::BBoxd(Vec3d(0), Vec3d(100)), 0.5, 10,
                                                  slanted)};
}

std::string bytesOf(const MapBase& map) {
    std::ostringstream stream;
    openvdb::writeString(stream, map.type());
    map.write(stream);
    return stream.str();
}

TEST(ReadMap, ReadsWhatOpenVdbReads) {
    const std::vector<MapBase::Ptr> maps = oneOfEach();
    for (const MapBase::Ptr& map : maps) {
        std::istringstream stream(bytesOf(*map) + "rest"), theirs(bytesOf(*map));
        const MapBase::Ptr read = readMap(stream);
        EXPECT_EQ(read->type(), map->type());
        EXPECT_TRUE(read->isEqual(*map)) << map->type();
        EXPECT_EQ(std::size_t(stream.tellg()), bytesOf(*map).size()) << map->type();
        openvdb::io::setCurrentVersion(theirs);
        Transform transform;
        transform.read(theirs);
        EXPECT_TRUE(transform.baseMap()->isEqual(*read)) << map->type();
        if (map->isLinear()) {
            EXPECT_EQ(matrixOf(*read), matrixOf(*map)) << map->type();
        }
    }
}

TEST(ReadMap, RefusesMapsOfNoTypeKnown) {
    for (const char* const type : {"", "Map", "affinemap"}) {
        std::ostringstream bytes;
        openvdb::writeString(bytes, type);
        std::istringstream stream(bytes.str());
        EXPECT_THROW(readMap(stream), openvdb::KeyError) << type;
    }
}

TEST(MakeMapOfType, MakesLinearMapsAgain) {
    std::vector<MapBase::Ptr> maps = oneOfEach();
    // (0.1 + 0.7) - 0.7 is not 0.1.
    maps.push_back(std::make_shared<ScaleTranslateMap>(Vec3d(0.1, 0.1, 0.3), Vec3d(0.7, 1e5, -3)));
    maps.push_back(std::make_shared<UniformScaleTranslateMap>(0.1, Vec3d(0.7, 1e5, -3)));
    maps.push_back(std::make_shared<ScaleMap>(Vec3d(1, std::nextafter(1, 2), 1)));
    maps.push_back(std::make_shared<AffineMap>(Mat4d::identity()));
    maps.push_back(std::make_shared<UnitaryMap>());
    for (const MapBase::Ptr& map : maps) {
        if (!map->isLinear()) continue;
        const MapBase::Ptr again = makeMapOfType(map->type(), matrixOf(*map));
        EXPECT_EQ(again->type(), map->type());
        EXPECT_EQ(bytesOf(*again), bytesOf(*map)) << map->type();
    }
}

TEST(MakeMapOfType, TakesTheSimplestWhereThatTypeCannotBe) {
    const auto typeOf = [](const char* type, const MapBase& map) {
        const MapBase::Ptr made = makeMapOfType(type, matrixOf(map));
        EXPECT_EQ(matrixOf(*made), matrixOf(map));
        return made->type();
    };
    const ScaleTranslateMap moved(Vec3d(1, 2, 3), Vec3d(4, 5, 6));
    for (const char* const type : {"", "Map", "ScaleMap", "UniformScaleMap", "TranslationMap",
                                   "UnitaryMap", "NonlinearFrustumMap"})
        EXPECT_EQ(typeOf(type, moved), "ScaleTranslateMap") << type;
    EXPECT_EQ(typeOf("AffineMap", moved), "AffineMap");
    EXPECT_EQ(typeOf("ScaleMap", ScaleMap(Vec3d(2))), "ScaleMap");
    EXPECT_EQ(typeOf("", ScaleMap(Vec3d(2))), "UniformScaleMap");
}

TEST(WorldFromIndex, RefusesWhatPlacesNoVolume) {
    const auto refusal = [](const MapBase& map) -> std::string {
        try {
            worldFromIndexOf(map, "here");
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    };
    const std::vector<MapBase::Ptr> maps = oneOfEach();
    for (const MapBase::Ptr& map : maps) {
        EXPECT_EQ(refusal(*map), map->isLinear() ? ""
                                                 : "here: got a NonlinearFrustumMap transform; "
                                                   "expected a linear one (no frustum)");
    }
}

}  // namespace
}  // namespace deltasplat
