// SPDX-License-Identifier: Apache-2.0
#include "volume/tree_grid.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/error_of.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

TEST(TreeGrid, EachTreeIsAppliedAsWhatItIs) {
    const std::vector<std::pair<std::shared_ptr<openvdb::TreeBase>, std::string>> trees{
        {std::make_shared<openvdb::FloatTree>(), "float"},
        {std::make_shared<openvdb::DoubleTree>(), "double"},
        {std::make_shared<openvdb::Int32Tree>(), "int32"},
        {std::make_shared<openvdb::Int64Tree>(), "int64"},
        {std::make_shared<openvdb::BoolTree>(), "bool"},
        {std::make_shared<openvdb::MaskTree>(), "mask"}};
    for (const auto& [tree, type] : trees) {
        const TreeGrid grid{tree, {}};
        EXPECT_EQ(grid.type(), type);
        int applied = 0;
        EXPECT_TRUE(grid.apply<ScalarTrees>([&](const auto& typed) {
            using Tree = std::decay_t<decltype(typed)>;
            EXPECT_EQ(&typed, static_cast<const Tree*>(tree.get()));
            EXPECT_EQ(Tree::treeType(), tree->type());
            EXPECT_EQ(grid.as<Tree>(), &typed);
            ++applied;
        }));
        EXPECT_EQ(applied, 1) << type;
        EXPECT_EQ(grid.as<openvdb::FloatTree>() != nullptr, type == "float");
        EXPECT_EQ(grid.as<openvdb::BoolTree>() != nullptr, type == "bool");
    }
}

TEST(TreeGrid, OtherTreesAreNotApplied) {
    const TreeGrid grid{std::make_shared<openvdb::Vec3STree>(), {}};
    EXPECT_FALSE(grid.apply<ScalarTrees>([](const auto&) { FAIL(); }));
    EXPECT_FALSE(grid.as<openvdb::FloatTree>());
    EXPECT_TRUE(grid.as<openvdb::Vec3STree>());
    EXPECT_TRUE(test::errorOf([&] { toOpenVdb(grid); }).find("vec3s") != std::string::npos);
}

// What is changed is the tree that is held, not a copy.
TEST(TreeGrid, TreesCanBeChanged) {
    TreeGrid grid{std::make_shared<openvdb::Int32Tree>(7), {}};
    EXPECT_TRUE(
        grid.apply<ScalarTrees>([](auto& tree) { tree.setValueOn(openvdb::Coord(1, 2, 3)); }));
    EXPECT_EQ(grid.tree->activeVoxelCount(), 1u);
    grid.as<openvdb::Int32Tree>()->setValue(openvdb::Coord(-1), 9);
    EXPECT_EQ(grid.as<openvdb::Int32Tree>()->getValue(openvdb::Coord(-1)), 9);
}

TEST(TreeGrid, NamesAreWhatOpenVdbTakesForNames) {
    const auto grid = openvdb::FloatGrid::create();
    EXPECT_EQ(fromOpenVdb(grid).name(), grid->getName());
    const auto expectSame = [&](const openvdb::Metadata& name) {
        grid->removeMeta("name");
        grid->insertMeta("name", name);
        EXPECT_EQ(fromOpenVdb(grid).name(), grid->getName());
    };
    expectSame(openvdb::StringMetadata("fog"));
    expectSame(openvdb::Int32Metadata(-7));
    expectSame(openvdb::Int64Metadata(1ll << 40));
    expectSame(openvdb::BoolMetadata(true));
    expectSame(openvdb::BoolMetadata(false));
}

TEST(TreeGrid, OpenVdbsGridsComeBack) {
    openvdb::initialize();
    using namespace openvdb::math;
    // Transform's constructor would round the scale: (0.1 + 0.7) - 0.7 is not 0.1.
    const auto map = std::make_shared<ScaleTranslateMap>(Vec3d(0.1, 0.2, 0.3), Vec3d(0.7, 0, -5));
    const auto tree = std::make_shared<openvdb::DoubleTree>(0.25);
    tree->setValueOn(openvdb::Coord(3, -4, 5), -0.0);
    TreeGrid grid{tree, {}, map};
    grid.metadata.insert(openvdb::GridBase::META_GRID_NAME, std::string("density"));
    grid.metadata.insert(openvdb::GridBase::META_GRID_CLASS, std::string("fog volume"));
    grid.metadata.insert("frame", std::int32_t(-3));
    EXPECT_EQ(grid.name(), "density");

    const openvdb::GridBase::Ptr theirs = toOpenVdb(grid);
    ASSERT_TRUE(theirs->isType<openvdb::DoubleGrid>());
    EXPECT_EQ(theirs->baseTreePtr(), grid.tree);
    EXPECT_EQ(theirs->getName(), "density");
    EXPECT_EQ(theirs->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(theirs->metaValue<openvdb::Int32>("frame"), -3);
    EXPECT_TRUE(theirs->transform().baseMap()->isType<ScaleTranslateMap>());
    EXPECT_EQ(matrixOf(*theirs->transform().baseMap()), matrixOf(*map));

    const TreeGrid back = fromOpenVdb(theirs);
    EXPECT_EQ(back.tree, grid.tree);
    EXPECT_EQ(back.metadata.entries(), grid.metadata.entries());
    EXPECT_EQ(back.map->type(), map->type());
    EXPECT_EQ(matrixOf(*back.map), matrixOf(*map));
}

}  // namespace
}  // namespace deltasplat
