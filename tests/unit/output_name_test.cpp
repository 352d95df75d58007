// SPDX-License-Identifier: Apache-2.0
#include "batch/output_name.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "deltasplat/error.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

std::string filled(const std::string& name, const std::string& file, const std::string& folder = "",
                   const std::string& grid = "") {
    try {
        InputParts parts = partsOfInput(file, folder);
        parts.grid = grid;
        return OutputName("--output", name).of(parts, file).string();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kUsage);
        return error.what();
    }
}

TEST(OutputName, FillsAllPlaces) {
    EXPECT_EQ(filled("t/{name}.png", "s/a.b.vdb"), "t/a.b.png");
    EXPECT_EQ(filled("t/{name}.png", "s/a.nii.gz"), "t/a.png");
    EXPECT_EQ(filled("t/{dir}/{name}.png", "s/f/g/a.vdb", "f/g"), "t/f/g/a.png");
    EXPECT_EQ(filled("{name}_{grid}.png", "a.vdb", "", "heat"), "a_heat.png");
    EXPECT_EQ(filled("{name}{name}.png", "a.vdb"), "aa.png");
}

TEST(OutputName, TakesTheSlashOfNoFolder) {
    EXPECT_EQ(filled("{dir}/{name}.png", "a.vdb"), "a.png");
    EXPECT_EQ(filled("t/{dir}/{name}.png", "a.vdb"), "t/a.png");
    EXPECT_EQ(filled("{dir}/{dir}/{name}.png", "a.vdb"), "a.png");
}

TEST(OutputName, KeepsTheSlashOfAnotherFolder) {
    EXPECT_EQ(filled("{dir}_{name}.png", "a.vdb"), "_a.png");
    EXPECT_EQ(filled("sub{dir}/{name}.png", "a.vdb"), "sub/a.png");
    EXPECT_EQ(filled("t/{name}{dir}/b.png", "a.vdb"), "t/a/b.png");
}

TEST(OutputName, FillsTheLastNumber) {
    EXPECT_EQ(filled("t.{frame}.png", "puff_v2.0017.vdb"), "t.0017.png");
    EXPECT_EQ(filled("t.{frame}.png", "12.vdb"), "t.12.png");
    EXPECT_EQ(filled("t.{frame}.png", "s4/puff.vdb"),
              "--output: got t.{frame}.png for s4/puff.vdb; expected inputs with a number in their "
              "names for {frame}");
}

// Grids have names that files cannot have.
TEST(OutputName, MakesFileNamesOfGrids) {
    EXPECT_EQ(filled("t/{grid}.png", "a.vdb", "", "fire/heat"), "t/fire_heat.png");
    EXPECT_EQ(filled("t/{grid}/a.png", "a.vdb", "", ".."), "t/_./a.png");
}

TEST(OutputName, KnowsBraces) {
    EXPECT_EQ(filled("{{{name}}}.png", "a.vdb"), "{a}.png");
    EXPECT_EQ(filled("{{x}}{name}.png", "a.vdb"), "{x}a.png");
    EXPECT_EQ(filled("\\{x\\}{name}\\#\\@.png", "a.vdb"), "{x}a#@.png");
    EXPECT_FALSE(hasPlaceholder("\\{name\\}.png"));
}

TEST(OutputName, TakesFoldersThatAreThereAsTheyAre) {
    const test::TempFolder folder;
    const auto in = [&](const std::string& name) { return (folder / name).string(); };
    std::filesystem::create_directories(folder / "{x}/{name}");
    EXPECT_EQ(filled(in("{x}/{name}/{name}.png"), "a.vdb"), in("{x}/{name}/a.png"));
    EXPECT_EQ(filled(in("{x}/{dir}/{name}.png"), "a.vdb", "b"), in("{x}/b/a.png"));
    EXPECT_FALSE(hasPlaceholder(folder / "{x}/{name}/a.png"));
}

TEST(OutputName, RefusesOthers) {
    const std::string known = "{name}, {dir}, {frame} or {grid}";
    EXPECT_EQ(filled("{nam}.png", "a.vdb"),
              "--output: got {nam} (a brace by itself is {{); expected " + known);
    EXPECT_EQ(filled("{}.png", "a.vdb"),
              "--output: got {} (a brace by itself is {{); expected " + known);
    EXPECT_EQ(filled("{name.png", "a.vdb"),
              "--output: got { without } (a brace by itself is {{); expected " + known);
    EXPECT_EQ(filled("a.png", "a.vdb"),
              "--output: got a.png with a pattern of inputs; expected a name with " + known);
    EXPECT_EQ(filled("{{name}}.png", "a.vdb"),
              "--output: got {{name}}.png with a pattern of inputs; expected a name with " + known);
}

TEST(OutputName, KnowsWhetherThereAreAny) {
    EXPECT_TRUE(hasPlaceholder("t/{name}.png"));
    EXPECT_TRUE(hasPlaceholder("{grid}.png"));
    EXPECT_FALSE(hasPlaceholder("{other}.png"));
    EXPECT_FALSE(hasPlaceholder("t.####.png"));
    EXPECT_TRUE(OutputName("-o", "{grid}.png").hasGrid());
    EXPECT_FALSE(OutputName("-o", "{name}.grid.png").hasGrid());
}

}  // namespace
}  // namespace deltasplat
