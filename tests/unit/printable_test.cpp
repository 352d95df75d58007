// SPDX-License-Identifier: Apache-2.0
#include "printable.h"

#include <gtest/gtest.h>

namespace deltasplat {
namespace {

TEST(Printable, TextStays) {
    for (const std::string text : {"", "a b",
                                   "Sch\xc3\xa4"
                                   "del",
                                   "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                                   "\xef\xbf\xbd", "\xf0\x9f\xa7\xa0", "\xf4\x8f\xbf\xbf"}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, WhatControlsATerminalDoesNot) {
    EXPECT_EQ(printable("a\x1b[31m\r\n\t\x7f"), "a?[31m????");
    EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m\xc2\x80"),
              "?31m?");
}

// Each byte is one sign, and what follows is read as if it were not there.
TEST(Printable, BytesThatAreNoUtf8DoNot) {
    EXPECT_EQ(printable("Sch\xe4"
                        "del"),
              "Sch?del");
    EXPECT_EQ(printable("\x9b"
                        "31m"),
              "?31m");
    EXPECT_EQ(printable("\xc0\xaf"), "??");
    EXPECT_EQ(printable("\xe0\x9f\xbf"), "???");
    EXPECT_EQ(printable("\xed\xa0\x80"), "???");
    EXPECT_EQ(printable("\xf0\x8f\xbf\xbf"), "????");
    EXPECT_EQ(printable("\xf4\x90\x80\x80\xff"), "?????");
    EXPECT_EQ(printable("a\xe2\x82"), "a??");
    EXPECT_EQ(printable("\xe2\x82x\xc3"), "??x?");
}

}  // namespace
}  // namespace deltasplat
