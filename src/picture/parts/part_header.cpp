// SPDX-License-Identifier: Apache-2.0
#include "picture/parts/part_header.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "deltasplat/error.h"
#include "files/checked_json.h"

namespace deltasplat {
namespace {

using Json = nlohmann::ordered_json;

std::string textOf(const Notes& notes, const std::string& name) {
    const auto found = std::find_if(notes.begin(), notes.end(),
                                    [&](const auto& note) { return note.first == name; });
    return found == notes.end() ? "no " + name : name + " " + found->second;
}

Method methodOf(const std::string& name) {
    for (const Method method :
         {Method::kAuto, Method::kDelta, Method::kSparse, Method::kTraditional})
        if (methodName(method) == name) return method;
    throw Error(ErrorCode::kInput, "a method that there is not");
}

void require(bool holds) {
    if (!holds) throw Error(ErrorCode::kInput, "a part of nothing");
}

}  // namespace

std::string shareText(const SlabShare& share) {
    std::string text = std::to_string(share.first);
    if (share.last != share.first) text += "-" + std::to_string(share.last);
    return text + "/" + std::to_string(share.count);
}

std::string headerText(const PartHeader& header) {
    const Json json = {{"share", {header.share.first, header.share.last, header.share.count}},
                       {"slabs", {header.firstSlab, header.lastSlab}},
                       {"picture", Json(header.notes.picture)},
                       {"part", Json(header.notes.part)},
                       {"method", methodName(header.method)},
                       {"tolerance", {header.tolerance.relative, header.tolerance.value}},
                       {"content", header.content},
                       {"layout", layoutJson(header.layout)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PartHeader headerOf(const std::string& text) {
    const Json json = parseCheckedJson(text, "header", "that of a part");
    PartHeader header;
    const Json &share = json.at("share"), &slabs = json.at("slabs");
    header.share = {share.at(0).get<int>(), share.at(1).get<int>(), share.at(2).get<int>()};
    header.firstSlab = slabs.at(0).get<int>();
    header.lastSlab = slabs.at(1).get<int>();
    header.notes = {json.at("picture").get<Notes>(), json.at("part").get<Notes>()};
    header.method = methodOf(json.at("method").get<std::string>());
    header.tolerance = {json.at("tolerance").at(0).get<double>(),
                        json.at("tolerance").at(1).get<double>()};
    header.content = json.at("content").get<std::string>();
    header.layout = layoutOf(json.at("layout"));
    require(header.share.first >= 1 && header.share.first <= header.share.last &&
            header.share.last <= header.share.count && header.share.count <= kMostSlabShares);
    require(header.firstSlab >= 0 && header.firstSlab <= header.lastSlab &&
            header.lastSlab <= header.layout.slabs());
    return header;
}

HeaderDifference differenceOf(const PartHeader& part, const PartHeader& first) {
    // Who is told what differs wants to hear of options before what comes of them.
    for (const auto* notes : {&first.notes.picture, &part.notes.picture}) {
        for (const auto& [name, text] : *notes) {
            const std::string got = textOf(part.notes.picture, name);
            const std::string expected = textOf(first.notes.picture, name);
            if (got != expected) return {got, expected};
        }
    }
    if (part.share.count != first.share.count)
        return {"part " + shareText(part.share), "one of " + std::to_string(first.share.count)};
    const Json got = layoutJson(part.layout), expected = layoutJson(first.layout);
    if (got.at("camera") != expected.at("camera"))
        return {"a picture of another camera or size", "the same"};
    if (part.content != first.content || got != expected)
        return {"a picture of other voxels or colours", "the same"};
    return {};
}

}  // namespace deltasplat
