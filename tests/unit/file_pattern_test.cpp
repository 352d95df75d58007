// SPDX-License-Identifier: Apache-2.0
#include "batch/file_pattern.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <vector>

#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

TEST(FitsPattern, KnowsWildcards) {
    EXPECT_TRUE(fitsPattern("a.vdb", "*.vdb"));
    EXPECT_TRUE(fitsPattern("a.vdb", "*"));
    EXPECT_TRUE(fitsPattern("", "*"));
    EXPECT_TRUE(fitsPattern("a.vdb.vdb", "*.vdb"));
    EXPECT_TRUE(fitsPattern("abcabd", "*ab?"));
    EXPECT_TRUE(fitsPattern("a1b2", "a*b*"));
    EXPECT_FALSE(fitsPattern("a.vdb", "*.vd"));
    EXPECT_FALSE(fitsPattern("a.vdb", "?.vdb?"));
    EXPECT_FALSE(fitsPattern("", "?"));
    EXPECT_FALSE(fitsPattern("ab", "a"));
}

TEST(FitsPattern, KnowsClasses) {
    EXPECT_TRUE(fitsPattern("s7", "s[0-9]"));
    EXPECT_FALSE(fitsPattern("sx", "s[0-9]"));
    EXPECT_TRUE(fitsPattern("sx", "s[!0-9]"));
    EXPECT_FALSE(fitsPattern("s7", "s[^0-9]"));
    EXPECT_TRUE(fitsPattern("]", "[]a]"));
    EXPECT_TRUE(fitsPattern("-", "[a-]"));
    // Without an end it is a bracket.
    EXPECT_TRUE(fitsPattern("s[0", "s[0"));
}

TEST(FitsPattern, CountsCharactersOfUtf8) {
    EXPECT_TRUE(fitsPattern("\xc3\xa4.vdb", "?.vdb"));
    EXPECT_TRUE(fitsPattern("\xc3\xa4", "[\xc3\xa0-\xc3\xbf]"));
    EXPECT_FALSE(fitsPattern("\xc3\xa4", "??"));
    // Bytes that are none are characters as well.
    EXPECT_TRUE(fitsPattern("\xff\xfe", "??"));
    EXPECT_TRUE(fitsPattern("a\xff", "a\xff"));
    EXPECT_FALSE(fitsPattern("a\xff", "a\xfe"));
}

TEST(FitsPattern, TakesWhatIsEscapedAsItIs) {
    EXPECT_TRUE(fitsPattern("a*", "a\\*"));
    EXPECT_FALSE(fitsPattern("ab", "a\\*"));
    EXPECT_TRUE(fitsPattern("a[1]", "a\\[1]"));
}

// Names are found in time that grows with their length times the pattern's, not faster.
TEST(FitsPattern, EndsWithManyStars) {
    std::string pattern;
    for (int i = 0; i < 40; ++i) pattern += "*a";
    EXPECT_FALSE(fitsPattern(std::string(2000, 'a') + "b", pattern));
}

class FindFiles : public testing::Test {
  protected:
    void put(const std::string& name) {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << "a";
    }
    std::vector<std::string> find(const std::string& pattern) {
        std::vector<std::string> found;
        for (const FoundFile& one : findFiles(folder_ / pattern, {}).files) {
            found.push_back(one.folder.string() + ":" +
                            one.file.lexically_relative(folder_.path()).string());
        }
        return found;
    }
    using Names = std::vector<std::string>;

    test::TempFolder folder_;
};

TEST_F(FindFiles, CountsNumbersInNames) {
    for (const char* name : {"a10.vdb", "a9.vdb", "b.vdb", "a9.txt", "a1/x.vdb"}) put(name);
    EXPECT_EQ(find("*.vdb"), (Names{":a9.vdb", ":a10.vdb", ":b.vdb"}));
    EXPECT_EQ(find("a[0-9].*"), (Names{":a9.txt", ":a9.vdb"}));
}

TEST_F(FindFiles, WalksThroughFolders) {
    for (const char* name : {"s/x.vdb", "s/f10/x.vdb", "s/f9/x.vdb", "s/f9/deep/x.vdb", "t/x.vdb"})
        put(name);
    EXPECT_EQ(find("s/**/*.vdb"),
              (Names{"f9/deep:s/f9/deep/x.vdb", "f9:s/f9/x.vdb", "f10:s/f10/x.vdb", ":s/x.vdb"}));
    EXPECT_EQ(find("s/**"), find("s/**/*"));
    EXPECT_EQ(find("s/**/**/*.vdb"), find("s/**/*.vdb"));
    EXPECT_EQ(find("s/*/x.vdb"), (Names{"f9:s/f9/x.vdb", "f10:s/f10/x.vdb"}));
    EXPECT_EQ(find("*/x.vdb"), (Names{"s:s/x.vdb", "t:t/x.vdb"}));
    EXPECT_EQ(find("s/**/f9/**/x.vdb"), (Names{"f9/deep:s/f9/deep/x.vdb", "f9:s/f9/x.vdb"}));
    EXPECT_EQ(find("none/*.vdb"), Names());
    EXPECT_EQ(find("s/x.vdb/*"), Names());
}

TEST_F(FindFiles, FindsFoldersForASlash) {
    for (const char* name : {"scans/1.2/a", "scans/1.3/a", "scans/note"}) put(name);
    EXPECT_EQ(find("scans/*/"), (Names{":scans/1.2", ":scans/1.3"}));
    EXPECT_EQ(find("scans/*"), (Names{":scans/note"}));
}

TEST_F(FindFiles, LeavesHiddenOnesAlone) {
    for (const char* name : {".a.vdb", ".h/a.vdb", "b.vdb", ".deltasplat.b.vdb.1.tmp"}) put(name);
    EXPECT_EQ(find("**/*"), (Names{":b.vdb"}));
    EXPECT_EQ(find(".*"), (Names{":.a.vdb"}));
    EXPECT_EQ(find(".h/*"), (Names{":.h/a.vdb"}));
}

TEST_F(FindFiles, DoesNotGoRound) {
    put("s/a.vdb");
    fs::create_directory_symlink(folder_ / "s", folder_ / "s/round");
    fs::create_directory_symlink(folder_ / "s", folder_ / "link");
    EXPECT_EQ(find("s/**/*.vdb"), (Names{":s/a.vdb"}));
    // Links that are named, or fit by themselves, are followed.
    EXPECT_EQ(find("link/*.vdb"), (Names{":link/a.vdb"}));
    EXPECT_EQ(find("s/*/a.vdb"), (Names{"round:s/round/a.vdb"}));
}

// What leads nowhere has to be told of; what never ends is not opened.
TEST_F(FindFiles, TakesFilesAndBrokenLinks) {
    put("a.vdb");
    fs::create_symlink("nowhere", folder_ / "b.vdb");
    fs::create_symlink("c.vdb", folder_ / "c.vdb");
    fs::create_symlink("a.vdb", folder_ / "d.vdb");
    ASSERT_EQ(::mkfifo((folder_ / "e.vdb").c_str(), 0600), 0);
    fs::create_directory(folder_ / "f.vdb");
    EXPECT_EQ(find("*.vdb"), (Names{":a.vdb", ":b.vdb", ":c.vdb", ":d.vdb"}));
}

// What cannot be looked into keeps nothing else from being found.
TEST_F(FindFiles, TellsOfWhatIsNoFolder) {
    put("d1/a.vdb");
    put("d2/loop/x.vdb");
    fs::create_directory_symlink("loop", folder_ / "d1/loop");
    const std::string name(300, 'x');
    for (const std::string last : {"x.vdb", "*.vdb"}) {
        const FoundFiles found = findFiles(folder_ / "d*/loop" / last, {});
        ASSERT_EQ(found.files.size(), 1U) << last;
        EXPECT_EQ(found.files[0].file, folder_ / "d2/loop/x.vdb");
        ASSERT_EQ(found.unread.size(), 1U) << last;
        EXPECT_EQ(found.unread[0].first, folder_ / "d1/loop");
        EXPECT_EQ(found.unread[0].second, std::make_error_code(std::errc(ELOOP)).message());
    }
    EXPECT_EQ(findFiles(folder_ / "d*" / name, {}).unread.size(), 2U);
    EXPECT_TRUE(findFiles(folder_ / "d*/none", {}).unread.empty());
    EXPECT_TRUE(findFiles(folder_ / "d*/a.vdb/x.vdb", {}).unread.empty());
}

TEST_F(FindFiles, TakesNamesOfAllKinds) {
    for (const char* name : {"a b.vdb", "a\nb.vdb", "a\xff.vdb", "a*b.vdb"}) put(name);
    EXPECT_EQ(find("a*.vdb").size(), 4U);
    EXPECT_EQ(find("a\\**.vdb"), (Names{":a*b.vdb"}));
}

TEST_F(FindFiles, KnowsPatterns) {
    put("a[1].vdb");
    EXPECT_FALSE(isPattern(folder_ / "a[1].vdb"));
    EXPECT_TRUE(isPattern(folder_ / "a[2].vdb"));
    EXPECT_TRUE(isPattern(folder_ / "a*.vdb"));
    EXPECT_FALSE(isPattern(folder_ / "a\\*.vdb"));
    EXPECT_FALSE(isPattern(folder_ / "a.vdb"));
    EXPECT_FALSE(isPattern(folder_ / "a.####.vdb"));
    EXPECT_FALSE(isPattern(folder_ / "a[1.vdb"));
}

// A folder that is there as it is written is meant, and no other.
TEST_F(FindFiles, TakesFoldersThatAreThereAsTheyAre) {
    for (const char* name : {"[old]/a.vdb", "[old]/b.vdb", "o/a.vdb", "s/[1]/a.vdb", "s/1/a.vdb",
                             "t/1/a.vdb", "a\\*b/c.vdb"})
        put(name);
    EXPECT_FALSE(isPattern(folder_ / "[old]/puff.####.vdb"));
    EXPECT_TRUE(isPattern(folder_ / "[new]/puff.####.vdb"));
    EXPECT_TRUE(isPattern(folder_ / "[old]/*.vdb"));
    EXPECT_EQ(find("[old]/*.vdb"), (Names{":[old]/a.vdb", ":[old]/b.vdb"}));
    EXPECT_EQ(find("\\[old\\]/*.vdb"), (Names{":[old]/a.vdb", ":[old]/b.vdb"}));
    EXPECT_EQ(find("[o]/*.vdb"), (Names{"o:o/a.vdb"}));
    EXPECT_EQ(find("*/[1]/*.vdb"), (Names{"s/[1]:s/[1]/a.vdb", "t/1:t/1/a.vdb"}));
    EXPECT_EQ(find("a\\*b/*"), (Names{":a\\*b/c.vdb"}));
}

}  // namespace
}  // namespace deltasplat
