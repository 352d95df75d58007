// SPDX-License-Identifier: Apache-2.0
// Based on: the documentation of 3D Slicer's .seg.nrrd.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "files/file_name.h"
#include "formats/text/text_header.h"
#include "formats/text/text_volume.h"

namespace deltasplat {
namespace {

// What a header says of one segment: "Name", "LabelValue" and the like.
using SegmentFields = std::map<std::string, std::string>;

// The fields of segments by their numbers: "Segment12_Name" of 12.
std::map<std::int64_t, SegmentFields> segmentFields(const TextHeader& header) {
    constexpr std::string_view kPrefix = "Segment";
    std::map<std::int64_t, SegmentFields> segments;
    for (const auto& [key, value] : header.keyValues) {
        if (!key.starts_with(kPrefix)) continue;
        std::int64_t number = -1;
        const char* const end = key.data() + key.size();
        const auto result = std::from_chars(key.data() + kPrefix.size(), end, number);
        if (result.ec != std::errc{} || number < 0 || result.ptr == end || *result.ptr != '_')
            continue;
        segments[number][std::string(result.ptr + 1, end)] = value;
    }
    return segments;
}

std::int64_t numberIn(const SegmentFields& fields, const std::string& name, std::int64_t missing,
                      const std::filesystem::path& file) {
    const auto found = fields.find(name);
    if (found == fields.end()) return missing;
    const std::optional<std::vector<double>> numbers = numbersIn(found->second);
    const bool sound = numbers && numbers->size() == 1 && std::abs(numbers->front()) < 0x1p53 &&
                       numbers->front() == std::floor(numbers->front());
    if (!sound) {
        refuseFile(file, "a segment's " + name + " " + printable(found->second.substr(0, 40)),
                   "a whole number");
    }
    return std::int64_t(numbers->front());
}

std::string textIn(const SegmentFields& fields, const std::string& name) {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
}

std::optional<glm::dvec3> colorIn(const SegmentFields& fields) {
    const std::optional<std::vector<double>> numbers = numbersIn(textIn(fields, "Color"));
    const auto isShare = [](double number) { return number >= 0 && number <= 1; };
    if (!numbers || numbers->size() != 3 || !std::ranges::all_of(*numbers, isShare)) return {};
    return glm::dvec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

// Layers may have the same number for different labels: then each gets its own.
void numberSegments(TextVolume& volume) {
    std::map<std::int64_t, std::int64_t> uses;
    bool alike = false;
    for (const Segment& segment : volume.segments)
        alike = alike || ++uses[segment.stored] > 1 || segment.stored < 0;
    if (!alike) return;
    std::int64_t number = 0;
    for (Segment& segment : volume.segments) segment.label.value = ++number;
    volume.renumbered = true;
}

}  // namespace

void readSegments(const TextHeader& header, TextVolume& volume) {
    const std::string* kept = header.findKey("Segmentation_SourceRepresentation");
    if (kept == nullptr) kept = header.findKey("Segmentation_MasterRepresentation");
    // Shares of voxels are amounts.
    if (kept != nullptr && lowerCase(*kept).starts_with("fractional")) return;
    const auto segments = segmentFields(header);
    const std::string* const intent = header.findKey("intent_code");
    if (segments.empty() && (intent == nullptr || *intent != "1002")) return;
    auto list = std::make_shared<LabelList>();
    std::int64_t number = 0;
    for (const auto& [key, fields] : segments) {
        const bool layered = volume.volumes > 1;
        Segment segment;
        segment.layer = numberIn(fields, "Layer", layered ? number : 0, volume.header);
        segment.stored = numberIn(fields, "LabelValue", 1, volume.header);
        ++number;
        segment.label = {segment.stored, textIn(fields, "Name"), colorIn(fields)};
        if (segment.label.name.empty()) segment.label.name = textIn(fields, "ID");
        if (segment.layer < 0 || segment.layer >= volume.volumes) {
            refuseFile(
                volume.header,
                "segment " + std::to_string(key) + " in layer " + std::to_string(segment.layer),
                "one of " + std::to_string(volume.volumes));
        }
        list->entries.push_back(segment.label);
        if (layered) volume.segments.push_back(segment);
    }
    if (volume.volumes == 1) volume.labels = std::move(list);
    numberSegments(volume);
}

}  // namespace deltasplat
