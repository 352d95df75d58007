// SPDX-License-Identifier: Apache-2.0
// A plain sans-serif font drawn with a pen of one width: the program's pictures need no font file,
// and look the same on every machine.
#include "drawing/stroke_font.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string_view>
#include <utility>

#include "text/utf8_text.h"

namespace deltasplat {
namespace {

// Strokes of the characters from '!' to '~', separated by ";". A point is "x,y": y goes up from the
// base line, capitals are 14 high, small letters 10. A point in brackets bends the line towards it
// (quadratic Bezier; between two of them the line passes through their middle).
constexpr const char* kGlyphs[] = {
    /* ! */ "0,14 0,4.5; 0,0",
    /* " */ "0,14 0,10; 3,14 3,10",
    /* # */ "1,0 3.5,14; 6,0 8.5,14; 0,4.5 9,4.5; 0.7,9.5 9.7,9.5",
    /* $ */
    ("9,11.3 (8,14) (4.8,14) (0.4,14) (0.4,10.6) (0.4,8.2) 4.8,7.3 (9.4,6.3) (9.4,3.6) "
     "(9.4,0) (4.7,0) (1,0) 0,2.9; 4.7,16 4.7,-2"),
    /* % */
    ("2.2,14 (0,14) (0,8) (4.4,8) (4.4,14) 2.2,14; 9.8,6 (7.6,6) (7.6,0) (12,0) (12,6) "
     "9.8,6; 10,14 2,0"),
    /* & */
    ("10.5,0 2.6,9.2 (1.2,11) (2,14) (4.3,14) (7,14) (7,11) (7,8.8) 3.4,7 (0,5.4) (0,3) "
     "(0,0) (3.8,0) (8.5,0) 9.6,6"),
    /* ' */ "0,14 0,10",
    /* ( */ "3,15 (0,11.5) (0,-0.5) 3,-3",
    /* ) */ "0,15 (3,11.5) (3,-0.5) 0,-3",
    /* * */ "3.5,14 3.5,7; 0.5,12.3 6.5,8.8; 6.5,12.3 0.5,8.8",
    /* + */ "4.5,11 4.5,2; 0,6.5 9,6.5",
    /* , */ "0.8,0.3 0,-2.7",
    /* - */ "0,5.2 5,5.2",
    /* . */ "0,0",
    /* / */ "0,-2 6,15",
    /* 0 */ "4.5,14 (0,14) (0,0) (9,0) (9,14) 4.5,14",
    /* 1 */ "1.5,11.5 5,14 5,0",
    /* 2 */ "0.3,10.5 (0.6,14) (4.5,14) (8.6,14) (8.6,10.4) (8.6,8) 5.5,5 0,0 9,0",
    /* 3 */
    ("0.5,11.5 (1.5,14) (4.4,14) (8.3,14) (8.3,10.8) (8.3,7.5) 4.5,7.5 3.2,7.5; "
     "4.5,7.5 (8.9,7.5) (8.9,3.8) (8.9,0) (4.4,0) (1,0) 0.2,2.9"),
    /* 4 */ "6.8,0 6.8,14 0,4 9,4",
    /* 5 */
    ("8.2,14 1.5,14 0.8,7.6 (2.2,8.9) (4.5,8.9) (8.9,8.9) (8.9,4.5) (8.9,0) (4.3,0) "
     "(1.2,0) 0.2,2.6"),
    /* 6 */ "8,11.8 (7,14) (4.8,14) (0.2,14) 0.2,6 0.2,4.5 (0.2,9) (8.9,9) (8.9,0) (0.2,0) 0.2,4.5",
    /* 7 */ "0,14 9,14 (5,8) 3.3,0",
    /* 8 */
    ("4.5,7.5 (0.6,7.5) (0.6,14) (8.4,14) (8.4,7.5) 4.5,7.5 (0,7.5) (0,0) (9,0) (9,7.5) "
     "4.5,7.5"),
    /* 9 */
    ("1.1,2.2 (2.1,0) (4.3,0) (8.9,0) 8.9,8 8.9,9.5 (8.9,5) (0.2,5) (0.2,14) (8.9,14) "
     "8.9,9.5"),
    /* : */ "0,8.5; 0,0",
    /* ; */ "0.8,8.5; 0.8,0.3 0,-2.7",
    /* < */ "8,11 0,6.5 8,2",
    /* = */ "0,8.5 9,8.5; 0,4.5 9,4.5",
    /* > */ "0,11 8,6.5 0,2",
    /* ? */ "0,11 (0.5,14) (3.7,14) (7.4,14) (7.4,10.8) (7.4,8.5) 3.7,6.8 3.7,4.5; 3.7,0",
    /* @ */
    ("9,8.5 (8,10) (6.5,10) (3.5,10) (3.5,6.5) (3.5,3) (6.3,3) (9,3) 9,6.5; 9,10 9,5 (9,3) "
     "(10.8,3) (13,3) (13,7) (13,14) (7,14) (0,14) (0,6.5) (0,-1.5) (7,-1.5) (9.5,-1.5) "
     "11,-0.3"),
    /* A */ "0,0 5,14 10,0; 1.8,5 8.2,5",
    /* B */ "0,0 0,14 5,14 (9,14) (9,7.5) 5,7.5 0,7.5; 5,7.5 (10,7.5) (10,0) 5,0 0,0",
    /* C */ "10,11 (8.7,14) (5.5,14) (0,14) (0,0) (5.5,0) (8.7,0) 10,3",
    /* D */ "0,0 0,14 4,14 (10,14) (10,0) 4,0 0,0",
    /* E */ "9,0 0,0 0,14 9,14; 0,7.5 7.5,7.5",
    /* F */ "0,0 0,14 9,14; 0,7.5 7.5,7.5",
    /* G */ "10,11 (8.7,14) (5.5,14) (0,14) (0,0) (5.5,0) (8.5,0) 10.3,2 10.3,7 6,7",
    /* H */ "0,0 0,14; 10,0 10,14; 0,7.5 10,7.5",
    /* I */ "0,0 0,14",
    /* J */ "6,14 6,4 (6,0) (3,0) (0,0) 0,3.5",
    /* K */ "0,0 0,14; 9,14 0,5; 3.3,8.3 9.5,0",
    /* L */ "0,14 0,0 8,0",
    /* M */ "0,0 0,14 6,3 12,14 12,0",
    /* N */ "0,0 0,14 10,0 10,14",
    /* O */ "5.5,14 (0,14) (0,0) (11,0) (11,14) 5.5,14",
    /* P */ "0,0 0,14 5,14 (9.5,14) (9.5,6.5) 5,6.5 0,6.5",
    /* Q */ "5.5,14 (0,14) (0,0) (11,0) (11,14) 5.5,14; 6.5,3.5 11,-1",
    /* R */ "0,0 0,14 5,14 (9.5,14) (9.5,6.5) 5,6.5 0,6.5; 5,6.5 9.5,0",
    /* S */
    ("9,11.3 (8,14) (4.8,14) (0.4,14) (0.4,10.6) (0.4,8.2) 4.8,7.3 (9.4,6.3) (9.4,3.6) "
     "(9.4,0) (4.7,0) (1,0) 0,2.9"),
    /* T */ "0,14 10,14; 5,14 5,0",
    /* U */ "0,14 0,5 (0,0) (5,0) (10,0) 10,5 10,14",
    /* V */ "0,14 5,0 10,14",
    /* W */ "0,14 3.5,0 7,14 10.5,0 14,14",
    /* X */ "0,14 10,0; 10,14 0,0",
    /* Y */ "0,14 5,7 10,14; 5,7 5,0",
    /* Z */ "0,14 9.5,14 0,0 9.5,0",
    /* [ */ "3,15 0,15 0,-3 3,-3",
    /* \ */ "0,15 6,-2",
    /* ] */ "0,15 3,15 3,-3 0,-3",
    /* ^ */ "0,8.5 4,14 8,8.5",
    /* _ */ "0,-2 8.5,-2",
    /* ` */ "0,14 2,11.5",
    /* a */
    ("0.8,8 (1.7,10) (4.2,10) (8,10) 8,6.4 8,0; 8,5.8 4.5,5.8 (0,5.8) (0,2.8) (0,0) "
     "(3.3,0) (6.5,0) 8,2.8"),
    /* b */ "0,14 0,0; 0,5 (0,10) (8.6,10) (8.6,0) (0,0) 0,5",
    /* c */ "8,8 (7,10) (4.5,10) (0,10) (0,0) (4.5,0) (7,0) 8,2",
    /* d */ "8.6,14 8.6,0; 8.6,5 (8.6,10) (0,10) (0,0) (8.6,0) 8.6,5",
    /* e */ "0,5.2 8.6,5.2 (8.6,10) (0,10) (0,0) (4.6,0) (7,0) 8.2,2",
    /* f */ "4.8,13.9 (4.4,14) (4,14) (2,14) 2,11 2,0; 0,10 4.6,10",
    /* g */
    ("8.6,10 8.6,-0.5 (8.6,-4) (4.3,-4) (1.8,-4) 0.8,-2.5; 8.6,5 (8.6,10) (0,10) (0,0) "
     "(8.6,0) 8.6,5"),
    /* h */ "0,14 0,0; 0,6 (0,10) (4,10) (7.8,10) 7.8,6 7.8,0",
    /* i */ "0,10 0,0; 0,13.6",
    /* j */ "1.5,10 1.5,-1.5 (1.5,-4) 0,-4; 1.5,13.6",
    /* k */ "0,14 0,0; 7,10 0,3.6; 2.7,6.1 7.5,0",
    /* l */ "0,14 0,0",
    /* m */
    ("0,10 0,0; 0,6 (0,10) (3.3,10) (6.3,10) 6.3,6.3 6.3,0; 6.3,6 (6.3,10) (9.6,10) "
     "(12.6,10) 12.6,6.3 12.6,0"),
    /* n */ "0,10 0,0; 0,6 (0,10) (4,10) (7.8,10) 7.8,6 7.8,0",
    /* o */ "4.5,10 (0,10) (0,0) (9,0) (9,10) 4.5,10",
    /* p */ "0,10 0,-4; 0,5 (0,10) (8.6,10) (8.6,0) (0,0) 0,5",
    /* q */ "8.6,10 8.6,-4; 8.6,5 (8.6,10) (0,10) (0,0) (8.6,0) 8.6,5",
    /* r */ "0,10 0,0; 0,6 (0,10) 4.4,10",
    /* s */
    ("7,8.2 (6.3,10) (3.6,10) (0.4,10) (0.4,7.6) (0.4,5.8) 3.7,5.2 (7.3,4.5) (7.3,2.6) "
     "(7.3,0) (3.7,0) (0.7,0) 0,2"),
    /* t */ "2,13 2,3 (2,0) (4,0) 4.8,0.1; 0,10 4.6,10",
    /* u */ "0,10 0,4 (0,0) (3.8,0) (7.8,0) 7.8,4; 7.8,10 7.8,0",
    /* v */ "0,10 4,0 8,10",
    /* w */ "0,10 3,0 6,10 9,0 12,10",
    /* x */ "0,10 7.6,0; 7.6,10 0,0",
    /* y */ "0,10 4,0; 8,10 3.2,-2 (2.4,-4) 0.5,-4",
    /* z */ "0,10 7,10 0,0 7,0",
    /* { */ "3.5,15 (1.5,15) 1.5,12.5 1.5,8.5 (1.5,6) 0,6 (1.5,6) 1.5,3.5 1.5,-0.5 (1.5,-3) 3.5,-3",
    /* | */ "0,15 0,-3",
    /* } */ "0,15 (2,15) 2,12.5 2,8.5 (2,6) 3.5,6 (2,6) 2,3.5 2,-0.5 (2,-3) 0,-3",
    /* ~ */ "0,5.5 (2,8.5) 4.5,6.5 (7,4.5) 9,7.5",
};
static_assert(std::size(kGlyphs) == '~' - '!' + 1);

// Signs and letters beyond ASCII.
struct Sign {
    char32_t point;
    const char* strokes;
};
constexpr Sign kSigns[] = {
    {U'\u00B0', "2.2,14 (0,14) (0,9.6) (4.4,9.6) (4.4,14) 2.2,14"},
    {U'\u00B1', "4.5,12 4.5,4; 0,8 9,8; 0,1 9,1"},
    {U'\u00B2', "0.2,12.4 (0.4,14.5) (2.4,14.5) (4.6,14.5) (4.6,12.3) (4.6,11) 2.9,9.6 0,7 4.8,7"},
    {U'\u00B3',
     ("0.3,13.2 (0.8,14.5) (2.3,14.5) (4.3,14.5) (4.3,12.8) (4.3,11) 2.3,11 1.6,11; 2.3,11 "
      "(4.7,11) (4.7,9) (4.7,7) (2.3,7) (0.6,7) 0,8.5")},
    {U'\u00B5', "0,10 0,-4; 0,4 (0,0) (3.8,0) (7.8,0) 7.8,4; 7.8,10 7.8,0"},
    {U'\u03BC', "0,10 0,-4; 0,4 (0,0) (3.8,0) (7.8,0) 7.8,4; 7.8,10 7.8,0"},
    {U'\u00D7', "1,10 8,3; 8,10 1,3"},
    {U'\u00DF',
     ("0,0 0,10 (0,14) (3.8,14) (7.4,14) (7.4,11) (7.4,8.4) 4.2,7.6 (8.6,7) (8.6,3.6) (8.6,0) "
      "(4.8,0) (3.6,0) 2.8,0.6")},
    {U'\u2013', "0,5.2 8.5,5.2"},
};

// Letters with a mark above, whose strokes begin in the letter's middle, over a small one.
struct MarkedLetters {
    const char* strokes;
    std::u32string_view letters;
    std::string_view plain;  // the letters without the mark
};
constexpr MarkedLetters kMarked[] = {
    {"-2,13.6; 2,13.6", U"\u00C4\u00CB\u00D6\u00DC\u00E4\u00EB\u00F6\u00FC", "AEOUaeou"},
    {"-1,12.4 1.4,14.4", U"\u00C1\u00C9\u00D3\u00DA\u00E1\u00E9\u00F3\u00FA", "AEOUaeou"},
    {"1,12.4 -1.4,14.4", U"\u00C0\u00C8\u00D2\u00D9\u00E0\u00E8\u00F2\u00F9", "AEOUaeou"},
    {"-2.2,12.4 0,14.4 2.2,12.4", U"\u00C2\u00CA\u00D4\u00DB\u00E2\u00EA\u00F4\u00FB", "AEOUaeou"},
    {"-2.4,12.8 (-1.2,14.4) 0,13.4 (1.2,12.4) 2.4,14", U"\u00D1\u00F1", "Nn"},
};
constexpr double kCapitalsAbove = 2.6;  // what marks of capitals are higher

constexpr const char* kBox = "0,0 0,14 8,14 8,0 0,0";

constexpr glm::dvec2 kUnit{0.048, 0.0515};  // of a glyph's grid, at size 1
constexpr double kGap = 3.4;
constexpr double kSpace = 5;
constexpr double kDigitWidth = 9;  // one for all, so that numbers stand below each other

using Stroke = std::vector<glm::dvec2>;

struct PenPoint {
    glm::dvec2 at{0.0};
    bool bends = false;
};

struct Glyph {
    std::vector<Stroke> strokes;  // in the grid's units
    double width = 0;
};

// Replaces the quadratic curve from the stroke's end to `to` by short lines.
void addCurve(Stroke& stroke, glm::dvec2 bend, glm::dvec2 to) {
    constexpr int kPieces = 8;
    const glm::dvec2 from = stroke.back();
    for (int i = 1; i <= kPieces; ++i) {
        const double t = double(i) / kPieces;
        stroke.push_back((1 - t) * (1 - t) * from + 2 * t * (1 - t) * bend + t * t * to);
    }
}

Stroke flattened(const std::vector<PenPoint>& points) {
    Stroke stroke{points.front().at};
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (!points[i].bends) {
            stroke.push_back(points[i].at);
            continue;
        }
        const PenPoint& next = points[i + 1];
        addCurve(stroke, points[i].at, next.bends ? 0.5 * (points[i].at + next.at) : next.at);
        if (!next.bends) ++i;
    }
    return stroke;
}

// Takes "x,y" or "(x,y)" from the front of the text.
PenPoint takePoint(std::string_view& text) {
    PenPoint point;
    point.bends = text.front() == '(';
    if (point.bends) text.remove_prefix(1);
    for (double* const number : {&point.at.x, &point.at.y}) {
        const char* const end = text.data() + text.size();
        const char* const rest = std::from_chars(text.data(), end, *number).ptr;
        text.remove_prefix(std::size_t(rest - text.data()));
        if (number == &point.at.x || point.bends) text.remove_prefix(1);  // comma or bracket
    }
    return point;
}

Glyph parsed(std::string_view text) {
    Glyph glyph;
    std::vector<PenPoint> points;
    const auto endStroke = [&] {
        glyph.strokes.push_back(flattened(points));
        for (const glm::dvec2& p : glyph.strokes.back()) glyph.width = std::max(glyph.width, p.x);
        points.clear();
    };
    while (!text.empty()) {
        if (text.front() == ' ' || text.front() == ';') {
            if (text.front() == ';') endStroke();
            text.remove_prefix(1);
            continue;
        }
        points.push_back(takePoint(text));
    }
    endStroke();
    return glyph;
}

Glyph withMark(char letter, const char* strokes) {
    Glyph glyph = parsed(kGlyphs[letter - '!']);
    const glm::dvec2 from(0.5 * glyph.width, letter < 'a' ? kCapitalsAbove : 0);
    for (Stroke& stroke : parsed(strokes).strokes) {
        for (glm::dvec2& p : stroke) p += from;
        glyph.strokes.push_back(std::move(stroke));
    }
    return glyph;
}

Glyph beyondAscii(char32_t point) {
    for (const Sign& sign : kSigns) {
        if (sign.point == point) return parsed(sign.strokes);
    }
    for (const MarkedLetters& marked : kMarked) {
        const std::size_t at = marked.letters.find(point);
        if (at != std::u32string_view::npos) return withMark(marked.plain[at], marked.strokes);
    }
    return parsed(kBox);
}

Glyph glyphOf(char32_t point) {
    if (point == U' ') return {{}, kSpace - kGap};
    if (point < U'!' || point > U'~') return beyondAscii(point);
    Glyph glyph = parsed(kGlyphs[point - U'!']);
    if (point >= U'0' && point <= U'9') glyph.width = kDigitWidth;
    return glyph;
}

}  // namespace

TextStrokes strokesOf(std::string_view text) {
    TextStrokes result;
    for (const char32_t point : codePoints(text)) {
        const Glyph glyph = glyphOf(point);
        const double start = result.width + 0.5 * kGap;
        for (const Stroke& stroke : glyph.strokes) {
            Stroke& placed = result.strokes.emplace_back();
            for (const glm::dvec2& p : stroke) {
                placed.push_back(kUnit * glm::dvec2(start + p.x, -p.y));
            }
        }
        result.width += glyph.width + kGap;
    }
    result.width *= kUnit.x;
    return result;
}

std::string fittedText(const std::string& text, double width) {
    const std::u32string points = codePoints(text);
    std::string shorter = text;
    for (std::size_t kept = points.size(); kept > 4 && strokesOf(shorter).width > width;) {
        kept -= 2;
        shorter =
            utf8(points.substr(0, kept / 2) + U"..." + points.substr(points.size() - kept / 2));
    }
    return shorter;
}

}  // namespace deltasplat
