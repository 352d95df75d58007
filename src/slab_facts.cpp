// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/slab_facts.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "checked_json.h"
#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/slot.h"
#include "file_mark.h"
#include "ingest/files/input_files.h"
#include "ingest/vdb/read_slices.h"
#include "lower_case.h"
#include "picture_facts.h"
#include "whole_number.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTitle = "deltasplat_slab_facts";
constexpr const char* kFactsOfSlabs = "facts of a picture's slabs";
constexpr const char* kSum = "sum";  // by which it is whole

// As it is in a file, which is UTF-8 whatever names are.
std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json vectorJson(const glm::ivec3& v) {
    return {v.x, v.y, v.z};
}

glm::ivec3 vectorOf(const Json& json) {
    return {wholeNumberOf<int>(json.at(0)), wholeNumberOf<int>(json.at(1)),
            wholeNumberOf<int>(json.at(2))};
}

// What tells a delta grid from another one.
Json gridJson(const Volume& volume) {
    if (!volume.origin) return Json();
    return {{"slice_axis", volume.origin->sliceAxis},
            {"key_interval", volume.origin->keyInterval},
            {"deltas", volume.origin->deltas},
            {"active", volume.activeCount},
            {"code_book", volume.origin->codeBook}};
}

Json histogramJson(const Volume& volume) {
    Json json = Json::array();
    for (std::size_t code = 0; code < volume.histogram.size(); ++code)
        if (volume.histogram[code] != 0) json.push_back({code, volume.histogram[code]});
    return json;
}

std::vector<std::uint64_t> histogramOf(const Json& json) {
    std::vector<std::uint64_t> histogram(kCodeCount);
    for (const Json& pair : json)
        histogram.at(wholeNumberOf<std::size_t>(pair.at(0))) =
            wholeNumberOf<std::uint64_t>(pair.at(1));
    return histogram;
}

Json slabJson(const PlannedSlab& slab) {
    return {slab.firstSlice, slab.sliceCount, slab.visible, slab.deltas,
            slab.words,      slab.seenWords,  slab.whole};
}

PlannedSlab slabOf(const Json& json) {
    PlannedSlab slab;
    slab.firstSlice = wholeNumberOf<int>(json.at(0));
    slab.sliceCount = wholeNumberOf<int>(json.at(1));
    slab.visible = wholeNumberOf<std::uint64_t>(json.at(2));
    slab.deltas = wholeNumberOf<std::uint64_t>(json.at(3));
    slab.words = wholeNumberOf<std::uint64_t>(json.at(4));
    slab.seenWords = wholeNumberOf<std::uint64_t>(json.at(5));
    slab.whole = json.at(6).get<bool>();
    return slab;
}

Json factsJson(const SlabFacts& facts) {
    Json slabs = Json::array(), seen = Json::array();
    for (const PlannedSlab& slab : facts.slabs) slabs.push_back(slabJson(slab));
    for (const SlabFacts::Seen& slab : facts.seen)
        seen.push_back({slab.work, slab.blocks.x, slab.blocks.y});
    return {{"blocks_seen", facts.blocksSeen},
            {"joined", facts.joined},
            {"blocks_per_slab", facts.blocksPerSlab},
            {"slabs", std::move(slabs)},
            {"seen", std::move(seen)},
            {"words", facts.words},
            {"content", facts.content}};
}

// @param file  that it is in
SlabFacts factsOf(const Json& json, const std::filesystem::path& file) {
    SlabFacts facts;
    facts.file = file.string();
    facts.blocksSeen = wholeNumberOf<std::size_t>(json.at("blocks_seen"));
    facts.joined = wholeNumberOf<int>(json.at("joined"));
    facts.blocksPerSlab = wholeNumberOf<int>(json.at("blocks_per_slab"));
    for (const Json& slab : json.at("slabs")) facts.slabs.push_back(slabOf(slab));
    for (const Json& slab : json.at("seen")) {
        facts.seen.push_back({slab.at(0).get<double>(),
                              {wholeNumberOf<int>(slab.at(1)), wholeNumberOf<int>(slab.at(2))}});
    }
    facts.words = wholeNumberOf<std::uint64_t>(json.at("words"));
    facts.content = json.at("content").get<std::string>();
    if (facts.blocksPerSlab < 1) throw Error(ErrorCode::kInput, "slabs of nothing");
    if (facts.joined != 1 && facts.joined != 2)
        throw Error(ErrorCode::kInput, "slices that parts cannot join");
    return facts;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& got,
                         const std::string& expected) {
    throw Error(ErrorCode::kInput, gotExpected(file.string(), got, expected));
}

Json read(const std::filesystem::path& file) {
    Json whole = readCheckedJson(file, kFactsOfSlabs);
    try {
        Json json = std::move(whole.at(kTitle));
        if (wholeNumberOf<std::uint64_t>(whole.at(kSum)) == hashOf(dumped(json))) return json;
    } catch (const std::exception&) {
    }
    refuse(file, "something else", kFactsOfSlabs);
}

// Parts belong together that are made alike, of one file: names the option that differs first.
void requireFactsOf(const Json& json, const std::filesystem::path& input, const Notes& options,
                    const std::filesystem::path& file) {
    Notes known;
    std::uint64_t mark = 0;
    try {
        known = json.at("options").get<Notes>();
        mark = wholeNumberOf<std::uint64_t>(json.at("input"));
    } catch (const std::exception&) {
        refuse(file, "something else", kFactsOfSlabs);
    }
    const auto text = [](const std::string& name, const std::string& value) {
        return name + (value.empty() ? "" : " ") + value;
    };
    const Notes asked = Json::parse(dumped(Json(options))).get<Notes>();
    const auto without = [&](const Notes& notes, const Notes& others) -> std::string {
        for (const auto& note : notes) {
            if (std::find(others.begin(), others.end(), note) == others.end())
                return text(note.first, note.second);
        }
        return "";
    };
    const std::string then = without(known, asked), now = without(asked, known);
    if (then.empty() && now.empty()) {
        if (mark == markOf(input)) return;
        refuse(file, "facts of another volume", "those of " + input.string());
    }
    refuse(file, "facts for " + (then.empty() ? "pictures without " + now : then),
           now.empty() ? "those for pictures without " + then : "those for " + now);
}

SlicesWanted wantedOf(const Json& json, const SlabShare& share, const std::filesystem::path& file) {
    SlicesWanted wanted;
    const auto facts = std::make_shared<const SlabFacts>(factsOf(json.at("facts"), file));
    const int first = facts->endOf(share.first - 1, share.count);
    const int last = facts->endOf(share.last, share.count);
    // A part that holds no slab reads as little as there is.
    const int axis = wholeNumberOf<int>(json.at("grid").at("slice_axis"));
    if (axis < 0 || axis > 2) throw Error(ErrorCode::kInput, "an axis that there is not");
    wanted.box = {vectorOf(json.at("box").at(0)), vectorOf(json.at("box").at(1))};
    wanted.blocks = glm::ivec2(toSliceOrder(wanted.box.min, axis).x >> 3);
    for (int slab = first; slab < last; ++slab) {
        const glm::ivec2& blocks = facts->seen.at(std::size_t(slab)).blocks;
        const bool isFirst = slab == first;
        wanted.blocks.x = isFirst ? blocks.x : std::min(wanted.blocks.x, blocks.x);
        wanted.blocks.y = isFirst ? blocks.y : std::max(wanted.blocks.y, blocks.y);
    }
    wanted.histogram = histogramOf(json.at("histogram"));
    wanted.facts = facts;
    return wanted;
}

}  // namespace

void writeSlabFacts(const LayeredPicture& picture, const Notes& options,
                    const std::filesystem::path& input, const std::filesystem::path& file) {
    const DefaultFloats floats;
    const LayeredPicture::Impl& all = picture.impl();
    const Volume& volume = *all.scene.impl().scene.volume;
    const bool byParts = isReadByParts(all);
    Json json{{"options", Json(options)}, {"input", markOf(input)}, {"by_parts", byParts}};
    if (byParts) {
        SlabFacts facts = deltasplat::factsOf(all);
        facts.blocksSeen = all.scene.impl().blocksSeen(all.views.front()->axis().sliceAxis);
        json["grid"] = gridJson(volume);
        json["box"] = {vectorJson(volume.box.min), vectorJson(volume.box.max)};
        json["facts"] = factsJson(facts);
        json["histogram"] = histogramJson(volume);
    }
    const Json whole{{kTitle, json}, {kSum, hashOf(dumped(json))}};
    writeFileAtomically(file, dumped(whole) + "\n");
}

std::optional<Volume> readSlabVolume(const std::filesystem::path& input, const ReadOptions& reading,
                                     const std::filesystem::path& facts, const Notes& options,
                                     const SlabShare& share, const Listener& listener) {
    const DefaultFloats floats;
    const Json json = read(facts);
    requireFactsOf(json, input, options, facts);
    SlicesWanted wanted;
    Json grid;
    try {
        if (!json.at("by_parts").get<bool>()) return std::nullopt;
        grid = json.at("grid");
        wanted = wantedOf(json, share, facts);
    } catch (const std::exception&) {
        refuse(facts, "something else", kFactsOfSlabs);
    }
    if (lowerCase(input.extension().string()) != ".vdb") return std::nullopt;
    if (inputsAreConfined()) requireConfined(input);
    std::optional<Volume> volume = readVdbSlices(input, reading, wanted, listener);
    if (volume && gridJson(*volume) != grid)
        refuse(facts, "facts of another volume", "those of " + input.string());
    return volume;
}

}  // namespace deltasplat
