// SPDX-License-Identifier: Apache-2.0
// Based on: DICOM PS3.5 2023, chapter 7, and PS3.10, chapter 7: data elements, file header.
#include "formats/dicom/dicom_sniff.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "base/text.h"
#include "files/file_name.h"
#include "formats/format.h"

namespace deltasplat {

namespace {

constexpr std::string_view kShortTypes = "AEASATCSDADSDTFLFDISLOLTPNSHSLSSSTTMUIULUS";
constexpr std::string_view kLongTypes = "OBODOFOLOVOWSQSVUCUNURUTUV";
constexpr std::string_view kMark = "DICM";
constexpr std::size_t kPreamble = 128;

bool isOneOf(std::string_view types, std::string_view type) {
    for (std::size_t i = 0; i < types.size(); i += 2) {
        if (types.substr(i, 2) == type) return true;
    }
    return false;
}

// The first elements of a header or a presumed data set.
class FirstElements {
  public:
    FirstElements(std::string_view bytes, DicomSyntax syntax) : bytes_(bytes), syntax_(syntax) {}

    // Returns the class in ascending elements: (0008,0016) of images, (0002,0002) of headers.
    std::string_view className() {
        std::uint64_t last = 0;
        for (int i = 0; i < 16; ++i) {
            const auto group = number(2);
            const auto element = number(2);
            if (!group || !element) return {};
            const std::uint64_t tag = *group << 16 | *element;
            const auto length = lengthOfValue();
            const bool known = *group == 2 || *group == 8;
            if (!known || !length || (i > 0 && tag <= last)) return {};
            last = tag;
            const std::string_view value = bytes_.substr(std::min(place_, bytes_.size()), *length);
            const bool isClass = tag == 0x00080016 || tag == 0x00020002;
            if (isClass) return value.starts_with("1.") ? value : std::string_view();
            place_ += *length;
        }
        return {};
    }

  private:
    std::optional<std::uint64_t> number(std::size_t size) {
        if (place_ + size > bytes_.size()) return {};
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t at = syntax_.bigEndian ? i : size - 1 - i;
            value = value << 8 | static_cast<unsigned char>(bytes_[place_ + at]);
        }
        place_ += size;
        return value;
    }
    std::optional<std::uint64_t> lengthOfValue() {
        if (!syntax_.explicitTypes) return number(4);
        const std::string_view type = bytes_.substr(std::min(place_, bytes_.size()), 2);
        place_ += 2;
        if (isShortDicomType(type)) return number(2);
        if (!isLongDicomType(type)) return {};
        place_ += 2;
        return number(4);
    }

    std::string_view bytes_;
    DicomSyntax syntax_;
    std::size_t place_ = 0;
};

}  // namespace

bool isShortDicomType(std::string_view letters) {
    return isOneOf(kShortTypes, letters);
}

bool isLongDicomType(std::string_view letters) {
    return isOneOf(kLongTypes, letters);
}

std::optional<DicomStart> dicomStart(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) refuseFile(file, "a file that cannot be opened", "a readable file");
    std::array<char, 2048> buffer{};
    in.read(buffer.data(), buffer.size());
    const std::string_view bytes(buffer.data(), std::size_t(in.gcount()));
    const auto headerAt = [&](std::size_t place) {
        const std::string_view name = FirstElements(bytes.substr(place), DicomSyntax()).className();
        return DicomStart{place, {}, name.starts_with("1.2.840.10008.1.3.10")};
    };
    for (const std::size_t before : {kPreamble, std::size_t{0}}) {
        if (bytes.size() < before + kMark.size()) continue;
        if (bytes.substr(before, kMark.size()) == kMark) return headerAt(before + kMark.size());
    }
    for (const DicomSyntax syntax :
         {DicomSyntax{true, false}, DicomSyntax{false, false}, DicomSyntax{true, true}}) {
        if (FirstElements(bytes, syntax).className().empty()) continue;
        return bytes[0] == 2 ? headerAt(0) : DicomStart{0, syntax, false};
    }
    return {};
}

namespace {

std::string nameOf(const std::string& uid) {
    return uid.empty() ? "\"\"" : printable(uid);
}

// "512x512x120", or the number of files if they are no slices.
std::string sizeText(const DicomSeries& series) {
    if (series.slices.empty() || series.error)
        return std::to_string(series.files) + (series.files == 1 ? " file" : " files");
    return std::to_string(series.slices[0].columns) + "x" + std::to_string(series.slices[0].rows) +
           "x" + std::to_string(series.slices.size());
}

// Lists UIDs to choose from; long enough for some dozens of series.
std::string listText(const std::vector<DicomSeries>& all) {
    std::string list;
    for (const DicomSeries& series : all) {
        if (list.size() > 3000) return list + ", ...";
        list += (list.empty() ? "" : ", ") + nameOf(series.uid) + " (" +
                (series.description.empty() ? "" : series.description + ", ") + sizeText(series) +
                ")";
    }
    return list;
}

}  // namespace

DicomSeries chooseSeries(const std::filesystem::path& input, std::vector<DicomSeries> series,
                         const std::optional<std::string>& uid) {
    if (uid) {
        const auto chosen = std::find_if(series.begin(), series.end(),
                                         [&](const DicomSeries& one) { return one.uid == *uid; });
        if (chosen != series.end()) return std::move(*chosen);
        throw Error(ErrorCode::kInput, input.string(), "no DICOM series " + nameOf(*uid),
                    "`series` of " + listText(series));
    }
    if (series.size() == 1) return std::move(series.front());
    throw Error(ErrorCode::kInput, input.string(),
                std::to_string(series.size()) + " DICOM series: " + listText(series),
                "one, chosen by `series` UID");
}

namespace {

DenseSource openSeries(const std::filesystem::path& input, const InputKind& kind,
                       const ReadOptions& options, const Listener&) {
    return openDicom(input, kind.name,
                     chooseSeries(input, findSeries(input, kind.files), options.series));
}

}  // namespace

const Format& dicomFormat() {
    static const Format format{.extensions = {".dcm"}, .mayBePacked = false, .open = openSeries};
    return format;
}

}  // namespace deltasplat
