// SPDX-License-Identifier: Apache-2.0
#include "volume/vdb_metadata.h"
#include "volume/tree_types.h"

#include <gtest/gtest.h>
#include <openvdb/util/Util.h>

#include <sstream>
#include <string>
#include <utility>

#include "formats/vdb/grid_metadata.h"

namespace deltasplat {
namespace {

openvdb::MetaMap someOfEach() {
    using namespace openvdb;
    initialize();
    MetaMap all;
    all.insertMeta("text", StringMetadata("some text"));
    all.insertMeta("empty", StringMetadata(""));
    all.insertMeta("zero inside", StringMetadata(std::string("a\0b", 3)));
    all.insertMeta("yes", BoolMetadata(true));
    all.insertMeta("whole", Int32Metadata(-7));
    all.insertMeta("long", Int64Metadata(std::int64_t{1} << 40));
    all.insertMeta("single", FloatMetadata(0.1f));
    all.insertMeta("real", DoubleMetadata(0.1));
    all.insertMeta("corner", Vec3IMetadata({1, -2, 3}));
    all.insertMeta("place", Vec3DMetadata({0.5, -2, 3e300}));
    all.insertMeta("matrix", Mat4DMetadata(math::Mat4d::identity()));
    return all;
}

TEST(VdbMetadata, HasWhatOpenVdbHas) {
    const openvdb::MetaMap all = someOfEach();
    const VdbMetadata metadata = all;
    EXPECT_EQ(metadata.entries().size(), all.metaCount());
    EXPECT_EQ(metadata.text("text"), "some text");
    EXPECT_EQ(metadata.text("zero inside"), std::string("a\0b", 3));
    EXPECT_EQ(metadata.get<std::string>("empty"), "");
    EXPECT_EQ(metadata.get<std::int32_t>("whole"), -7);
    EXPECT_EQ(metadata.get<std::int64_t>("long"), std::int64_t{1} << 40);
    EXPECT_EQ(metadata.get<double>("real"), 0.1);
    EXPECT_EQ(metadata.get<glm::ivec3>("corner"), glm::ivec3(1, -2, 3));
    EXPECT_EQ(metadata.find("place")->type, "vec3d");
    EXPECT_EQ(*metadata.toMetaMap("here"), all);
}

TEST(VdbMetadata, IsWrittenAsOpenVdbWritesIt) {
    const openvdb::MetaMap all = someOfEach();
    std::ostringstream stream;
    all.writeMeta(stream);
    EXPECT_EQ(VdbMetadata(all).bytes(), stream.str());
}

TEST(VdbMetadata, HasNothingOfAnotherNameOrType) {
    VdbMetadata metadata;
    metadata.insert("a", 1.5);
    EXPECT_EQ(metadata.get<double>("a"), 1.5);
    EXPECT_EQ(metadata.get<std::int64_t>("a"), std::nullopt);
    EXPECT_EQ(metadata.get<double>("b"), std::nullopt);
    EXPECT_EQ(metadata.text("a"), "");
    EXPECT_EQ(metadata.find("b"), nullptr);
    metadata.insert("a", std::string("text"));
    EXPECT_EQ(metadata.text("a"), "text");
    metadata.erase("a");
    EXPECT_TRUE(metadata.entries().empty());
}

// Types that a program has registered for itself may have any size.
TEST(VdbMetadata, LeavesOutTypesThatAreNotKnown) {
    openvdb::initialize();
    openvdb::MetaMap all;
    all.insertMeta("half", openvdb::TypedMetadata<openvdb::math::half>(openvdb::math::half(1)));
    all.insertMeta("known", openvdb::FloatMetadata(1));
    EXPECT_EQ(VdbMetadata(all).entries().size(), 1u);
}

TEST(GridClass, IsThatOfOpenVdb) {
    for (const char* const text :
         {"level set", "fog volume", "staggered", "unknown", " Level Set\n", "FOG VOLUME",
          "\tstaggered ", "fog", "level  set", "", " ", "level set\v\f\r"}) {
        openvdb::MetaMap metadata;
        metadata.insertMeta(openvdb::GridBase::META_GRID_CLASS, openvdb::StringMetadata(text));
        EXPECT_EQ(gridClassOf(metadata),
                  openvdb::GridBase::gridClassToString(openvdb::GridBase::stringToGridClass(text)))
            << '"' << text << '"';
    }
    EXPECT_EQ(gridClassOf(VdbMetadata()), kUnknownClass);
    VdbMetadata number;
    number.insert(openvdb::GridBase::META_GRID_CLASS, 1.0);
    EXPECT_EQ(gridClassOf(number), kUnknownClass);
}

// The program has them before it has OpenVDB's library.
TEST(NamesOfMetadata, AreThoseOfTheLibrary) {
    for (const auto& [library, ours] : {
#define NAME(member, text) std::pair<std::string, std::string>(openvdb::GridBase::member, text),
#include "modules/openvdb_names.inc"
#undef NAME
         })
        EXPECT_EQ(ours, library);
    EXPECT_EQ(openvdb::util::INVALID_IDX, openvdb::Index32(-1));
}

}  // namespace
}  // namespace deltasplat
