// SPDX-License-Identifier: Apache-2.0
// Based on: DICOM PS3.5 2023, chapters 7 and 10 and annex A: data elements, sequences, transfer
// syntaxes.
#include "ingest/dicom/dicom_walk.h"

#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include "deltasplat/error.h"
#include "printable.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000;
constexpr std::uint32_t kItemEnd = 0xfffee00d;
constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kTransferSyntax = 0x00020010;
constexpr std::uint32_t kPixels = 0x7fe00010;
constexpr int kMostDepth = 16;
constexpr std::uint64_t kMostValue = 1024;

// Types of values: of two letters each; those of the second row have lengths of four bytes.
constexpr std::string_view kShortTypes = "AEASATCSDADSDTFLFDISLOLTPNSHSLSSSTTMUIULUS";
constexpr std::string_view kLongTypes = "OBODOFOLOVOWSQSVUCUNURUTUV";

bool isOneOf(std::string_view types, std::string_view type) {
    for (std::size_t i = 0; i < types.size(); i += 2) {
        if (types.substr(i, 2) == type) return true;
    }
    return false;
}

// What one number of a binary type takes; 1 for texts.
std::uint32_t unitOf(std::string_view type) {
    if (isOneOf("USSSOW", type)) return 2;
    if (isOneOf("ULSLFLATOFOL", type)) return 4;
    if (isOneOf("FDODOVSVUV", type)) return 8;
    return 1;
}

class Walk {
  public:
    explicit Walk(const std::filesystem::path& file)
        : where_(file.string()), in_(file, std::ios::binary) {
        size_ = std::filesystem::file_size(file);
    }

    DicomElements run() {
        std::array<char, 4> magic{};
        in_.seekg(128);
        place_ = 132;
        if (size_ < place_ || !in_.read(magic.data(), 4) ||
            std::memcmp(magic.data(), "DICM", 4) != 0) {
            refuse("no DICOM header", "\"DICM\" behind 128 bytes");
        }
        walkMeta();
        setSyntax(elements_.text(kTransferSyntax));
        std::uint32_t last = 0;
        while (place_ < size_) last = walkElement(size_, 0, last);
        return std::move(elements_);
    }

  private:
    struct Head {
        std::uint32_t tag = 0;
        std::string type;  // empty where types are implicit
        std::uint32_t length = 0;
    };

    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, gotExpected(where_, got, expected));
    }
    [[noreturn]] void refusePlace(const std::string& what) const {
        refuse("DICOM whose " + what + " at byte " + std::to_string(place_), "a sound file");
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
        place_ += bytes;
        in_.seekg(std::streamoff(place_));
    }
    std::uint32_t number(std::size_t bytes, std::uint64_t end) {
        const std::string text = take(bytes, end);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) {
            const std::size_t at = elements_.bigEndian ? i : bytes - 1 - i;
            value = value << 8 | static_cast<unsigned char>(text[at]);
        }
        return value;
    }

    Head readHead(std::uint64_t end) {
        Head head;
        const std::uint32_t group = number(2, end);
        head.tag = group << 16 | number(2, end);
        if (!explicitTypes_ || group == 0xfffe) {
            head.length = number(4, end);
            return head;
        }
        head.type = take(2, end);
        if (isOneOf(kLongTypes, head.type)) {
            pass(2, end);
            head.length = number(4, end);
        } else if (isOneOf(kShortTypes, head.type)) {
            head.length = number(2, end);
        } else {
            refusePlace("element has the unknown type \"" + printable(head.type) + "\"");
        }
        return head;
    }

    // The group that says how the rest is written; it is itself always written in one way.
    void walkMeta() {
        explicitTypes_ = true;
        std::uint32_t last = 0;
        while (place_ + 2 <= size_) {
            const std::uint64_t here = place_;
            const bool meta = number(2, size_) == 2;
            place_ = here;
            in_.seekg(std::streamoff(place_));
            if (!meta) return;
            last = walkElement(size_, 0, last);
        }
    }

    void setSyntax(const std::string& name) {
        const std::string kPlain = "1.2.840.10008.1.2";
        if (name == kPlain + ".1.99" || name.rfind(kPlain, 0) != 0) {
            refuse("DICOM with the transfer syntax \"" + printable(name) + "\"",
                   "one that is not deflated");
        }
        elements_.syntax = name;
        explicitTypes_ = name != kPlain;
        elements_.bigEndian = name == kPlain + ".2";
        elements_.packed = explicitTypes_ && !elements_.bigEndian && name != kPlain + ".1";
    }

    // Elements come in the order of their tags.
    std::uint32_t walkElement(std::uint64_t end, int depth, std::uint32_t last) {
        const Head head = readHead(end);
        if (head.tag <= last && last != 0) refusePlace("elements are in no order");
        if (head.tag >> 16 == 0xfffe) refusePlace("items are outside of sequences");
        if (head.length == kUndefined) {
            walkUndefined(head, end, depth);
        } else if (head.type == "SQ") {
            requireLeft(head.length, end);
            walkItems(place_ + head.length, depth, false);
        } else {
            walkValue(head, end, depth);
        }
        return head.tag;
    }

    void walkValue(const Head& head, std::uint64_t end, int depth) {
        if (head.length % unitOf(head.type) != 0) refusePlace("element has an impossible length");
        if (depth == 0 && head.tag == kPixels) {
            if (elements_.packed) refusePlace("pixels are not packed as announced");
            elements_.pixels = {{place_, head.length}};
            elements_.pixelWords = head.type != "OB";
        }
        if (depth == 0 && head.length <= kMostValue) {
            elements_.values[head.tag] = take(head.length, end);
        } else {
            pass(head.length, end);
        }
    }

    void walkUndefined(const Head& head, std::uint64_t end, int depth) {
        if (depth == 0 && head.tag == kPixels) {
            if (!elements_.packed) refusePlace("pixels have no length");
            walkFragments(end);
            return;
        }
        if (!head.type.empty() && head.type != "SQ" && head.type != "UN") {
            refusePlace("element has no length");
        }
        // What is of unknown type is written without types.
        const bool before = explicitTypes_;
        if (head.type == "UN") explicitTypes_ = false;
        walkItems(end, depth, true);
        explicitTypes_ = before;
    }

    // Items up to `end`, or up to the mark that ends an open sequence.
    void walkItems(std::uint64_t end, int depth, bool open) {
        if (depth >= kMostDepth) refusePlace("sequences are nested too deeply");
        while (open || place_ < end) {
            const Head head = readHead(end);
            if (open && head.tag == kSequenceEnd && head.length == 0) return;
            if (head.tag != kItem) refusePlace("sequence holds something else than items");
            if (head.length == kUndefined) {
                walkOpenItem(end, depth);
                continue;
            }
            requireLeft(head.length, end);
            const std::uint64_t itemEnd = place_ + head.length;
            std::uint32_t last = 0;
            while (place_ < itemEnd) last = walkElement(itemEnd, depth + 1, last);
        }
    }

    void walkOpenItem(std::uint64_t end, int depth) {
        std::uint32_t last = 0;
        while (true) {
            const std::uint64_t here = place_;
            const std::uint32_t group = number(2, end);
            const std::uint32_t tag = group << 16 | number(2, end);
            if (tag == kItemEnd) {
                if (number(4, end) != 0) refusePlace("item has an impossible end");
                return;
            }
            place_ = here;
            in_.seekg(std::streamoff(place_));
            last = walkElement(end, depth + 1, last);
        }
    }

    // Packed pixels are a list of pieces.
    void walkFragments(std::uint64_t end) {
        while (true) {
            const Head head = readHead(end);
            if (head.tag == kSequenceEnd && head.length == 0) return;
            if (head.tag != kItem || head.length == kUndefined) {
                refusePlace("packed pixels are no list");
            }
            requireLeft(head.length, end);
            elements_.pixels.push_back({place_, head.length});
            pass(head.length, end);
        }
    }

    std::string where_;
    std::ifstream in_;
    std::uint64_t size_ = 0;
    std::uint64_t place_ = 0;
    bool explicitTypes_ = true;
    DicomElements elements_;
};

}  // namespace

std::string DicomElements::text(std::uint32_t tag) const {
    const auto found = values.find(tag);
    if (found == values.end()) return "";
    const std::string kFillers(" \0", 2);
    const std::size_t begin = found->second.find_first_not_of(kFillers);
    if (begin == std::string::npos) return "";
    return found->second.substr(begin, found->second.find_last_not_of(kFillers) - begin + 1);
}

int DicomElements::number(std::uint32_t tag, int missing) const {
    const auto found = values.find(tag);
    if (found == values.end() || found->second.size() != 2) return missing;
    const auto byte = [&](std::size_t i) {
        return int(static_cast<unsigned char>(found->second[i]));
    };
    return bigEndian ? byte(0) << 8 | byte(1) : byte(1) << 8 | byte(0);
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
