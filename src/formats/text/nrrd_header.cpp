// SPDX-License-Identifier: Apache-2.0
// Based on: Definition of NRRD File Format (teem.sourceforge.net/nrrd/format.html), version 4.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.h"
#include "deltasplat/ingest/label_list.h"
#include "files/file_name.h"
#include "formats/dense/dense_layout.h"
#include "formats/text/text_header.h"

namespace deltasplat {

namespace {

std::string vectorText(const glm::dvec3& v) {
    return "(" + numberText(v) + ")";
}

std::string spaceLine(const std::string& space) {
    if (space == "RAS") return "space: right-anterior-superior\n";
    if (space == "LPS") return "space: left-posterior-superior\n";
    return "space dimension: 3\n";
}

std::string unitsLine(const std::string& unit) {
    if (unit.empty()) return "";
    const std::string quoted = " \"" + unit + "\"";
    return "space units:" + quoted + quoted + quoted + "\n";
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '\n' ? "\\n" : c == '\\' ? "\\\\" : std::string(1, c);
    return result;
}

std::string extentText(const glm::ivec3& dims) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
        text += (axis == 0 ? "0 " : " 0 ") + std::to_string(dims[axis] - 1);
    return text;
}

// Writes segments like 3D Slicer's .seg.nrrd; nameless labels like ITK's copy of NIfTI's intent.
std::string labelLines(const DenseLayout& layout) {
    const std::vector<LabelEntry>& entries = layout.labels->entries;
    if (entries.empty()) return "intent_code:=1002\n";
    std::string text;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const LabelEntry& label = entries[i];
        const std::string segment = "Segment" + std::to_string(i) + "_";
        if (label.rgb) {
            text += segment + "Color:=" + numberText(label.rgb->r) + " " +
                    numberText(label.rgb->g) + " " + numberText(label.rgb->b) + "\n";
        }
        text += segment + "Extent:=" + extentText(layout.dims) + "\n";
        text += segment + "ID:=Segment_" + std::to_string(i + 1) + "\n";
        text += segment + "LabelValue:=" + std::to_string(label.value) + "\n";
        text += segment + "Layer:=0\n";
        text += segment + "Name:=" + escaped(label.name) + "\n";
    }
    for (const char* const key : {"Segmentation_MasterRepresentation:=Binary labelmap\n",
                                  "Segmentation_SourceRepresentation:=Binary labelmap\n",
                                  "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n"})
        text += key;
    return text + "Segmentation_ReferenceImageExtentOffset:=0 0 0\n";
}

std::string typeText(RawType type) {
    if (type == RawType::kFloat32) return "float";
    return type == RawType::kFloat64 ? "double" : rawTypeName(type);
}

}  // namespace

// NRRD holds all properties of a layout.
void settleNrrd(DenseLayout&, const std::string&, WriteNotes&) {}

std::string nrrdHeader(const DenseLayout& layout, const std::string& dataFile) {
    const glm::dmat4& matrix = layout.worldFromIndex;
    std::string text = "NRRD0004\n";
    text += "type: " + typeText(layout.type) + "\n";
    text += "dimension: 3\n";
    text += spaceLine(layout.space);
    text += unitsLine(layout.lengthUnit);
    text += "sizes: " + std::to_string(layout.dims.x) + " " + std::to_string(layout.dims.y) + " " +
            std::to_string(layout.dims.z) + "\n";
    text += "space directions: " + vectorText(matrix[0]) + " " + vectorText(matrix[1]) + " " +
            vectorText(matrix[2]) + "\n";
    text += "kinds: domain domain domain\n";
    text += "endian: little\n";
    text += "encoding: gzip\n";
    text += "space origin: " + vectorText(layout.origin()) + "\n";
    if (layout.labels) text += labelLines(layout);
    // An empty line ends the header before attached values.
    return text + (dataFile.empty() ? "\n" : "data file: " + dataFile + "\n");
}

// Based on: the documentation of 3D Slicer's .seg.nrrd.
namespace {

// One segment's fields: "Name", "LabelValue" and so on.
using SegmentFields = std::map<std::string, std::string>;

// Groups fields by segment: "Segment12_Name" belongs to 12.
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

// Layers may reuse a number for different labels; if so, every label gets a new number.
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
    // Fractions of voxels are amounts, not labels.
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
