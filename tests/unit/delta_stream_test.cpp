// SPDX-License-Identifier: Apache-2.0
// The stream of packed deltas: numbers come out as they went in, and what is damaged is refused
// with one line that says what is wrong.
#include "formats/delta/delta_stream.h"

#include <gtest/gtest.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "deltasplat/delta/delta_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"
#include "deltasplat/memory_limit.h"
#include "formats/delta/bit_reader.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/plane_kernels.h"
#include "formats/delta/stream_index.h"
#include "formats/delta/stream_writer.h"
#include "formats/delta/word_tree.h"
#include "formats/vdb/vdb_file.h"
#include "support/error_of.h"
#include "support/same_volume.h"
#include "support/simd_levels.h"
#include "unit/ingest_helpers.h"

namespace deltasplat {
namespace {

using openvdb::Coord;
using testing::expectError;
using testing::TempFolder;

// What is read behind the end has to be there.
BitReader readerOf(std::vector<std::uint64_t>& words) {
    words.insert(words.end(), 4, 0);
    return {words.data(), 0};
}

TEST(BitStream, NumbersOfAnyWidthComeBack) {
    std::mt19937_64 random(1);
    BitWriter out;
    std::vector<std::pair<std::uint64_t, int>> numbers;
    for (int i = 0; i < 5000; ++i) {
        const int width = int(random() % 65);
        numbers.emplace_back(random() & BitReader::lowBits(width), width);
        out.put(numbers.back().first, width);
    }
    std::vector<std::uint64_t> words = out.words();
    BitReader in = readerOf(words);
    for (const auto& [number, width] : numbers) ASSERT_EQ(in.take(width), number);
}

TEST(BitStream, NumbersOfAnySizeComeBack) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    BitWriter out;
    std::vector<std::uint64_t> numbers = {0, 1, 2, 3, kMost - 2, kMost - 1};
    for (int i = 0; i < 63; ++i) numbers.push_back(std::uint64_t{1} << i);
    for (const std::uint64_t number : numbers) out.putNumber(number);
    std::vector<std::uint64_t> words = out.words();
    BitReader in = readerOf(words);
    for (const std::uint64_t number : numbers) ASSERT_EQ(in.takeNumber(), number);
    // Where nothing but zeros is left there is no number.
    std::vector<std::uint64_t> none;
    EXPECT_EQ(readerOf(none).takeNumber(), kMost);
}

// Returns how many bits a number takes, in whatever order they lie.
std::size_t bitsOf(RiceCode code, int parameter, std::uint64_t number) {
    const std::uint64_t quotient = number >> parameter;
    return quotient < RiceCode::kMostOnes ? std::size_t(quotient) + 1 + std::size_t(parameter)
                                          : std::size_t(RiceCode::kMostOnes + code.width);
}

// With every parameter, the smallest and largest numbers among them.
template <typename Number>
void expectNumbersComeBack(int width) {
    SCOPED_TRACE(width);
    std::mt19937_64 random{unsigned(width)};
    const RiceCode code{width};
    const std::uint64_t most = BitReader::lowBits(width);
    for (int parameter = 0; parameter < width; ++parameter) {
        std::vector<Number> numbers = {0, 1, Number(most), Number(most - 1)};
        for (int i = 0; i < 200; ++i) numbers.push_back(Number((random() & most) >> i % width));
        std::size_t end = 0;
        for (const Number number : numbers) end += bitsOf(code, parameter, number);
        for (const std::size_t count : {64, 1, 63}) {
            BitWriter planes;
            const auto part = [&](std::size_t i) {
                return std::span<const Number>(numbers).subspan(
                    i, std::min(count, numbers.size() - i));
            };
            for (std::size_t i = 0; i < numbers.size(); i += count)
                putPlanes(planes, code, parameter, part(i));
            std::vector<std::uint64_t> words = planes.words();
            BitReader in = readerOf(words);
            for (std::size_t i = 0; i < numbers.size(); i += count) {
                std::array<Number, 64> taken;
                taken.fill(77);
                const std::uint64_t any =
                    takePlanes(in, code, parameter, part(i).size(), taken.data());
                for (std::size_t n = 0; n < 64; ++n) {
                    ASSERT_EQ(taken[n], n < part(i).size() ? part(i)[n] : 0);
                    ASSERT_EQ(any >> n & 1, taken[n] != 0 ? 1u : 0u);
                }
            }
            ASSERT_EQ(in.position(), end);
        }
    }
}

TEST(BitStream, RiceCodesComeBack) {
    test::atEveryLevel([] {
        expectNumbersComeBack<std::uint32_t>(1);
        expectNumbersComeBack<std::uint32_t>(10);
        expectNumbersComeBack<std::uint32_t>(18);
        expectNumbersComeBack<std::uint32_t>(32);
        expectNumbersComeBack<std::uint64_t>(64);
    });
}

// Takes numbers from planes bit by bit.
std::vector<std::uint64_t> plainPlanes(BitReader& in, RiceCode code, int parameter,
                                       std::size_t count) {
    std::vector<std::uint64_t> numbers(count), ones(count);
    for (std::uint64_t level = 0; level < RiceCode::kMostOnes; ++level) {
        for (std::uint64_t& quotient : ones)
            if (quotient == level) quotient += in.take(1);
    }
    for (int bit = 0; bit < parameter; ++bit)
        for (std::uint64_t& number : numbers) number |= in.take(1) << bit;
    for (std::size_t n = 0; n < count; ++n) {
        const bool isLarge = ones[n] == RiceCode::kMostOnes;
        numbers[n] |= (isLarge ? in.take(code.width - parameter) : ones[n]) << parameter;
    }
    return numbers;
}

// Whatever bits there are, numbers are those that are taken bit by bit.
TEST(BitStream, NumbersOfPlanesAreThoseThatAreTakenBitByBit) {
    std::mt19937_64 random(7);
    std::vector<std::uint64_t> words(400);
    for (std::uint64_t& word : words) word = random();
    // Few zeros, and few ones.
    for (std::size_t i = 0; i < 100; ++i) words[i] |= random() | random();
    for (std::size_t i = 100; i < 200; ++i) words[i] &= random() & random();
    test::atEveryLevel([&] {
        for (const int width : {2, 10, 32, 64}) {
            const RiceCode code{width};
            for (int i = 0; i < 5000; ++i) {
                const int parameter = int(random() % unsigned(width));
                const std::size_t begin = random() % (200 * 64);
                const std::size_t count = 1 + random() % 64;
                BitReader plain(words.data(), begin);
                const auto expected = plainPlanes(plain, code, parameter, count);
                BitReader in(words.data(), begin);
                std::array<std::uint64_t, 64> wide;
                std::uint64_t any = takePlanes(in, code, parameter, count, wide.data());
                ASSERT_EQ(in.position(), plain.position());
                for (std::size_t n = 0; n < 64; ++n) {
                    ASSERT_EQ(wide[n], n < count ? expected[n] : 0);
                    ASSERT_EQ(any >> n & 1, wide[n] != 0 ? 1u : 0u);
                }
                if (width > 32) continue;
                in = BitReader(words.data(), begin);
                std::array<std::uint32_t, 64> narrow;
                any = takePlanes(in, code, parameter, count, narrow.data());
                ASSERT_EQ(in.position(), plain.position());
                for (std::size_t n = 0; n < 64; ++n) {
                    ASSERT_EQ(narrow[n], n < count ? std::uint32_t(expected[n]) : 0);
                    ASSERT_EQ(any >> n & 1, narrow[n] != 0 ? 1u : 0u);
                }
            }
        }
    });
}

// The parameter that is chosen takes as many bits as it says, and no other takes fewer.
TEST(BitStream, TheBestParameterIsChosen) {
    std::mt19937 random(3);
    for (const int width : {9, 18, 32}) {
        const RiceCode code{width};
        for (int scale = 0; scale < width; ++scale) {
            std::vector<std::uint32_t> numbers;
            for (int i = 0; i < 64; ++i)
                numbers.push_back(random() & std::uint32_t(BitReader::lowBits(1 + scale)));
            if (scale % 3 == 0) numbers[5] = std::uint32_t(BitReader::lowBits(width));
            const RiceChoice best = bestRice<std::uint32_t>(code, numbers);
            std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
            for (int parameter = 0; parameter < width; ++parameter) {
                BitWriter out;
                putPlanes<std::uint32_t>(out, code, parameter, numbers);
                fewest = std::min<std::uint64_t>(fewest, out.bits());
                if (parameter == best.parameter) {
                    EXPECT_EQ(out.bits(), best.bits);
                }
            }
            EXPECT_EQ(best.bits, fewest);
        }
    }
}

openvdb::Int64Grid::Ptr gridOfWords(const std::vector<std::uint64_t>& words) {
    return openvdb::Int64Grid::create(treeOfWords(words));
}

TEST(TreeOfWords, WordsComeBack) {
    std::mt19937_64 random(2);
    for (const std::size_t count : {0, 1, 511, 512, 513, 5000, (4096 + 17) * 512 + 3}) {
        SCOPED_TRACE(count);
        std::vector<std::uint64_t> words(count);
        for (std::uint64_t& word : words) word = random();
        const auto grid = gridOfWords(words);
        EXPECT_EQ(grid->activeVoxelCount(), count);
        std::vector<std::uint64_t> padded = words;
        padded.resize(count + 3);
        EXPECT_EQ(wordsOfTree(grid->tree(), 3, "words"), padded);
        // OpenVDB walks them in this order.
        std::size_t wrong = 0, next = 0;
        for (auto word = grid->cbeginValueOn(); word; ++word, ++next)
            wrong += std::uint64_t(*word) == words[next] ? 0 : 1;
        EXPECT_EQ(wrong, 0u);
    }
}

TEST(TreeOfWords, EveryLeafHasAPlaceOfItsOwn) {
    std::set<Coord> places;
    for (std::size_t leaf = 0; leaf < 300000; ++leaf) places.insert(wordLeafOrigin(leaf));
    EXPECT_EQ(places.size(), 300000u);
    // Behind a full node of nodes the next one begins.
    EXPECT_EQ(wordLeafOrigin(std::size_t{1} << 27), Coord(4096, 0, 0));
}

TEST(TreeOfWords, TilesOfEqualWordsAreWords) {
    const std::vector<std::uint64_t> words(1500, 7);
    const auto grid = gridOfWords(words);
    openvdb::tools::prune(grid->tree());
    EXPECT_EQ(grid->tree().leafCount(), 1u);
    EXPECT_EQ(wordsOfTree(grid->tree(), 0, "words"), words);
}

// Returns the leaves of a grid of words, and writes it to a file for that.
VdbLeaves leavesOf(const openvdb::Int64Grid::Ptr& grid) {
    grid->setName("words");
    openvdb::io::File("words.vdb").write({grid});
    const VdbFile file("words.vdb");
    return file.readLeaves(file.grids().front(), VdbFile::Find::kByNotes).value();
}

TEST(TreeOfWords, WordsComeBackFromAFile) {
    const TempFolder folder;
    std::mt19937_64 random(5);
    for (const std::size_t count : {0, 1, 511, 512, 513, 512 * 300 + 7}) {
        SCOPED_TRACE(count);
        std::vector<std::uint64_t> words(count);
        for (std::uint64_t& word : words) word = random();
        const VdbLeaves leaves = leavesOf(gridOfWords(words));
        EXPECT_EQ(countWords(leaves), count);
        const auto taken = wordsOfLeaves(leaves, count, 3, "words");
        words.resize(count + 3);
        ASSERT_TRUE(taken);
        EXPECT_EQ(std::vector<std::uint64_t>(taken->begin(), taken->end()), words);
    }
}

TEST(TreeOfWords, LeavesThatAreNoGridOfWords) {
    const TempFolder folder;
    const auto read = [](const std::function<void(openvdb::Int64Grid&)>& change) {
        std::vector<std::uint64_t> words(1500);
        for (std::size_t i = 0; i < words.size(); ++i) words[i] = i;
        const auto grid = gridOfWords(words);
        change(*grid);
        const VdbLeaves leaves = leavesOf(grid);
        const auto count = countWords(leaves);
        return count && wordsOfLeaves(leaves, *count, 0, "words").has_value();
    };
    EXPECT_TRUE(read([](openvdb::Int64Grid&) {}));
    // A gap within the first leaf, and at the end of one; a leaf in another place.
    EXPECT_FALSE(read([](auto& grid) { grid.tree().setValueOff(Coord(0, 0, 2)); }));
    EXPECT_FALSE(read([](auto& grid) { grid.tree().setValueOff(Coord(7, 7, 15)); }));
    EXPECT_FALSE(read([](auto& grid) { grid.tree().setValueOn(Coord(64, 0, 0), 1); }));
    EXPECT_FALSE(read([](auto& grid) { grid.tree().touchLeaf(Coord(0, 0, 24)); }));
    EXPECT_FALSE(read([](auto& grid) { grid.tree().addTile(1, Coord(0, 0, 0), 0, false); }));
}

// Writes packed deltas of a volume, sliced along z, with a key slice every 8, and returns their
// grid of words.
openvdb::Int64Grid::Ptr packedGrid(const std::string& source, const std::string& output) {
    DeltaFileOptions options;
    options.sliceAxis = 2;
    options.keyInterval = 8;
    options.pack = true;
    DeltaFile file;
    file.add(readVolume(source), options);
    file.write(output);
    openvdb::initialize();
    openvdb::io::File input(output);
    input.open();
    return openvdb::gridPtrCast<openvdb::Int64Grid>(input.readGrid(input.beginName().gridName()));
}

using Damage = std::function<void(openvdb::MetaMap& metadata, std::vector<std::uint64_t>& words)>;

// Returns what reading damaged packed deltas says: of a 20 x 9 x 12 volume of bytes, sliced along
// z, two slabs of 8 and 4 slices.
std::string refusalOf(const Damage& damage) {
    const TempFolder folder;
    std::string voxels(20 * 9 * 12, '\0');
    for (std::size_t i = 0; i < voxels.size(); i += 7) voxels[i] = char(i % 250);
    testing::writeBytes("a_20x9x12_uint8.raw", voxels);
    const auto grid = packedGrid("a_20x9x12_uint8.raw", "whole.vdb");
    EXPECT_NO_THROW(readVolume("whole.vdb"));
    std::vector<std::uint64_t> words = wordsOfTree(grid->tree(), 0, "whole");
    openvdb::MetaMap metadata = *grid;
    damage(metadata, words);
    const auto damaged = gridOfWords(words);
    damaged->insertMeta(metadata);
    damaged->setTransform(grid->transform().copy());
    openvdb::io::File("a.vdb").write({damaged});
    return test::errorOf([] { readVolume("a.vdb"); });
}

const std::string kWhere = "input: a.vdb: grid \"a_20x9x12_uint8\": ";

// Changes how many words there are.
Damage resized(const std::function<std::size_t(std::size_t)>& change) {
    return [=](openvdb::MetaMap&, std::vector<std::uint64_t>& words) {
        words.resize(change(words.size()));
    };
}

// Writes the stream anew.
Damage rewritten(const std::function<void(BitWriter&)>& write) {
    return [=](openvdb::MetaMap&, std::vector<std::uint64_t>& words) {
        BitWriter out;
        write(out);
        words = out.words();
    };
}

TEST(DeltaStreamError, WordsThatAreMissingOrTooMany) {
    for (const int more : {-1, 1}) {
        std::size_t count = 0;
        const std::string refusal = refusalOf(
            resized([&](std::size_t words) { return count = words + std::size_t(more); }));
        EXPECT_EQ(refusal, kWhere + "got a stream of " + std::to_string(count) +
                               " words; expected as many as its columns have");
    }
    EXPECT_EQ(refusalOf(resized([](std::size_t) { return 0; })),
              kWhere + "got 0 deltas in slab 0; expected 384, as \"delta_slab_deltas\" says");
    // A number that goes on behind the last word.
    const auto unfinished = [](BitWriter& out) {
        out.put(0, 40);
        out.put(1, 1);
    };
    EXPECT_EQ(refusalOf(rewritten(unfinished)),
              kWhere + "got a stream of 1 words that ends early; expected the rest of it");
}

// What is usual is not said; what is said has to be sound.
TEST(DeltaStreamError, MetadataThatIsMissing) {
    const auto without = [](const std::string& key) {
        return [=](openvdb::MetaMap& metadata, std::vector<std::uint64_t>&) {
            EXPECT_TRUE(metadata[key]);
            metadata.removeMeta(key);
        };
    };
    EXPECT_EQ(refusalOf(without("delta_box_max")),
              kWhere + "got deltas outside of the box; expected columns within it, in order");
    EXPECT_EQ(refusalOf(without("delta_slab_deltas")),
              kWhere + "got 0 slabs in \"delta_slab_deltas\"; expected 2");
    EXPECT_EQ(
        refusalOf([](openvdb::MetaMap& metadata, std::vector<std::uint64_t>&) {
            metadata.insertMeta("delta_slice_axis", openvdb::StringMetadata("w"));
        }),
        kWhere + "metadata \"delta_slice_axis\": got \"w\"; expected one of \"x\" \"y\" \"z\"");
}

// Writes one column, by where it is and its words.
Damage column(std::uint64_t slab, std::uint64_t u, std::uint64_t v, std::uint64_t words,
              const std::function<void(BitWriter&)>& write = {}) {
    return rewritten([=](BitWriter& out) {
        out.putNumber(1);
        out.put(0, 1);
        for (const std::uint64_t number : {slab, u, v, words - 1}) out.putNumber(number);
        out.put(0, 64 - int(out.bits() % 64));
        if (write) write(out);
    });
}

TEST(DeltaStreamError, ColumnsThatAreNoneOfTheBox) {
    const std::string outside =
        kWhere + "got deltas outside of the box; expected columns within it, in order";
    EXPECT_EQ(refusalOf(column(2, 0, 0, 1)), outside);
    EXPECT_EQ(refusalOf(column(0, 3, 0, 1)), outside);
    EXPECT_EQ(refusalOf(column(0, 0, 2, 1)), outside);
    EXPECT_EQ(refusalOf(column(0, 0, std::uint64_t{1} << 40, 1)), outside);
    EXPECT_EQ(
        refusalOf(column(0, 0, 0, 1000)),
        kWhere +
            "got columns of 1000 words or more; expected at most 1, those of the whole stream");
    EXPECT_EQ(refusalOf(column(0, 0, 0, 1)),
              kWhere + "got a stream of 1 words; expected as many as its columns have");
}

TEST(DeltaStreamError, BlocksThatAreNone) {
    const auto damaged = [](const std::string& place) {
        return kWhere + "got a damaged stream at " + place +
               "; expected blocks one behind the other";
    };
    // The one block of the slab, of a slice in a form that there is not.
    const auto form = [](BitWriter& out) {
        out.putNumber(0);
        out.putNumber(0);
        out.put(1, 1);
        out.put(3, 2);
        out.put(0, 50);
    };
    EXPECT_EQ(refusalOf(column(1, 2, 1, 1, form)), damaged("(8, 16, 8)"));
    // With a parameter as large as the width of numbers (9 bits).
    const auto wide = [](BitWriter& out) {
        out.putNumber(0);
        out.putNumber(0);
        out.put(1, 1);
        out.put(std::uint64_t(SliceForm::kRows), 2);
        out.put(9, 5);
        out.put(1, 8);
        out.put(1, 8);
        out.put(0, 38);
    };
    EXPECT_EQ(refusalOf(column(1, 2, 1, 1, wide)), damaged("(8, 16, 8)"));
    // Without deltas.
    const auto empty = [](BitWriter& out) {
        out.putNumber(0);
        out.putNumber(0);
        out.put(0, 60);
    };
    EXPECT_EQ(refusalOf(column(0, 0, 0, 1, empty)), damaged("(0, 0, 0)"));
    // Behind the slab.
    const auto gap = [](BitWriter& out) {
        out.putNumber(0);
        out.putNumber(1);
        out.put(0, 50);
    };
    EXPECT_EQ(refusalOf(column(0, 0, 0, 1, gap)), damaged("(0, 0, 0)"));
    // More words than it needs, and fewer.
    const auto one = [](int words) {
        return [=](BitWriter& out) {
            out.putNumber(0);
            out.putNumber(0);
            out.put(1, 1);
            out.put(std::uint64_t(SliceForm::kMask), 2);
            out.put(0, 5);
            out.put(words > 1 ? 1 : ~std::uint64_t{0}, 64);
            while (out.words().size() < std::size_t(words) + 1) out.put(0, 1);
        };
    };
    EXPECT_EQ(refusalOf(column(0, 0, 0, 3, one(3))), damaged("(8, 0, 0)"));
    EXPECT_EQ(refusalOf(column(0, 0, 0, 2, one(1))), damaged("(0, 0, 0)"));
}

// One column, of the codes 1 and 2 of 2160 voxels.
Damage codes(std::uint64_t lowest, std::uint64_t more,
             const std::vector<std::uint64_t>& histogram) {
    return rewritten([=](BitWriter& out) {
        out.putNumber(1);
        out.put(1, 1);
        for (const std::uint64_t number : {0, 0, 0, 0}) out.putNumber(number);
        out.putNumber(lowest);
        out.putNumber(more);
        out.putNumber(histogram.size() / 2);
        for (const std::uint64_t number : histogram) out.putNumber(number);
        for (int side = 0; side < 6; ++side) out.putNumber(0);
        const std::vector<std::uint64_t> words = out.words();
        out.put(0, int(64 * words.size() - out.bits()));
        out.put(streamSum(words.data(), words.size()), 64);
        out.put(0, 64);
    });
}

TEST(DeltaStreamError, CodesThatThereAreNot) {
    const std::string beyond =
        kWhere + "got codes beyond those of the code book; expected codes below 250";
    EXPECT_EQ(refusalOf(codes(250, 0, {})), beyond);
    EXPECT_EQ(refusalOf(codes(249, 1, {})), beyond);
    EXPECT_EQ(refusalOf(codes(0, std::uint64_t{1} << 62, {})), beyond);
    const std::string none = kWhere +
                             "got numbers of codes that go together with no volume; expected 2160 "
                             "voxels of 250 codes";
    EXPECT_EQ(refusalOf(codes(0, 249, {250, 1})), none);
    EXPECT_EQ(refusalOf(codes(0, 249, {3, 1, 246, 1})), none);
    EXPECT_EQ(refusalOf(codes(0, 249, {3, 2160})), none);
    EXPECT_EQ(refusalOf(codes(0, 249, {3, 999, 4, 1160})), none);
    EXPECT_EQ(refusalOf(codes(0, 249, {3, 999, 4, 1158})),
              kWhere + "got codes of 2159 voxels; expected of 2160");
    // Of the column's ends one.
    EXPECT_EQ(refusalOf(codes(3, 4, {3, 999, 4, 1159})),
              kWhere + "got columns of codes that no voxel has; expected those of some voxel");
}

// Of a volume that says which codes it has, the words and what they are of.
struct Known {
    openvdb::Int64Grid::Ptr grid;
    DeltaHeader header;
    std::vector<std::uint64_t> words;
};

Known knownCodes() {
    std::string voxels;
    std::mt19937 random(3);
    for (int i = 0; i < 64 * 64 * 16; ++i) voxels += char(random() % 64);
    testing::writeBytes("a_64x64x16_uint8.raw", voxels);
    Known known{packedGrid("a_64x64x16_uint8.raw", "a.vdb"), {}, {}};
    known.header = takeDeltaHeader(*known.grid, "a");
    known.words = wordsOfTree(known.grid->tree(), kStreamPadding, "a");
    return known;
}

void writeWords(const std::vector<std::uint64_t>& words, const openvdb::Int64Grid& like,
                const std::string& file) {
    const auto grid = gridOfWords(words);
    grid->insertMeta(like);
    grid->setTransform(like.transform().copy());
    openvdb::io::File(file).write({grid});
}

TEST(DeltaStreamError, AnIndexThatIsDamaged) {
    const TempFolder folder;
    const Known known = knownCodes();
    const std::size_t count = known.words.size() - kStreamPadding;
    const StreamIndex index = readStreamIndex(known.words.data(), count, known.header, "a");
    ASSERT_FALSE(index.histogram.empty());
    // Wherever a bit of it is another, codes among them, somebody says so.
    for (std::size_t bit = 0; bit < 64 * index.parts.front().begin; ++bit) {
        std::vector<std::uint64_t> words = known.words;
        words[bit / 64] ^= std::uint64_t{1} << bit % 64;
        EXPECT_ANY_THROW(readStreamIndex(words.data(), count, known.header, "a")) << bit;
    }
}

// What says which codes there are has to be right, whoever reads it.
TEST(DeltaStreamError, CodesThatDeltasDoNotAddUpTo) {
    const TempFolder folder;
    const Known known = knownCodes();
    const std::size_t count = known.words.size() - kStreamPadding;
    const StreamIndex index = readStreamIndex(known.words.data(), count, known.header, "a");
    const auto rewrite = [&](const StreamIndex& changed) {
        BitWriter out;
        out.putNumber(changed.parts.size());
        out.put(1, 1);
        glm::ivec3 before(0, 0, -1);
        for (const StreamPart& part : changed.parts) {
            if (part.first.x != before.x) before = {before.x, 0, -1};
            if (part.first.y != before.y) before.z = -1;
            for (const int number : {part.first.x - before.x, part.first.y - before.y,
                                     part.first.z - before.z - 1, int(part.end - part.begin) - 1,
                                     int(part.lowest), int(part.highest - part.lowest)})
                out.putNumber(std::uint64_t(number));
            before = part.first;
        }
        const std::size_t used = 64 - std::size_t(std::count(changed.histogram.begin(),
                                                             changed.histogram.begin() + 64, 0));
        out.putNumber(used);
        std::size_t next = 0;
        for (std::size_t code = 0; code < 64; ++code) {
            if (changed.histogram[code] == 0) continue;
            out.putNumber(code - next);
            out.putNumber(changed.histogram[code] - 1);
            next = code + 1;
        }
        for (int side = 0; side < 5; ++side) out.putNumber(0);
        out.putNumber(std::uint64_t(63 - changed.active.max.z));
        std::vector<std::uint64_t> words = out.words();
        words.push_back(streamSum(words.data(), words.size()));
        words.insert(words.end(), known.words.begin() + std::ptrdiff_t(index.parts.front().begin),
                     known.words.begin() + std::ptrdiff_t(count));
        writeWords(words, *known.grid, "a.vdb");
    };
    const auto refusals = [&] {
        ReadOptions whole;
        whole.keepSource = true;
        ReadOptions later;
        later.readLater = true;
        return std::vector<std::string>{
            test::errorOf([] { readVolume("a.vdb"); }),
            test::errorOf([&] { readVolume("a.vdb", whole); }),
            test::errorOf([&] { readVolume("a.vdb", later).codes()->tree(); })};
    };
    rewrite(index);
    EXPECT_EQ(refusals(), std::vector<std::string>(3, "no error"));
    const std::string where = "input: a.vdb: grid \"a_64x64x16_uint8\": ";
    StreamIndex other = index;
    ++other.histogram[5];
    --other.histogram[6];
    rewrite(other);
    const std::string counts =
        where +
        "got voxels of other codes, or other numbers of them; expected those "
        "that the stream says";
    EXPECT_EQ(refusals()[0], counts);
    EXPECT_EQ(refusals()[1], counts);
    other = index;
    --other.active.max.z;
    rewrite(other);
    const std::string box = where +
                            "got another box of active voxels; expected the one that the stream "
                            "says";
    EXPECT_EQ(refusals()[0], box);
    EXPECT_EQ(refusals()[1], box);
    other = index;
    ASSERT_EQ(other.parts[70].highest, 63);
    other.parts[70].highest = 62;
    rewrite(other);
    const std::string range =
        where + "got codes 0..63 from (8, 0, 48) on; expected 0..62, as the stream says";
    EXPECT_EQ(refusals()[0], range);
    EXPECT_EQ(refusals()[2], range);
}

// Nothing is filled before it shows that it cannot be all.
TEST(DeltaStreamError, ABoxThatIsLargerThanItsVoxels) {
    const auto widened = [](openvdb::MetaMap& metadata, std::vector<std::uint64_t>&) {
        metadata.insertMeta("delta_box_max", openvdb::Vec3IMetadata({1 << 20, 8, 11}));
    };
    EXPECT_EQ(refusalOf(widened), kWhere +
                                      "got 113246316 active voxels; expected 2160, as "
                                      "\"delta_active\" says");
}

// Words that are in the file are sound, however little memory there is; those of tiles need not be.
TEST(DeltaStreamError, MoreThanMemoryHolds) {
    const auto codeOf = [](const openvdb::Int64Grid& grid) {
        setMemoryLimit(1);
        std::optional<ErrorCode> code;
        try {
            wordsOfTree(grid.tree(), 0, "a");
        } catch (const Error& error) {
            code = error.code();
        }
        setMemoryLimit(0);
        return code;
    };
    auto grid = gridOfWords(std::vector<std::uint64_t>(1500, 7));
    EXPECT_EQ(codeOf(*grid), ErrorCode::kFailed);
    openvdb::tools::prune(grid->tree());
    EXPECT_EQ(codeOf(*grid), ErrorCode::kInput);
}

TEST(DeltaStreamError, GapsBetweenWords) {
    auto grid = gridOfWords(std::vector<std::uint64_t>(1500, 7));
    grid->tree().setValueOff(Coord(0, 0, 8 + 2));
    expectError(ErrorCode::kInput,
                "a: got a gap in its words in or behind number 512; expected 1499, one behind the "
                "other",
                [&] { wordsOfTree(grid->tree(), 0, "a"); });
}

}  // namespace
}  // namespace deltasplat
