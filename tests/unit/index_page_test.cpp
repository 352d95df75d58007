// SPDX-License-Identifier: Apache-2.0
#include "batch/index_page.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

Index twoPictures() {
    Index index;
    index.title = "s/*.vdb";
    index.seconds = 12.25;
    index.shape = {4, 3};
    index.entries.push_back(
        {"s/a.vdb", "f", "t/a.png", {"heat", {8, 9, 10}, glm::dvec2(0, 1.23456)}, 0.5, "jpeg", ""});
    index.entries.push_back({"s/b.vdb", "", "t/b.png", {"density", {4, 4, 4}, {}}, {}, "", ""});
    return index;
}

void expectHas(const std::string& page, const std::string& text) {
    EXPECT_NE(page.find(text), std::string::npos) << "no " << text << " in " << page;
}

TEST(IndexText, SaysWhatPicturesShow) {
    const std::string page = indexText(twoPictures(), "t/index.html");
    EXPECT_TRUE(page.starts_with("<!doctype html>\n"));
    EXPECT_TRUE(page.ends_with("</body>\n</html>\n"));
    expectHas(page, "<title>s/*.vdb</title>");
    expectHas(page, "2 pictures, 1 of them there before; 12.2 s");
    expectHas(page, "--shape:4/3");
    expectHas(page,
              "<a href=\"a.png\"><img src=\"data:image/jpeg;base64,anBlZw==\" "
              "alt=\"a.vdb, heat\"></a>");
    expectHas(page, "heat, 8×9×10<br>0 to 1.235, 0.50 s");
    expectHas(page, "<b>a.vdb</b>\n<div class=\"quiet\">f</div>");
    expectHas(page, "<span class=\"none\">no thumbnail</span>");
    expectHas(page, "density, 4×4×4<br>was there");
    EXPECT_EQ(page.find("id=\"failures\""), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos);
}

TEST(IndexText, SaysWhatFailed) {
    Index index = twoPictures();
    index.entries[0].failure = "got <nothing>; expected a volume";
    const std::string page = indexText(index, "t/index.html");
    expectHas(page,
              "1 picture, 1 of them there before, <span class=\"failed\"><a "
              "href=\"#failures\">1 failed</a></span>");
    expectHas(page, "<tr><td>s/a.vdb</td><td>got &lt;nothing&gt;; expected a volume</td></tr>");
    EXPECT_EQ(page.find("<b>a.vdb</b>"), std::string::npos);
}

TEST(IndexText, LinksFromWhereItIs) {
    expectHas(indexText(twoPictures(), "index.html"), "href=\"t/a.png\"");
    expectHas(indexText(twoPictures(), "page/index.html"), "href=\"../t/a.png\"");
}

// Who reads a link takes `..` off the names, wherever they lead.
TEST(IndexText, LinksByNamesOfFolders) {
    namespace fs = std::filesystem;
    const test::TempFolder folder;
    fs::create_directories(folder / "far/away/pages");
    fs::create_directories(folder / "t");
    fs::create_directory_symlink("far/away/pages", folder / "p");
    Index index = twoPictures();
    const auto linkTo = [&](const char* picture, const char* page) {
        index.entries[0].picture = folder / picture;
        const std::string html = indexText(index, folder / page);
        const std::size_t begin = html.find("<a href=\"") + 9;
        return html.substr(begin, html.find('"', begin) - begin);
    };
    EXPECT_EQ(linkTo("t/a.png", "p/index.html"), "../t/a.png");
    EXPECT_EQ(linkTo("p/a.png", "p/index.html"), "a.png");
    EXPECT_EQ(linkTo("p/a.png", "index.html"), "p/a.png");
    EXPECT_EQ(linkTo("t/../t/./a.png", "p/index.html"), "../t/a.png");
    EXPECT_EQ(linkTo("p/../a.png", "index.html"), "far/away/a.png");
}

TEST(IndexText, SpellsOutWhatIsNoPlainCharacter) {
    Index index;
    index.title = "<*>&";
    const std::string name = "a\"b<c>\n\xff#?.vdb";
    index.entries.push_back({name, "", "t/" + name + ".png", {"\"g\"", {}, {}}, 1.0, "jpeg", ""});
    const std::string page = indexText(index, "t/index.html");
    expectHas(page, "<h1>&lt;*&gt;&amp;</h1>");
    expectHas(page, "<b>a\"b&lt;c&gt;??#?.vdb</b>");
    expectHas(page, "alt=\"a&quot;b&lt;c&gt;??#?.vdb, &quot;g&quot;\"");
    expectHas(page, "href=\"a%22b%3Cc%3E%0A%FF%23%3F.vdb.png\"");
}

}  // namespace
}  // namespace deltasplat
