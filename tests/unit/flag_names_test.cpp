// SPDX-License-Identifier: Apache-2.0
#include "flag_names.h"

#include <gtest/gtest.h>

namespace deltasplat {
namespace {

TEST(FlagNames, FieldsBecomeFlags) {
    EXPECT_EQ(withFlagNames("`extinctionScale`: got -1; expected a number >= 0"),
              "--extinction: got -1; expected a number >= 0");
    EXPECT_EQ(withFlagNames("`tolerance.value`"), "--tolerance-value");
    EXPECT_EQ(withFlagNames("it, `eyeWorld` and `targetWorld`"), "it, --eye and --target");
    EXPECT_EQ(withFlagNames("read it with `type` uint16 `bigEndian=true`"),
              "read it with --type uint16 --endian big");
    EXPECT_EQ(withFlagNames("`up``view`"), "--up--view");
}

TEST(FlagNames, AllElseStays) {
    for (const std::string text :
         {"", "up", "`", "``", "`up", "up`", "`Up`", "` up`", "`upper`", "`a b`: cannot be read"})
        EXPECT_EQ(withFlagNames(text), text);
}

TEST(FlagNames, ABackquoteMayStandAlone) {
    EXPECT_EQ(withFlagNames("a`b.vdb: `up` and `x`view`"), "a`b.vdb: --up and `x--view");
}

}  // namespace
}  // namespace deltasplat
