// SPDX-License-Identifier: Apache-2.0
#include "batch/index_page.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <system_error>

#include "batch/index_page_style.h"
#include "deltasplat/image/write_image.h"
#include "image/quantize.h"
#include "page/page_parts.h"
#include "page/picture_data.h"
#include "text/short_number.h"
#include "text/utf8_text.h"

namespace deltasplat {
namespace {

// Values are told to three digits.
constexpr double kValueShare = 5e-4;

// A path as it stands in a link: what is no plain character is spelt in hexadecimal.
std::string linkText(const std::filesystem::path& path) {
    std::string link;
    for (const char c : path.generic_string()) {
        const auto byte = static_cast<unsigned char>(c);
        const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                             (c >= '0' && c <= '9') ||
                             std::string_view("-._~/").find(c) != std::string_view::npos;
        char spelt[4];
        std::snprintf(spelt, sizeof spelt, "%%%02X", unsigned(byte));
        if (isPlain)
            link += c;
        else
            link += spelt;
    }
    return link;
}

// Folders as their names say, which is how readers of links see them: what leads elsewhere stays a
// name, and counts only where `..` goes back from it.
std::filesystem::path named(const std::filesystem::path& path) {
    std::filesystem::path result;
    for (const std::filesystem::path& part : std::filesystem::absolute(path)) {
        std::error_code ignored;
        if (part == "..") {
            if (std::filesystem::is_symlink(result, ignored))
                result = std::filesystem::canonical(result, ignored);
            result = result.parent_path();
        } else if (part != ".") {
            result /= part;
        }
    }
    return result;
}

std::string secondsText(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, seconds < 10 ? "%.2f" : "%.1f", seconds);
    return std::string(text) + " s";
}

std::string factsText(const IndexEntry& entry) {
    const PictureFacts& facts = entry.facts;
    std::string text = markupText(facts.grid);
    if (facts.dims != glm::ivec3(0)) {
        text += std::string(text.empty() ? "" : ", ") + std::to_string(facts.dims.x) + "×" +
                std::to_string(facts.dims.y) + "×" + std::to_string(facts.dims.z);
    }
    if (facts.isEmpty) {
        text += std::string(text.empty() ? "" : "<br>") +
                "<span class=\"failed\">no active voxels</span>";
    } else if (facts.range) {
        text += "<br>" + shortNumberText(facts.range->x, kValueShare) + " to " +
                shortNumberText(facts.range->y, kValueShare);
    }
    return text + (facts.range || facts.isEmpty ? ", " : "<br>") +
           (entry.seconds ? secondsText(*entry.seconds) : "was there");
}

std::string figure(const IndexEntry& entry, const std::filesystem::path& from) {
    const std::string name = markupText(entry.input.filename().string());
    const std::string folder = markupText(entry.folder.string());
    const std::string link = linkText(named(entry.picture).lexically_relative(from));
    const std::string shown =
        entry.thumbnail.empty()
            ? "<span class=\"none\">no thumbnail</span>"
            : "<img src=\"data:image/jpeg;base64," + base64Text(entry.thumbnail) + "\" alt=\"" +
                  attributeText(entry.input.filename().string() +
                                (entry.facts.grid.empty() ? "" : ", " + entry.facts.grid)) +
                  "\">";
    return "<figure><a href=\"" + link + "\">" + shown + "</a>\n<figcaption><b>" + name + "</b>\n" +
           (folder.empty() ? "" : "<div class=\"quiet\">" + folder + "</div>\n") +
           "<div class=\"quiet\">" + factsText(entry) + "</div></figcaption></figure>\n";
}

bool hasFailed(const IndexEntry& entry) {
    return !entry.failure.empty();
}

std::string failures(const Index& index) {
    std::string rows;
    for (const IndexEntry& entry : index.entries) {
        if (!hasFailed(entry)) continue;
        rows += tableRow("td", {markupText(entry.input.string()), markupText(entry.failure)});
    }
    if (rows.empty()) return "";
    return "<section id=\"failures\">\n<h2>Failed</h2>\n<div class=\"scroll\"><table>\n<thead>" +
           tableRow("th", {"file", "what went wrong"}) + "</thead>\n<tbody>\n" + rows +
           "</tbody></table></div>\n</section>\n";
}

// "498 pictures, 3 of them empty, 2 failed; 34.2 s".
std::string summary(const Index& index) {
    const auto failed = std::count_if(index.entries.begin(), index.entries.end(), hasFailed);
    const auto shown = std::ptrdiff_t(index.entries.size()) - failed;
    const auto there =
        std::count_if(index.entries.begin(), index.entries.end(),
                      [](const IndexEntry& entry) { return !hasFailed(entry) && !entry.seconds; });
    std::string text = std::to_string(shown) + (shown == 1 ? " picture" : " pictures");
    const auto empty = std::count_if(
        index.entries.begin(), index.entries.end(),
        [](const IndexEntry& entry) { return !hasFailed(entry) && entry.facts.isEmpty; });
    if (empty > 0) text += ", " + std::to_string(empty) + " of them empty";
    if (there > 0) text += ", " + std::to_string(there) + " of them there before";
    if (failed > 0) {
        text += ", <span class=\"failed\"><a href=\"#failures\">" + std::to_string(failed) +
                " failed</a></span>";
    }
    return text + "; " + secondsText(index.seconds);
}

}  // namespace

std::string thumbnailOf(Image image) {
    if (image.rgba.empty()) return "";
    compositeOver(image, kPageDark);
    return encodeThumbnail(image);
}

std::string indexText(const Index& index, const std::filesystem::path& file) {
    std::string html = pageBegin(markupText(index.title), kIndexPageStyle) + "<header>\n<div><h1>" +
                       markupText(index.title) + "</h1>\n<p class=\"quiet\">" + summary(index) +
                       "</p></div>\n<input id=\"filter\" type=\"search\" placeholder=\"Filter\" "
                       "aria-label=\"Filter by name, folder or grid\" hidden>\n</header>\n<main "
                       "class=\"pictures\" style=\"--shape:" +
                       std::to_string(index.shape.x) + "/" + std::to_string(index.shape.y) +
                       "\">\n";
    for (const IndexEntry& entry : index.entries)
        if (!hasFailed(entry)) html += figure(entry, named(file).parent_path());
    return html + "</main>\n" + failures(index) + "<footer class=\"quiet\">\n<p><code>" +
           markupText(index.commandLine) + "</code></p>\n</footer>\n<script>" + kIndexPageScript +
           "</script>\n" + kPageEnd;
}

}  // namespace deltasplat
