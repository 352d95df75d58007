// SPDX-License-Identifier: Apache-2.0
#include "page/page_parts.h"

#include "page/page_style.h"
#include "text/utf8_text.h"

namespace deltasplat {

std::string pageBegin(const std::string& title, const std::string& style) {
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<title>" +
           title + "</title>\n<style>" + kPageStyle + style + "</style>\n</head>\n<body>\n";
}

std::string attributeText(const std::string& text) {
    std::string attribute;
    for (const char c : markupText(text)) {
        if (c == '"')
            attribute += "&quot;";
        else
            attribute += c;
    }
    return attribute;
}

std::string pictureFigure(const std::string& uri, const std::string& alternative,
                          const std::string& caption) {
    return "<figure><img src=\"" + uri + "\" alt=\"" + alternative + "\">\n<figcaption>" + caption +
           "</figcaption></figure>\n";
}

std::string tableRow(const std::string& tag, const std::vector<std::string>& cells) {
    std::string row = "<tr>";
    const std::string open = "<" + tag + ">";
    const std::string close = "</" + tag + ">";
    for (const std::string& cell : cells) row.append(open).append(cell).append(close);
    return row + "</tr>\n";
}

}  // namespace deltasplat
