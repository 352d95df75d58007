// SPDX-License-Identifier: Apache-2.0
// Based on: DICOM PS3.5 2023, chapters 7 and 10, annex A: elements, sequences, transfer syntaxes.
#include "formats/dicom/dicom_walk.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/dicom/dicom_sniff.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000;
constexpr std::uint32_t kItemEnd = 0xfffee00d;
constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kTransferSyntax = 0x00020010;
constexpr std::uint32_t kPixels = 0x7fe00010;
constexpr int kMostDepth = 16;
constexpr std::size_t kHeldBeside = 128;  // bytes of overhead per value

// Whether a sequence's items are kept: value tables, real world mappings, and functional groups.
bool isKept(std::uint32_t sequence) {
    constexpr std::array<std::uint32_t, 8> kKept{
        0x00209113,  // PlanePositionSequence
        0x00209116,  // PlaneOrientationSequence
        0x00283000,  // ModalityLUTSequence
        0x00289110,  // PixelMeasuresSequence
        0x00289145,  // PixelValueTransformationSequence
        0x00409096,  // RealWorldValueMappingSequence
        0x52009229,  // SharedFunctionalGroupsSequence
        0x52009230,  // PerFrameFunctionalGroupsSequence
    };
    return std::find(kKept.begin(), kKept.end(), sequence) != kKept.end();
}

// Returns the longest kept value of an element.
std::uint64_t mostKept(std::uint32_t tag) {
    const bool isTable = tag == 0x00283006 || tag == 0x00409212 ||  // tables of values
                         tag == 0x3004000c ||                       // offsets of frames
                         tag >> 16 == 0x0029;                       // Siemens' headers
    return isTable ? 1 << 20 : 1 << 10;
}

class Walk {
  public:
    explicit Walk(const std::filesystem::path& file)
        : where_(file.string()), in_(file, std::ios::binary) {
        size_ = std::filesystem::file_size(file);
        const std::optional<DicomStart> start = dicomStart(file);
        if (!start) refuse("no DICOM header", "\"DICM\" behind 128 bytes");
        goTo(start->place);
        if (start->bare) {
            syntax_ = *start->bare;
            elements_.syntax = syntax_.bigEndian ? "1.2.840.10008.1.2.2" : "1.2.840.10008.1.2.1";
        } else {
            walkHeader();
            if (!elements_.isContents()) setSyntax(elements_.text(kTransferSyntax));
        }
        elements_.bigEndian = syntax_.bigEndian;
    }

    DicomElements run() {
        const DicomSyntax syntax = syntax_;
        while (place_ < size_ && !elements_.isContents()) {
            const std::uint64_t start = place_;
            try {
                walkElement(size_, 0, &elements_);
            } catch (const Error& error) {
                if (error.code() != ErrorCode::kInput || !hasPixels_) throw;
                syntax_ = syntax;
                // Padding here is harmless, but cut elements may have given the pixels' meaning.
                if (beginsElement(start)) throw;
                break;
            }
        }
        return std::move(elements_);
    }

  private:
    struct Head {
        std::uint32_t tag = 0;
        std::string type;  // empty if implicit
        std::uint32_t length = 0;
    };

    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, where_, got, expected);
    }
    [[noreturn]] void refusePlace(const std::string& what) const {
        refuse("DICOM whose " + what + " at byte " + std::to_string(place_), "a sound file");
    }

    void goTo(std::uint64_t place) {
        place_ = place;
        in_.clear();
        in_.seekg(std::streamoff(place_));
    }
    void requireLeft(std::uint64_t bytes, std::uint64_t end) const {
        if (bytes > end - place_) refusePlace("elements are cut short");
    }
    std::string take(std::uint64_t bytes, std::uint64_t end) {
        requireLeft(bytes, end);
        std::string text(std::size_t(bytes), '\0');
        in_.read(text.data(), std::streamsize(bytes));
        if (!in_) refusePlace("elements are cut short");
        place_ += bytes;
        return text;
    }
    void pass(std::uint64_t bytes, std::uint64_t end) {
        requireLeft(bytes, end);
        goTo(place_ + bytes);
    }
    std::uint32_t number(std::size_t bytes, std::uint64_t end) {
        const std::string text = take(bytes, end);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) {
            const std::size_t at = syntax_.bigEndian ? i : bytes - 1 - i;
            value = value << 8 | static_cast<unsigned char>(text[at]);
        }
        return value;
    }

    // Requests memory for kept values, which exceeds their size in the file.
    void hold(std::size_t bytes) {
        constexpr std::size_t kAtOnce = 1 << 20;
        held_ += bytes;
        if (held_ < kAtOnce) return;
        requireMemory(where_, double(held_));
        held_ = 0;
    }

    Head readHead(std::uint64_t end) {
        Head head;
        const std::uint32_t group = number(2, end);
        head.tag = group << 16 | number(2, end);
        if (!syntax_.explicitTypes || group == 0xfffe) {
            head.length = number(4, end);
            return head;
        }
        head.type = take(2, end);
        if (isLongDicomType(head.type)) {
            pass(2, end);
            head.length = number(4, end);
        } else if (isShortDicomType(head.type)) {
            head.length = number(2, end);
        } else {
            refusePlace("element has the unknown type \"" + printable(head.type) + "\"");
        }
        return head;
    }

    bool saysType() {
        const std::uint64_t here = place_;
        bool says = false;
        if (size_ - place_ >= 6) {
            const std::string type = take(6, size_).substr(4);
            says = isShortDicomType(type) || isLongDicomType(type);
        }
        goTo(here);
        return says;
    }

    // Whether unreadable bytes begin an element before pixels: by a type or a group that is read.
    bool beginsElement(std::uint64_t start) {
        constexpr std::array<std::uint32_t, 9> kRead{0x0008, 0x0018, 0x0019, 0x0020, 0x0028,
                                                     0x0029, 0x0040, 0x3004, 0x5200};
        goTo(start);
        if (size_ - place_ < 2) return false;
        const std::uint32_t group = number(2, size_);
        goTo(start);
        return (syntax_.explicitTypes && group >= 8 && group < kPixels >> 16 && saysType()) ||
               std::find(kRead.begin(), kRead.end(), group) != kRead.end();
    }

    // Walks group 2, which is always written in explicit little endian and gives the encoding of
    // the rest. A second group 2, in the data set's encoding, may follow.
    void walkHeader() {
        while (size_ - place_ >= 2) {
            const std::uint64_t here = place_;
            const bool isHeader = number(2, size_) == 2;
            goTo(here);
            if (!isHeader || !saysType()) return;
            walkElement(size_, 0, &elements_);
        }
    }

    void setSyntax(const std::string& name) {
        const std::string kPlain = "1.2.840.10008.1.2";
        if (name == kPlain + ".1.99" || (!name.empty() && name.rfind(kPlain, 0) != 0)) {
            refuse("DICOM with the transfer syntax \"" + printable(name) + "\"",
                   "one that is not deflated");
        }
        elements_.syntax = name;
        syntax_.bigEndian = name == kPlain + ".2";
        elements_.packed =
            !name.empty() && name != kPlain && !syntax_.bigEndian && name != kPlain + ".1";
        // Some files declare one encoding and use the other.
        syntax_.explicitTypes = saysType();
    }

    void walkElement(std::uint64_t end, int depth, DicomItem* into) {
        const Head head = readHead(end);
        if (head.tag >> 16 == 0xfffe) {
            // An end mark after a sequence or item of explicit length.
            if (head.length == 0 && head.tag != kItem) return;
            refusePlace("items are outside of sequences");
        }
        // Without explicit types, kept sequences are recognised by their tags.
        const bool isSequence = head.type == "SQ" || (isKept(head.tag) && head.type != "OB" &&
                                                      (head.type.empty() || head.type == "UN"));
        if (head.length != kUndefined && !isSequence) return walkValue(head, end, depth, into);
        if (head.tag == kPixels && head.length == kUndefined) return walkPacked(depth, end);
        if (head.length == kUndefined && !head.type.empty() && head.type != "SQ" &&
            head.type != "UN") {
            if (head.type[0] == 'O') return walkFragments(end, nullptr);
            refusePlace("element has no length");
        }
        const bool open = head.length == kUndefined;
        if (!open) requireLeft(head.length, end);
        // Content of unknown type is written with implicit types.
        const DicomSyntax before = syntax_;
        if (head.type == "UN") syntax_ = {false, false};
        walkItems(open ? end : place_ + head.length, depth, open,
                  into != nullptr && isKept(head.tag) ? &into->sequences[head.tag] : nullptr);
        syntax_ = before;
    }

    void walkValue(const Head& head, std::uint64_t end, int depth, DicomItem* into) {
        if (depth == 0 && head.tag == kPixels && !hasPixels_) {
            if (elements_.packed) refusePlace("pixels are not packed as announced");
            requireLeft(head.length, end);
            elements_.pixels = {{place_, head.length}};
            elements_.pixelWords = head.type != "OB";
            pass(head.length, end);
            hasPixels_ = true;
        } else if (into != nullptr && head.length <= mostKept(head.tag)) {
            hold(head.length + kHeldBeside);
            into->values.emplace(head.tag, take(head.length, end));
        } else {
            pass(head.length, end);
        }
    }

    // Walks packed pixels, of the data set or of an icon in a sequence.
    void walkPacked(int depth, std::uint64_t end) {
        const bool isImage = depth == 0 && !hasPixels_;
        if (isImage && !elements_.packed) refusePlace("pixels have no length");
        walkFragments(end, isImage ? &elements_.pixels : nullptr);
        if (isImage) hasPixels_ = true;
    }

    // Walks items up to `end`, or to the end mark of an open sequence.
    void walkItems(std::uint64_t end, int depth, bool open, std::vector<DicomItem>* into) {
        if (depth >= kMostDepth) refusePlace("sequences are nested too deeply");
        while (open || place_ < end) {
            const Head head = readHead(end);
            if (head.tag == kSequenceEnd && head.length == 0) {
                if (open) return;
                continue;
            }
            if (head.tag != kItem) refusePlace("sequence holds something else than items");
            DicomItem* item = nullptr;
            if (into != nullptr) {
                hold(3 * sizeof(DicomItem));  // growth of the vector holds copies
                item = &into->emplace_back();
                item->bigEndian = syntax_.bigEndian;
            }
            if (head.length == kUndefined) {
                walkOpenItem(end, depth, item);
                continue;
            }
            requireLeft(head.length, end);
            const std::uint64_t itemEnd = place_ + head.length;
            while (place_ < itemEnd) walkElement(itemEnd, depth + 1, item);
        }
    }

    void walkOpenItem(std::uint64_t end, int depth, DicomItem* into) {
        while (true) {
            const std::uint64_t here = place_;
            const std::uint32_t group = number(2, end);
            const std::uint32_t tag = group << 16 | number(2, end);
            if (tag == kItemEnd) {
                if (number(4, end) != 0) refusePlace("item has an impossible end");
                return;
            }
            goTo(here);
            walkElement(end, depth + 1, into);
        }
    }

    // Walks packed pixels, which are a list of pieces.
    void walkFragments(std::uint64_t end, std::vector<DicomElements::Piece>* into) {
        while (true) {
            const Head head = readHead(end);
            if (head.tag == kSequenceEnd && head.length == 0) return;
            if (head.tag != kItem || head.length == kUndefined) {
                refusePlace("packed pixels are no list");
            }
            requireLeft(head.length, end);
            if (into != nullptr) into->push_back({place_, head.length});
            pass(head.length, end);
        }
    }

    std::string where_;
    std::ifstream in_;
    std::uint64_t size_ = 0;
    std::uint64_t place_ = 0;
    DicomSyntax syntax_;
    bool hasPixels_ = false;
    std::size_t held_ = 0;  // bytes since the last request for memory
    DicomElements elements_;
};

template <typename T>
std::vector<T> numbersIn(const DicomItem& item, std::uint32_t tag) {
    const auto found = item.values.find(tag);
    std::vector<T> numbers;
    if (found == item.values.end()) return numbers;
    const std::string& bytes = found->second;
    for (std::size_t i = 0; i + sizeof(T) <= bytes.size(); i += sizeof(T)) {
        std::uint64_t bits = 0;
        for (std::size_t b = 0; b < sizeof(T); ++b) {
            const std::size_t at = item.bigEndian ? b : sizeof(T) - 1 - b;
            bits = bits << 8 | static_cast<unsigned char>(bytes[i + at]);
        }
        if constexpr (std::is_same_v<T, double>) {
            numbers.push_back(std::bit_cast<double>(bits));
        } else {
            numbers.push_back(T(bits));
        }
    }
    return numbers;
}

}  // namespace

std::string DicomItem::text(std::uint32_t tag) const {
    const auto found = values.find(tag);
    if (found == values.end()) return "";
    const std::string kFillers(" \0", 2);
    const std::size_t begin = found->second.find_first_not_of(kFillers);
    if (begin == std::string::npos) return "";
    return found->second.substr(begin, found->second.find_last_not_of(kFillers) - begin + 1);
}

int DicomItem::number(std::uint32_t tag, int missing) const {
    const std::vector<std::uint16_t> numbers = words(tag);
    return numbers.size() == 1 ? numbers[0] : missing;
}

std::vector<double> DicomItem::decimals(std::uint32_t tag, double most) const {
    std::vector<double> numbers;
    std::istringstream parts(text(tag));
    for (std::string part; std::getline(parts, part, '\\');) {
        part.erase(0, part.find_first_not_of(" +"));
        part.erase(part.find_last_not_of(' ') + 1);
        double number = 0;
        const char* const end = part.data() + part.size();
        const auto result = std::from_chars(part.data(), end, number);
        const bool whole = result.ec == std::errc{} && result.ptr == end;
        if (!whole || !std::isfinite(number) || std::abs(number) > most) return {};
        numbers.push_back(number);
    }
    return numbers;
}

std::vector<std::uint16_t> DicomItem::words(std::uint32_t tag) const {
    return numbersIn<std::uint16_t>(*this, tag);
}

std::vector<double> DicomItem::doubles(std::uint32_t tag) const {
    std::vector<double> numbers = numbersIn<double>(*this, tag);
    const bool finite = std::all_of(numbers.begin(), numbers.end(),
                                    [](double number) { return std::isfinite(number); });
    return finite ? numbers : std::vector<double>();
}

const DicomItem* DicomItem::first(std::uint32_t sequence) const {
    const auto found = sequences.find(sequence);
    return found == sequences.end() || found->second.empty() ? nullptr : &found->second[0];
}

std::uint64_t DicomElements::pixelBytes() const {
    std::uint64_t bytes = 0;
    for (const Piece& piece : pixels) bytes += piece.length;
    return bytes;
}

DicomElements walkDicom(const std::filesystem::path& file) {
    return Walk(file).run();
}

}  // namespace deltasplat
