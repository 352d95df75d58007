// SPDX-License-Identifier: Apache-2.0
// Follows the text format in "USD Crate and text file formats" and files written by usdcat.
// Unneeded parts are skipped by their brackets.
#include "formats/usd/usd_layer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "optics/located_json.h"

namespace deltasplat {
namespace {

using Kind = UsdValue::Kind;

constexpr int kMostLevels = 64;
constexpr std::size_t kMostQuoted = 40;

bool isWordStart(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' ||
           static_cast<unsigned char>(c) >= 0x80;
}

bool isWordPart(char c) {
    return isWordStart(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 || c == ':';
}

std::string printable(std::string_view text) {
    std::string result(text.substr(0, kMostQuoted));
    std::replace_if(
        result.begin(), result.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return text.size() > kMostQuoted ? result + "..." : result;
}

class UsdParser {
  public:
    UsdParser(const std::filesystem::path& file, const std::string& text)
        : file_(file), text_(text) {}

    UsdPrim parse() {
        constexpr std::string_view kMagic = "#usda ";
        if (text_.compare(0, kMagic.size(), kMagic) != 0)
            fail(text_.substr(0, std::min(text_.find('\n'), kMostQuoted)), "#usda 1.0, USD's text");
        UsdPrim root;
        if (peek() == '(') parseMetadata(root);
        while (peek() != 0) parseStatement(root, 0);
        requireKept();
        return root;
    }

  private:
    [[noreturn]] void failAt(int line, const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, file_.string() + ":" + std::to_string(line), got, expected);
    }

    [[noreturn]] void fail(const std::string& got, const std::string& expected) const {
        failAt(line_, got.empty() ? "nothing" : printable(got), expected);
    }

    // Refuses the text at the current place, quoting its start.
    [[noreturn]] void failHere(const std::string& expected) {
        if (peek() == 0) fail("the end of the file", expected);
        std::size_t end = at_ + 1;
        while (end < text_.size() && end - at_ < kMostQuoted && isWordPart(text_[end])) ++end;
        fail(text_.substr(at_, end - at_), expected);
    }

    char raw() const { return at_ < text_.size() ? text_[at_] : 0; }
    void advance() {
        if (text_[at_++] == '\n') ++line_;
    }
    bool startsWith(std::string_view what) const {
        return text_.compare(at_, what.size(), what) == 0;
    }

    // Returns the next significant character; 0 at the end.
    char peek() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '#' || startsWith("//")) {
                while (at_ < text_.size() && text_[at_] != '\n') ++at_;
            } else if (startsWith("/*")) {
                while (at_ < text_.size() && !startsWith("*/")) advance();
                at_ = std::min(at_ + 2, text_.size());
            } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ';') {
                advance();
            } else {
                if (c == 0) fail("a byte of value 0", "text");
                return c;
            }
        }
        return 0;
    }

    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }

    void expect(char c, const std::string& where) {
        if (!take(c)) failHere(std::string(1, c) + " " + where);
    }

    std::string word(const std::string& expected) {
        if (!isWordStart(peek())) failHere(expected);
        const std::size_t begin = at_;
        while (at_ < text_.size() && isWordPart(text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }

    // Reads a type such as float3 or token[].
    std::string typeName() {
        std::string name = word("a type, def, over, class or }");
        if (raw() == '[') {
            ++at_;
            expect(']', "of a type");
            name += "[]";
        }
        return name;
    }

    std::string quoted() {
        const char quote = peek();
        const int begun = line_;
        const std::string three(3, quote);
        const bool isLong = startsWith(three);
        at_ += isLong ? 3 : 1;
        std::string result;
        while (!(isLong ? startsWith(three) : raw() == quote)) {
            if (at_ >= text_.size() || (!isLong && raw() == '\n'))
                failAt(begun, "a text without an end", std::string(1, quote));
            if (raw() == '\\' && at_ + 1 < text_.size()) advance();
            result += raw();
            advance();
        }
        at_ += isLong ? 3 : 1;
        return result;
    }

    std::string bracketed(std::string_view open, std::string_view close) {
        at_ += open.size();
        const std::size_t end = text_.find(close, at_);
        const bool isEnded = end != std::string::npos;
        std::string result = text_.substr(at_, isEnded ? end - at_ : 0);
        if (!isEnded || result.find('\n') != std::string::npos)
            fail(std::string(open) + " without an end", std::string(close));
        at_ = end + close.size();
        return result;
    }

    std::string asset() {
        const bool isLong = startsWith("@@@");
        return bracketed(isLong ? "@@@" : "@", isLong ? "@@@" : "@");
    }

    double number() {
        const bool isSigned = peek() == '-' || peek() == '+';
        const bool isNegative = peek() == '-';
        if (isSigned) ++at_;
        for (const auto& [name, value] :
             {std::pair("inf", std::numeric_limits<double>::infinity()),
              std::pair("nan", std::numeric_limits<double>::quiet_NaN())}) {
            if (!startsWith(name)) continue;
            at_ += 3;
            return isNegative ? -value : value;
        }
        double value = 0;
        const char* const begin = text_.data() + at_;
        const auto [stop, problem] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (problem == std::errc::invalid_argument) failHere("a number");
        if (problem == std::errc::result_out_of_range)
            value = std::numeric_limits<double>::infinity();
        at_ += std::size_t(stop - begin);
        return isNegative ? -value : value;
    }

    void skipGroup() {
        const int begun = line_;
        std::string open;
        do {
            const char c = peek();
            if (c == 0) failAt(begun, "a bracket without an end", "its end");
            if (c == '(' || c == '[' || c == '{') {
                open += c == '(' ? ')' : c == '[' ? ']' : '}';
                ++at_;
            } else if (c == ')' || c == ']' || c == '}') {
                if (c != open.back()) failHere(open.substr(open.size() - 1));
                open.pop_back();
                ++at_;
            } else if (c == '"' || c == '\'') {
                quoted();
            } else if (c == '@') {
                asset();
            } else {
                ++at_;
            }
        } while (!open.empty());
    }

    UsdValue value(bool keepsItems, int level) {
        UsdValue result;
        const char c = peek();
        result.line = line_;
        if (c == '(' || c == '[') {
            if (!keepsItems && c == '[') {
                skipGroup();
                result.kind = Kind::kSkipped;
            } else {
                items(c == '(' ? ')' : ']', keepsItems, level, result);
            }
        } else if (c == '{') {
            skipGroup();
            result.kind = Kind::kSkipped;
        } else if (c == '"' || c == '\'') {
            result.kind = Kind::kText;
            result.text = quoted();
        } else if (c == '@') {
            result.kind = Kind::kAsset;
            result.text = asset();
        } else if (c == '<') {
            result.kind = Kind::kPath;
            result.text = bracketed("<", ">");
        } else if (isWordStart(c) && !startsWith("inf") && !startsWith("nan")) {
            result.text = word("a value");
            result.kind = result.text == "None" ? Kind::kNone : Kind::kWord;
        } else {
            result.kind = Kind::kNumber;
            result.number = number();
        }
        return result;
    }

    void items(char close, bool keepsItems, int level, UsdValue& list) {
        if (level > kMostLevels) fail("more than 64 levels", "fewer");
        ++at_;
        list.kind = Kind::kItems;
        while (!take(close)) {
            UsdValue item = value(keepsItems, level + 1);
            if (list.items.size() < kMostUsdItems) list.items.push_back(std::move(item));
            keep(sizeof(UsdValue));
            if (!take(',') && peek() != close) failHere(std::string(1, close));
        }
    }

    // (a = 1 b = "x" prepend references = @file@</Prim>)
    void parseMetadata(UsdPrim& prim) {
        constexpr std::array kComposed{"references",  "payload",   "inherits",
                                       "specializes", "subLayers", "variantSets"};
        expect('(', "of metadata");
        while (!take(')')) {
            const char c = peek();
            if (c == '"' || c == '\'') {
                quoted();
                continue;
            }
            std::string name = word("metadata or )");
            if (isListEdit(name)) name = word("what is edited");
            if (!take('=')) continue;
            const UsdValue found = value(false, 0);
            if (peek() == '<') bracketed("<", ">");
            if (found.kind == Kind::kAsset && peek() == '(') skipGroup();
            if (std::find(kComposed.begin(), kComposed.end(), name) != kComposed.end())
                prim.composed.push_back(name);
            prim.metadata[name] = found;
        }
    }

    static bool isListEdit(const std::string& name) {
        return name == "prepend" || name == "append" || name == "delete" || name == "add" ||
               name == "reorder";
    }

    void skipMetadata() {
        if (peek() == '(') skipGroup();
    }

    void parseStatement(UsdPrim& parent, int level) {
        if (level > kMostLevels) fail("more than 64 levels", "fewer");
        std::string first = typeName();
        if (first == "def" || first == "over" || first == "class")
            return parsePrim(parent, first != "def", level);
        if (first == "variantSet") {
            parent.composed.push_back("variantSets");
            quoted();
            expect('=', "of a variantSet");
            skipGroup();
            return;
        }
        const bool isEdit = isListEdit(first);
        if (isEdit) first = typeName();
        while (first == "custom" || first == "uniform" || first == "varying" || first == "config")
            first = typeName();
        if (isEdit && (first == "nameChildren" || first == "properties" || first == "rootPrims")) {
            expect('=', "of an order");
            value(false, 0);
            return;
        }
        if (level == 0) fail(first, "def, over or class");
        parseProperty(parent, first);
    }

    void parsePrim(UsdPrim& parent, bool isClass, int level) {
        UsdPrim prim;
        prim.isClass = isClass;
        prim.line = line_;
        if (peek() != '"') prim.type = word("a prim's type or name");
        if (peek() != '"') failHere("a prim's name");
        prim.name = quoted();
        if (peek() == '(') parseMetadata(prim);
        expect('{', "of a prim");
        while (!take('}')) parseStatement(prim, level + 1);
        for (UsdProperty& property : prim.properties) sortSamples(property);
        keep(sizeof(UsdPrim) + prim.name.size());
        parent.children.add(std::move(prim));
    }

    static void sortSamples(UsdProperty& property) {
        std::stable_sort(property.samples.begin(), property.samples.end(),
                         [](const auto& a, const auto& b) { return a.time < b.time; });
        property.times.reserve(property.samples.size());
        for (const UsdSample& sample : property.samples) property.times.push_back(sample.time);
    }

    // Counts the layer's memory beyond the file's text, and requests it in steps.
    void keep(std::size_t bytes) {
        constexpr std::size_t kStep = std::size_t{4} << 20;
        kept_ += bytes;
        if (kept_ >= kStep) requireKept();
    }
    void requireKept() {
        // Vectors grow to twice their content.
        requireMemory(file_.string(), 2 * double(std::exchange(kept_, 0)));
    }

    void parseProperty(UsdPrim& prim, const std::string& type) {
        const int line = (peek(), line_);
        const std::string name = word("a property's name");
        std::string part;
        if (raw() == '.') {
            ++at_;
            part = word("timeSamples or connect");
        }
        const bool keeps = type == "token[]" || type == "rel";
        if (take('=')) {
            UsdProperty& property = propertyOf(prim, name, line);
            if (part == "timeSamples") {
                parseSamples(property, keeps || !type.ends_with("[]"));
            } else if (part == "connect") {
                value(false, 0);
                prim.composed.push_back("connections");
            } else {
                property.value = value(keeps, 0);
            }
        }
        skipMetadata();
    }

    UsdProperty& propertyOf(UsdPrim& prim, const std::string& name, int line) {
        if (UsdProperty* const known = prim.properties.find(name)) return *known;
        constexpr std::size_t kPlaceBytes = 96;
        keep(sizeof(UsdProperty) + kPlaceBytes + 2 * name.size());
        return prim.properties.add({name, line, {}, {}, {}});
    }

    void parseSamples(UsdProperty& property, bool keeps) {
        expect('{', "of timeSamples");
        while (!take('}')) {
            UsdSample sample;
            sample.time = number();
            if (!std::isfinite(sample.time)) fail(numberText(sample.time), "a finite time");
            expect(':', "behind a time");
            sample.value = value(false, 0);
            if (keeps) property.samples.push_back(std::move(sample));
            keep(keeps ? sizeof(UsdSample) + sizeof(double) : 0);
            if (!take(',') && peek() != '}') failHere("}");
        }
    }

    const std::filesystem::path& file_;
    const std::string& text_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::size_t kept_ = 0;
};

}  // namespace

std::string UsdValue::quoted() const {
    switch (kind) {
        case Kind::kNone:
            return "None";
        case Kind::kNumber:
            return numberText(number);
        case Kind::kText:
            return '"' + printable(text) + '"';
        case Kind::kWord:
            return printable(text);
        case Kind::kAsset:
            return "@" + printable(text) + "@";
        case Kind::kPath:
            return "<" + printable(text) + ">";
        case Kind::kItems:
            return countText(items.size(), "value");
        case Kind::kSkipped:
            return "a list";
    }
    return "";
}

UsdLayer readUsdLayer(const std::filesystem::path& file) {
    const std::string text = readSmallText(file, "USD's text format (.usda)");
    return {file, UsdParser(file, text).parse()};
}

}  // namespace deltasplat
