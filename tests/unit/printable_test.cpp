// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

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

// A name must not make what stands behind it read otherwise, nor look like another name.
TEST(Printable, WhatTurnsOrHidesTextDoesNot) {
    EXPECT_EQ(printable("cloud\xe2\x80\xaegnp.vdb"), "cloud?gnp.vdb");  // U+202E
    for (const std::string sign :
         {"\xc2\xad", "\xd8\x9c", "\xe1\xa0\x8e", "\xe2\x80\x8b", "\xe2\x80\x8e", "\xe2\x80\x8f",
          "\xe2\x80\xa8", "\xe2\x80\xa9", "\xe2\x80\xaa", "\xe2\x81\xa0", "\xe2\x81\xa6",
          "\xe2\x81\xa9", "\xef\xbb\xbf", "\xef\xbf\xb9", "\xf3\xa0\x80\x81", "\xf3\xa0\x81\xbf"}) {
        EXPECT_EQ(printable("a" + sign + "b"), "a?b");
    }
    // Joiners and what comes right before and behind the others are of words.
    for (const std::string sign : {"\xe2\x80\x8c", "\xe2\x80\x8d", "\xe2\x80\xa7", "\xe2\x80\xaf",
                                   "\xc2\xae", "\xef\xbb\xbe", "\xf3\xa0\x84\x80"}) {
        EXPECT_EQ(printable("a" + sign + "b"), "a" + sign + "b");
    }
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
