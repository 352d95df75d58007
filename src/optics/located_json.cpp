// SPDX-License-Identifier: Apache-2.0
#include "optics/located_json.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "deltasplat/error.h"

namespace deltasplat {

std::string readSmallText(const std::filesystem::path& file, const std::string& expected) {
    constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
    const auto fail = [&](const std::string& got) {
        throw Error(ErrorCode::kInput, file.string(), got, expected);
    };
    std::error_code ignored;
    // Check the type first, because opening a pipe waits for its writer.
    const auto status = std::filesystem::status(file, ignored);
    if (!std::filesystem::exists(status)) fail("no such file");
    std::ifstream in;
    if (std::filesystem::is_regular_file(status)) in.open(file, std::ios::binary);
    if (!in.is_open()) fail("no file that can be read");
    // Most files fit into one part. Clearing 16 MiB would take longer than reading them.
    constexpr std::size_t kPart = std::size_t{64} << 10;
    std::string text;
    while (in && text.size() <= kMaxBytes) {
        const std::size_t begin = text.size();
        text.resize(begin + kPart);
        in.read(text.data() + begin, std::streamsize(kPart));
        text.resize(begin + std::size_t(in.gcount()));
    }
    if (in.bad()) fail("no file that can be read");
    if (text.size() > kMaxBytes) fail("more than 16 MiB");
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    return text;
}

namespace {

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxQuoted = 40;

using Json = nlohmann::json;

// Quotes foreign text in one printable line of bounded length.
std::string shortened(std::string text) {
    const bool cut = text.size() > kMaxQuoted;
    if (cut) text.resize(kMaxQuoted);
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return cut ? text + "..." : text;
}

[[noreturn]] void fail(const std::filesystem::path& file, int line, const std::string& got,
                       const std::string& expected) {
    throw Error(ErrorCode::kInput, file.string() + ":" + std::to_string(line), got, expected);
}

// Walks over text and notes its place for the handler, because the parser reports no lines.
struct TrackingIterator {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at;
    const char** place;

    reference operator*() const { return *at; }
    TrackingIterator& operator++() {
        *place = ++at;
        return *this;
    }
    bool operator==(const TrackingIterator& other) const { return at == other.at; }
    bool operator!=(const TrackingIterator& other) const { return at != other.at; }
};

// Builds the tree from the events of nlohmann-json's SAX interface.
class TreeBuilder {
  public:
    TreeBuilder(const std::filesystem::path& file, const std::string& text, const std::string& what)
        : place_(text.data()), file_(file), what_(what), counted_(text.data()) {}

    bool null() { return add(LocatedJson::Kind::kNull) != nullptr; }
    bool boolean(bool value) {
        add(LocatedJson::Kind::kBoolean)->flag = value;
        return true;
    }
    bool number_integer(Json::number_integer_t value) { return number(double(value)); }
    bool number_unsigned(Json::number_unsigned_t value) { return number(double(value)); }
    bool number_float(Json::number_float_t value, const std::string&) { return number(value); }
    bool string(std::string& value) {
        add(LocatedJson::Kind::kString)->text = std::move(value);
        return true;
    }
    bool binary(Json::binary_t&) { return false; }
    bool start_array(std::size_t) { return open(LocatedJson::Kind::kArray); }
    bool end_array() { return close(); }
    bool start_object(std::size_t) { return open(LocatedJson::Kind::kObject); }
    bool end_object() { return close(); }
    bool key(std::string& name) {
        key_ = std::move(name);
        return true;
    }
    bool parse_error(std::size_t, const std::string& token, const Json::exception& error) {
        constexpr int kNumberOverflow = 406;
        if (error.id == kNumberOverflow) fail(file_, line(), shortened(token), "a finite number");
        const bool atEnd =
            std::string_view(error.what()).find("unexpected end of input") != std::string::npos;
        fail(file_, line(), atEnd ? "the end of the file" : shortened(token), "valid JSON");
    }

    LocatedJson takeRoot() { return std::move(root_); }

    const char* place_;  // how far the parser has read

  private:
    bool number(double value) {
        LocatedJson& json = *add(LocatedJson::Kind::kNumber);
        json.number = value;
        json.text = numberText(value);
        return true;
    }

    LocatedJson* add(LocatedJson::Kind kind) {
        LocatedJson* slot = &root_;
        if (!open_.empty()) {
            auto& members = open_.back()->members;
            members.push_back({std::move(key_), LocatedJson()});
            slot = &members.back().value;
            key_.clear();
        }
        slot->kind = kind;
        slot->line = kind == LocatedJson::Kind::kNumber ? lineAt(place_ - 1) : line();
        return slot;
    }

    bool open(LocatedJson::Kind kind) {
        LocatedJson* container = add(kind);
        if (open_.size() == kMaxDepth) {
            fail(file_, container->line, "more than " + std::to_string(kMaxDepth) + " levels",
                 what_);
        }
        open_.push_back(container);
        return true;
    }

    bool close() {
        open_.pop_back();
        return true;
    }

    int line() { return lineAt(place_); }

    // The parser reads one character past a number, which may be the end of the line.
    int lineAt(const char* place) {
        if (place > counted_) {
            line_ += int(std::count(counted_, place, '\n'));
            counted_ = place;
        }
        return line_;
    }

    std::filesystem::path file_;
    std::string what_;
    const char* counted_;
    int line_ = 1;
    std::string key_;
    LocatedJson root_;
    std::vector<LocatedJson*> open_;  // stays valid: only the innermost one's members grow
};

}  // namespace

const LocatedJson* LocatedJson::find(std::string_view name) const {
    const auto at = std::find_if(members.rbegin(), members.rend(),
                                 [&](const auto& member) { return member.name == name; });
    return at == members.rend() ? nullptr : &at->value;
}

std::string LocatedJson::quoted() const {
    switch (kind) {
        case Kind::kNull:
            return "null";
        case Kind::kBoolean:
            return flag ? "true" : "false";
        case Kind::kNumber:
            return text;
        case Kind::kString:
            return '"' + shortened(text) + '"';
        case Kind::kArray:
            return "an array";
        case Kind::kObject:
            return "an object";
    }
    return "";
}

LocatedJson readLocatedJson(const std::filesystem::path& file, const std::string& what,
                            const std::string& longName) {
    const std::string text = readSmallText(file, longName);
    // The parser would take a 0 for the end.
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos) {
        const auto line = std::count(text.begin(), text.begin() + std::ptrdiff_t(zero), '\n');
        fail(file, 1 + int(line), "a byte that is 0", "valid JSON");
    }
    TreeBuilder builder(file, text, what);
    const char* const end = text.data() + text.size();
    Json::sax_parse(TrackingIterator{text.data(), &builder.place_},
                    TrackingIterator{end, &builder.place_}, &builder);
    return builder.takeRoot();
}

}  // namespace deltasplat
