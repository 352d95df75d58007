// SPDX-License-Identifier: Apache-2.0
#include "formats/delta/delta_format.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/text.h"
#include "deltasplat/error.h"
#include "volume/value_cast.h"

namespace deltasplat {

namespace {

constexpr const char* kVersionKey = "delta_version";
constexpr const char* kAxisNames[] = {"x", "y", "z"};

// Reads entries of the metadata and refuses invalid ones.
class Entries {
  public:
    Entries(const VdbMetadata& metadata, const std::string& where)
        : metadata_(metadata), where_(where) {}

    [[noreturn]] void fail(const std::string& key, const std::string& got,
                           const std::string& expected) const {
        throw Error(ErrorCode::kInput, where_ + ": metadata \"" + key + "\"", got, expected);
    }

    template <typename T>
    T get(const std::string& key, const std::string& expected) const {
        if (const auto found = metadata_.get<T>(key)) return *found;
        const VdbMetadata::Entry* const other = metadata_.find(key);
        fail(key, other ? "type " + printable(other->type) : "nothing", expected);
    }

    int whole(const std::string& key, int low, int high) const {
        const std::string expected =
            "an int32 within " + std::to_string(low) + ".." + std::to_string(high);
        const auto value = get<std::int32_t>(key, expected);
        if (value < low || value > high) fail(key, std::to_string(value), expected);
        return value;
    }

    double finite(const std::string& key) const {
        const auto value = get<double>(key, "a double");
        if (!std::isfinite(value)) fail(key, numberText(value), "a finite double");
        return value;
    }

    double notNegative(const std::string& key) const {
        const double value = finite(key);
        if (value < 0) fail(key, numberText(value), "a double of at least 0");
        return value;
    }

    /// Returns the index of the text in the list of words.
    int choice(const std::string& key, const std::vector<std::string>& words) const {
        std::string expected = "one of";
        for (const std::string& word : words) expected += " \"" + word + "\"";
        const auto text = get<std::string>(key, expected);
        const auto found = std::find(words.begin(), words.end(), text);
        if (found == words.end()) fail(key, "\"" + shortened(text) + "\"", expected);
        return int(found - words.begin());
    }

    template <typename Number>
    std::vector<Number> list(const std::string& key, std::size_t most) const {
        const std::string expected =
            "at most " + std::to_string(most) + " numbers with one space between";
        const auto text = get<std::string>(key, expected);
        const auto numbers = parseList<Number>(text);
        if (!numbers) fail(key, "\"" + shortened(text) + "\"", expected);
        if (numbers->size() > most) fail(key, std::to_string(numbers->size()), expected);
        return *numbers;
    }

    static std::string shortened(const std::string& text) {
        return printable(text.size() <= 40 ? text : text.substr(0, 40) + "...");
    }

  private:
    const VdbMetadata& metadata_;
    const std::string& where_;
};

std::vector<double> takeTable(const Entries& entries) {
    const auto table = entries.list<double>("delta_table", kCodeCount);
    const auto before = [](double a, double b) {
        return a != b ? a < b : std::signbit(a) && !std::signbit(b);
    };
    bool sound = !table.empty();
    for (std::size_t i = 0; sound && i < table.size(); ++i)
        sound = std::isfinite(table[i]) && (i == 0 || before(table[i - 1], table[i]));
    if (!sound) entries.fail("delta_table", "no increasing finite numbers", "at least one");
    return table;
}

std::vector<CodeBook::Piece> takePieces(const Entries& entries) {
    const std::string key = "delta_pieces";
    const auto numbers = entries.list<double>(key, 3 * std::size_t(kCodeCount));
    const auto refuse = [&](const std::string& got) {
        entries.fail(key, got, "groups of a first value, a step and a count, in increasing order");
    };
    if (numbers.empty() || numbers.size() % 3 != 0)
        refuse(std::to_string(numbers.size()) + " numbers");
    std::vector<CodeBook::Piece> pieces;
    int codes = 0;
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
        const double first = numbers[i], step = numbers[i + 1], count = numbers[i + 2];
        const double last = first + step * (count - 1);
        const bool whole = count >= 1 && count <= kCodeCount - codes && count == std::floor(count);
        const bool rises = std::isfinite(step) && step >= 0 && (count == 1 || first + step > first);
        if (!whole || !rises || !std::isfinite(last) || !(first > highest))
            refuse(numberText(first) + " " + numberText(step) + " " + numberText(count));
        pieces.push_back({first, step, int(count)});
        codes += int(count);
        highest = last;
    }
    return pieces;
}

void takeBook(const Entries& entries, DeltaHeader& header) {
    std::vector<std::string> names = {"integer", "half", "linear", "table", "pieces"};
    const int books = int(names.size());
    names.insert(names.end(), std::begin(kExactNames), std::end(kExactNames));
    const int book = entries.choice("delta_code_book", names);
    if (book >= books) {
        header.exact = ExactValues(book - books);
        return;
    }
    switch (book) {
        case 0:
            header.book = {CodeBook::Kind::kInteger, entries.finite("delta_offset"), 1, nullptr, 0};
            break;
        case 1:
            header.book = CodeBook::half();
            break;
        case 2:
            header.book = {CodeBook::Kind::kLinear, entries.finite("delta_offset"),
                           entries.notNegative("delta_step"), nullptr, 0};
            break;
        case 3:
            header.book = CodeBook::ofTable(takeTable(entries));
            break;
        default:
            header.book = CodeBook::ofPieces(takePieces(entries));
    }
    header.codeCount = entries.whole("delta_code_count", 1, kCodeCount);
    if (header.book.table && header.codeCount != int(header.book.table->size()))
        entries.fail("delta_code_count", std::to_string(header.codeCount),
                     std::to_string(header.book.table->size()) + ", the numbers of " +
                         (header.book.pieces ? "delta_pieces" : "delta_table"));
    const double last = header.book.valueOf(Code(header.codeCount - 1));
    if (header.book.kind != CodeBook::Kind::kHalf && !std::isfinite(last))
        entries.fail("delta_step", numberText(header.book.step), "finite values");
}

std::string cornerText(const glm::ivec3& corner) {
    return openvdb::Vec3i(corner.x, corner.y, corner.z).str();
}

void takeBox(const Entries& entries, DeltaHeader& header) {
    constexpr int kFarthest = 1 << 30;
    const auto low = entries.get<glm::ivec3>("delta_box_min", "a vec3i");
    const auto high = entries.get<glm::ivec3>("delta_box_max", "a vec3i");
    bool sound = true;
    for (int axis = 0; axis < 3; ++axis) {
        header.box.min[axis] = low[axis];
        header.box.max[axis] = high[axis];
        sound = sound && low[axis] > -kFarthest && high[axis] < kFarthest;
    }
    if (header.box.empty()) header.box = {};
    if (!sound) {
        entries.fail("delta_box_max", cornerText(high) + " with minimum " + cornerText(low),
                     "indices within 2^30 of 0");
    }
}

void putBook(const DeltaHeader& header, VdbMetadata& metadata) {
    metadata.insert("delta_code_count", std::int32_t(header.codeCount));
    if (header.book.kind == CodeBook::Kind::kInteger || header.book.kind == CodeBook::Kind::kLinear)
        metadata.insert("delta_offset", header.book.offset);
    if (header.book.kind == CodeBook::Kind::kLinear)
        metadata.insert("delta_step", header.book.step);
    if (header.book.pieces) {
        std::vector<double> numbers;
        for (const CodeBook::Piece& piece : *header.book.pieces)
            numbers.insert(numbers.end(), {piece.first, piece.step, double(piece.count)});
        metadata.insert("delta_pieces", listText(numbers));
    } else if (header.book.table)
        metadata.insert("delta_table", listText(*header.book.table));
}

// Requires the source's own type, or no .vdb source at all.
void requireExactTree(const Entries& entries, const DeltaHeader& header) {
    constexpr const char* kTrees[] = {"float", "double", "int32", "int64"};
    const std::string tree = kTrees[int(*header.exact)];
    if (header.sourceTree.empty() || header.sourceTree == tree) return;
    entries.fail("delta_source_tree", "\"" + header.sourceTree + "\"",
                 "\"" + tree + "\", for the code book " + kExactNames[int(*header.exact)]);
}

// Requires a resting value with a code, and a source type that holds background and book.
void requireHeldValues(const Entries& entries, const DeltaHeader& header) {
    const double background = header.background;
    const auto refuse = [&](const std::string& expected) {
        entries.fail("delta_background", numberText(background), expected);
    };
    if (header.restActive && header.exact) {
        if (!hasSlot(*header.exact, background))
            refuse(std::string("a ") + kExactNames[int(*header.exact)] +
                   ", for active voxels to rest at");
        const glm::ivec3& min = header.box.min;
        if (header.box.empty() || min != glm::ivec3(0))
            entries.fail("delta_box_min", cornerText(min),
                         std::string("[0, 0, 0] in a box of at least one voxel, for active "
                                     "voxels to rest in a volume of ") +
                             kExactNames[int(*header.exact)]);
    } else if (header.restActive) {
        const CodeBook& book = header.book;
        const Code code = std::isfinite(background) ? book.codeOf(background) : Code{0};
        if (code >= header.codeCount || book.valueOf(code) != background)
            refuse("the value of a code, for active voxels to rest at");
    }
    const std::string& tree = header.sourceTree;
    if (header.exact) requireExactTree(entries, header);
    if (tree == "float" && std::isfinite(background) &&
        double(valueAs<float>(background)) != background)
        refuse("a float");
    if (tree.empty() || tree == "float" || tree == "double") return;
    if (background != std::floor(background) || std::fabs(background) > 0x1p63)
        refuse("a whole number of type " + tree);
    if (!header.exact && header.book.kind == CodeBook::Kind::kHalf)
        entries.fail("delta_code_book", "\"half\"", "a book of whole numbers for type " + tree);
}

VdbMetadata allEntries(const DeltaHeader& header) {
    VdbMetadata all;
    all.insert(kVersionKey, std::int32_t(header.version));
    all.insert("delta_slice_axis", std::string(kAxisNames[header.sliceAxis]));
    all.insert("delta_key_interval", std::int32_t(header.keyInterval));
    all.insert("delta_box_min", header.box.min);
    all.insert("delta_box_max", header.box.max);
    all.insert("delta_code_book", header.bookName());
    if (!header.exact) putBook(header, all);
    all.insert("delta_source_type", header.sourceType);
    all.insert("delta_source_tree", header.sourceTree);
    all.insert("delta_source_map", header.sourceMap);
    all.insert("delta_space", header.space);
    all.insert("delta_background", header.background);
    all.insert("delta_rest", std::string(header.restActive ? "active" : "inactive"));
    all.insert("delta_inactive_values", listText(header.inactiveValues));
    all.insert("delta_active", std::int64_t(header.active));
    all.insert("delta_slab_deltas", listText(header.slabDeltas));
    all.insert("delta_tolerance", header.tolerance);
    all.insert("delta_tolerance_value", header.toleranceValue);
    all.insert("delta_max_error", header.maxError);
    return all;
}

// Returns the entries that files leave out: those of an empty grid of floats.
VdbMetadata usualEntries() {
    DeltaHeader usual;
    usual.keyInterval = 128;
    usual.box = {glm::ivec3(0), glm::ivec3(-1)};
    usual.codeCount = 1;
    usual.sourceType = usual.sourceTree = "float";
    usual.sourceMap = "UniformScaleMap";
    VdbMetadata entries = allEntries(usual);
    entries.erase(kVersionKey);
    return entries;
}

// Adds the entries that a grid leaves out.
VdbMetadata withUsualEntries(const VdbMetadata& metadata) {
    VdbMetadata all = metadata;
    const VdbMetadata usual = usualEntries();
    for (const auto& [name, entry] : usual.entries()) {
        if (!metadata.find(name)) all.insert(name, entry);
    }
    return all;
}

}  // namespace

bool hasSlot(ExactValues type, double value) {
    if (!std::isfinite(value)) return false;
    switch (type) {
        case ExactValues::kFloat32:
            return double(valueAs<float>(value)) == value;
        case ExactValues::kFloat64:
            return true;
        case ExactValues::kInt32:
            return double(valueAs<std::int32_t>(value)) == value;
        default:
            return double(valueAs<std::int64_t>(value)) == value &&
                   valueAs<std::int64_t>(value) <= ExactSlots<std::int64_t>::largest();
    }
}

bool isDeltaGrid(const TreeGrid& grid) {
    return isDeltaGrid(grid.type(), grid.metadata);
}

bool isDeltaGrid(const std::string& valueType, const VdbMetadata& metadata) {
    return (valueType == "int32" || valueType == "int64") && metadata.find(kVersionKey);
}

void putDeltaHeader(const DeltaHeader& header, VdbMetadata& metadata) {
    VdbMetadata entries = allEntries(header);
    const VdbMetadata usual = usualEntries();
    for (const auto& [name, entry] : usual.entries()) {
        const VdbMetadata::Entry* const own = entries.find(name);
        if (!own || *own != entry) continue;
        entries.erase(name);
        metadata.erase(name);
    }
    for (const auto& [name, entry] : entries.entries()) metadata.insert(name, entry);
}

std::string DeltaHeader::bookName() const {
    return exact ? kExactNames[int(*exact)] : book.name();
}

std::uint64_t DeltaHeader::deltas() const {
    return std::accumulate(slabDeltas.begin(), slabDeltas.end(), std::uint64_t{0});
}

DeltaHeader takeDeltaHeader(const VdbMetadata& stored, const std::string& where) {
    DeltaHeader header;
    header.version = Entries(stored, where)
                         .whole(kVersionKey, DeltaHeader::kVersion, DeltaHeader::kPackedVersion);
    const VdbMetadata metadata = withUsualEntries(stored);
    const Entries entries(metadata, where);
    header.sliceAxis = entries.choice("delta_slice_axis", {"x", "y", "z"});
    header.keyInterval = entries.whole("delta_key_interval", 8, 1 << 30);
    if (header.keyInterval % 8 != 0)
        entries.fail("delta_key_interval", std::to_string(header.keyInterval), "a multiple of 8");
    takeBox(entries, header);
    takeBook(entries, header);
    header.sourceType = printable(entries.get<std::string>("delta_source_type", "a string"));
    header.sourceTree =
        std::vector<std::string>{
            "", "float", "double", "int32", "int64", "bool", "mask"}[std::size_t(entries.choice(
            "delta_source_tree", {"", "float", "double", "int32", "int64", "bool", "mask"}))];
    header.sourceMap = printable(metadata.text("delta_source_map"));
    const std::string space = metadata.text("delta_space");
    if (space == "RAS" || space == "LPS") header.space = space;
    header.background = entries.get<double>("delta_background", "a double");
    header.restActive = entries.choice("delta_rest", {"inactive", "active"}) == 1;
    requireHeldValues(entries, header);
    header.inactiveValues = entries.list<double>("delta_inactive_values", kCodeCount);
    const auto active = entries.get<std::int64_t>("delta_active", "an int64");
    if (active < 0) entries.fail("delta_active", std::to_string(active), "a count");
    header.active = std::uint64_t(active);
    header.slabDeltas = entries.list<std::uint64_t>("delta_slab_deltas", std::size_t{1} << 27);
    header.tolerance = entries.notNegative("delta_tolerance");
    header.toleranceValue = entries.notNegative("delta_tolerance_value");
    header.maxError = entries.notNegative("delta_max_error");
    return header;
}

}  // namespace deltasplat
